#include "base/formats/manifest.h"

#include <cmath>
#include <limits>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/files/json_file.h"
#include "base/files/json_object.h"

namespace glint {
namespace {

constexpr std::size_t kMaxOutputs = 100000;

std::string FieldName(const std::string& object_name, const std::string& field) {
  return object_name.empty() ? field : object_name + "." + field;
}

// A relative path that stays what it says; absolute ones would tie a manifest to one machine.
std::string RequireRelativePath(const std::filesystem::path& file, const Json& object,
                                const std::string& name) {
  std::string text = RequireString(file, object, name, "path");
  if (text.empty() || std::filesystem::path(text).is_absolute()) {
    throw UserError(file, name + ".path", "'" + text + "'", "paths are relative to the manifest");
  }
  return text;
}

// Outputs lie in the manifest's folder.
void RequireInside(const std::filesystem::path& file, const std::string& name,
                   const std::string& path) {
  const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
  if (*normal.begin() != "..") return;
  throw UserError(file, name + ".path", "'" + path + "'",
                  "outputs lie in the manifest's folder; run the stage again");
}

const Json& RequireArray(const std::filesystem::path& file, const Json& object,
                         const std::string& field) {
  const Json& array = RequireField(file, object, "", field);
  if (!array.is_array() || array.size() > kMaxOutputs) {
    throw UserError(file, field, Describe(array), "a list is expected; run the stage again");
  }
  return array;
}

// Of all that stands in the manifest but the seal itself: no digit of `data` changes unseen.
std::string SealOf(Json json) {
  json.erase("seal");
  // Names of files may hold bytes that are no UTF-8.
  return HashBytes(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void VerifySeal(const std::filesystem::path& file, const Json& json) {
  if (!json.contains("seal")) return;  // written by hand or by another program
  if (json["seal"] == SealOf(json)) return;
  throw UserError(file, "seal", "a manifest that was changed after it was written",
                  "run the stage that wrote it again");
}

}  // namespace

Json ToJson(const Manifest& manifest) {
  Json json;
  json["glint_manifest"] = kManifestFormat;
  json["stage"] = manifest.stage;
  json["stage_version"] = manifest.stage_version;
  json["inputs"] = Json::array();
  for (const ManifestInput& input : manifest.inputs) {
    json["inputs"].push_back({{"path", input.path}, {"hash", input.hash}});
  }
  json["options"] = manifest.options;
  json["outputs"] = Json::array();
  for (const ManifestOutput& output : manifest.outputs) {
    Json entry = {{"path", output.path}, {"hash", output.hash}};
    if (output.width > 0) {
      entry["width"] = output.width;
      entry["height"] = output.height;
      entry["channels"] = output.channels;
    }
    json["outputs"].push_back(entry);
  }
  json["data"] = manifest.data;
  json["metrics"] = manifest.metrics;
  json["seal"] = SealOf(json);
  return json;
}

const Json& RequireField(const std::filesystem::path& file, const Json& object,
                         const std::string& object_name, const std::string& field) {
  if (!object.is_object()) {
    throw UserError(file, object_name, Describe(object),
                    "an object is expected; run the stage again");
  }
  const auto found = object.find(field);
  if (found == object.end()) {
    throw UserError(file, FieldName(object_name, field), "no such field",
                    "the manifest is incomplete; run the stage that wrote it again");
  }
  return *found;
}

double RequireNumber(const std::filesystem::path& file, const Json& object,
                     const std::string& object_name, const std::string& field) {
  const Json& value = RequireField(file, object, object_name, field);
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw UserError(file, FieldName(object_name, field), Describe(value), "a number is expected");
  }
  return value.get<double>();
}

std::optional<double> PositiveNumberIfAny(const std::filesystem::path& file, const Json& object,
                                          const std::string& object_name,
                                          const std::string& field) {
  if (!object.contains(field)) return std::nullopt;
  const double number = RequireNumber(file, object, object_name, field);
  if (number > 0) return number;
  throw UserError(file, object_name + "." + field, std::to_string(number), "it must be above 0");
}

int RequireCount(const std::filesystem::path& file, const Json& object,
                 const std::string& object_name, const std::string& field) {
  const double number = RequireNumber(file, object, object_name, field);
  if (number >= 0 && number <= std::numeric_limits<int>::max() && number == std::floor(number)) {
    return static_cast<int>(number);
  }
  throw UserError(file, FieldName(object_name, field), Describe(object[field]),
                  "a whole number, 0 or more, is expected; run the stage again");
}

bool RequireBool(const std::filesystem::path& file, const Json& object,
                 const std::string& object_name, const std::string& field) {
  const Json& value = RequireField(file, object, object_name, field);
  if (!value.is_boolean()) {
    throw UserError(file, FieldName(object_name, field), Describe(value),
                    "true or false is expected");
  }
  return value.get<bool>();
}

std::string RequireString(const std::filesystem::path& file, const Json& object,
                          const std::string& object_name, const std::string& field) {
  const Json& value = RequireField(file, object, object_name, field);
  if (!value.is_string()) {
    throw UserError(file, FieldName(object_name, field), Describe(value),
                    "text in quotes is expected");
  }
  return value.get<std::string>();
}

std::vector<double> RequireNumbers(const std::filesystem::path& file, const Json& object,
                                   const std::string& object_name, const std::string& field,
                                   std::size_t count) {
  const Json& value = RequireField(file, object, object_name, field);
  const auto reject = [&] {
    throw UserError(file, FieldName(object_name, field), Describe(value),
                    "a list of " + std::to_string(count) + " numbers is expected");
  };
  if (!value.is_array() || value.size() != count) reject();
  std::vector<double> numbers;
  for (const Json& element : value) {
    if (!element.is_number() || !std::isfinite(element.get<double>())) reject();
    numbers.push_back(element.get<double>());
  }
  return numbers;
}

Manifest ReadManifest(const std::filesystem::path& file, const std::string& expected_stage) {
  Json json = ReadJsonFile(file, "run the stage that wrote it again");
  const double format = RequireNumber(file, json, "", "glint_manifest");
  if (format != kManifestFormat) {
    throw UserError(file, "glint_manifest", Describe(json["glint_manifest"]),
                    "this program reads version " + std::to_string(kManifestFormat) +
                        "; run the stage again with this version of Glint");
  }
  Manifest manifest;
  manifest.stage = RequireString(file, json, "", "stage");
  if (!expected_stage.empty() && manifest.stage != expected_stage) {
    throw UserError(file, "stage", "'" + manifest.stage + "'",
                    "a manifest of stage '" + expected_stage + "' is expected here");
  }
  manifest.stage_version = RequireCount(file, json, "", "stage_version");
  const Json& inputs = RequireArray(file, json, "inputs");
  for (size_t i = 0; i < inputs.size(); ++i) {
    const std::string name = "inputs[" + std::to_string(i) + "]";
    manifest.inputs.push_back(
        {RequireRelativePath(file, inputs[i], name), RequireString(file, inputs[i], name, "hash")});
  }
  manifest.options = RequireField(file, json, "", "options");
  const Json& outputs = RequireArray(file, json, "outputs");
  for (size_t i = 0; i < outputs.size(); ++i) {
    const std::string name = "outputs[" + std::to_string(i) + "]";
    ManifestOutput output;
    output.path = RequireRelativePath(file, outputs[i], name);
    RequireInside(file, name, output.path);
    output.hash = RequireString(file, outputs[i], name, "hash");
    if (outputs[i].contains("width")) {
      output.width = RequireCount(file, outputs[i], name, "width");
      output.height = RequireCount(file, outputs[i], name, "height");
      for (const Json& channel : RequireField(file, outputs[i], name, "channels")) {
        if (!channel.is_string()) {
          throw UserError(file, name + ".channels", Describe(channel),
                          "channel names must be text");
        }
        output.channels.push_back(channel.get<std::string>());
      }
    }
    manifest.outputs.push_back(std::move(output));
  }
  manifest.data = RequireField(file, json, "", "data");
  manifest.metrics = RequireField(file, json, "", "metrics");
  VerifySeal(file, json);
  return manifest;
}

std::string MetalsOf(const std::filesystem::path& manifest_file, const Manifest& manifest) {
  if (!manifest.data.contains("metals")) return "rare";
  return RequireString(manifest_file, manifest.data, "data", "metals");
}

void VerifyOutputs(const std::filesystem::path& manifest_file, const Manifest& manifest) {
  for (size_t i = 0; i < manifest.outputs.size(); ++i) {
    const ManifestOutput& output = manifest.outputs[i];
    const std::string field = "outputs[" + std::to_string(i) + "].hash";
    const std::filesystem::path file = manifest_file.parent_path() / output.path;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
      throw UserError(manifest_file, field, "no file '" + output.path + "'",
                      "run stage '" + manifest.stage + "' again");
    }
    if (HashFile(file) != output.hash) {
      throw UserError(manifest_file, field,
                      "'" + output.path + "' with contents other than those the manifest records",
                      "run stage '" + manifest.stage + "' again");
    }
  }
}

}  // namespace glint
