#include "pipeline/studio/captures/option_form.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/errors/errors.h"
#include "base/files/toml_file.h"
#include "base/programs/program.h"
#include "base/programs/subprocess.h"
#include "base/stages/stages.h"
#include "pipeline/driver/programs.h"
#include "pipeline/studio/access/token.h"
#include "pipeline/studio/captures/toml_edit.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {
namespace {

constexpr int kLeastResolution_px = 8, kMostResolution_px = 16384;

Json Described(const std::string& program, const std::function<bool()>& cancelled) {
  const auto file = FindProgram(program);
  if (file.empty()) return Json::object();
  const auto out = std::filesystem::temp_directory_path() / ("glint-studio-" + RandomToken());
  RunInGroupOptions options;
  options.cancelled = cancelled;
  const int code = RunInGroup({file.string(), kDescribeFlag}, out, options);
  std::ifstream stream(out);
  const Json answer = Json::parse(stream, nullptr, false);
  std::error_code error;
  std::filesystem::remove(out, error);
  return code == 0 && answer.is_object() ? answer : Json::object();
}

// Which views a stage uses, and where it writes, is the whole run's to say.
bool IsOfTheRun(const std::string& option) {
  constexpr std::array kNames = {"exclude", "views", "from", "method"};
  return std::find(kNames.begin(), kNames.end(), option) != kNames.end();
}

std::string TypeOf(const Json& option) {
  if (option.contains("choices")) return "choice";
  std::string kind = option.value("kind", "text");
  if (kind == "flag" || kind == "integer" || kind == "number") return kind;
  return "text";
}

// Defaults are described as texts.
Json DefaultOf(const Json& option, const std::string& type) {
  if (!option.contains("default") || !option["default"].is_string()) {
    return type == "flag" ? Json(false) : Json();
  }
  const std::string text = option["default"].get<std::string>();
  if (type == "flag") return text == "true" || text == "on";
  if (type == "integer" || type == "number") {
    const Json number = Json::parse(text, nullptr, false);
    return number.is_number() ? number : Json();
  }
  return text;
}

Json FormOption(const Json& option, const std::string& stage) {
  const std::string type = TypeOf(option), name = option.value("name", "");
  Json json = {{"name", name},
               {"type", type},
               {"default", DefaultOf(option, type)},
               {"help", option.value("help", "")},
               {"important", stage == "fit" && name == "metals"}};
  for (const char* key : {"choices", "low", "high"}) {
    if (option.contains(key)) json[key] = option[key];
  }
  return json;
}

Json OwnOption(const std::string& name, const std::string& type, const Json& fallback,
               const std::string& help) {
  return {
      {"name", name}, {"type", type}, {"default", fallback}, {"help", help}, {"important", true}};
}

// Of OptionForm's stages; null: there is none.
const Json* FindOption(const Json& form, const std::string& stage, const std::string& option) {
  for (const Json& one : form.at("stages")) {
    if (one.at("name") != stage) continue;
    for (const Json& candidate : one.at("options")) {
      if (candidate.at("name") == option) return &candidate;
    }
  }
  return nullptr;
}

[[noreturn]] void ThrowValue(const std::string& stage, const std::string& name, const Json& value,
                             const std::string& remedy) {
  throw HttpError{422, stage + "." + name + ": found " + value.dump(), remedy};
}

void CheckValue(const std::string& stage, const Json& option, const Json& value) {
  const std::string name = option.at("name"), type = option.at("type");
  if (type == "flag" && !value.is_boolean()) ThrowValue(stage, name, value, "give true or false");
  if ((type == "text" || type == "choice") && !value.is_string()) {
    ThrowValue(stage, name, value, "give a text");
  }
  if (type == "choice") {
    const Json& choices = option.at("choices");
    if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
      ThrowValue(stage, name, value, "choose one of " + choices.dump());
    }
  }
  if (type != "integer" && type != "number") return;
  if (!value.is_number()) ThrowValue(stage, name, value, "give a number");
  const double number = value.get<double>();
  if (type == "integer" && number != std::floor(number)) {
    ThrowValue(stage, name, value, "give a whole number");
  }
  if (!option.contains("low") || !option.contains("high")) return;
  if (number < option["low"].get<double>() || number > option["high"].get<double>()) {
    ThrowValue(stage, name, value,
               "give a number from " + option["low"].dump() + " to " + option["high"].dump());
  }
}

std::optional<Json> ValueOrNone(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional<Json>(value);
}

// "a.jpg, b.jpg" as a list; nothing: none.
std::optional<Json> ListIn(const Json& value) {
  if (value.is_null()) return std::nullopt;
  Json list = Json::array();
  std::istringstream names(value.get<std::string>());
  for (std::string name; std::getline(names, name, ',');) {
    const size_t first = name.find_first_not_of(' ');
    if (first == std::string::npos) continue;
    list.push_back(name.substr(first, name.find_last_not_of(' ') - first + 1));
  }
  if (list.empty()) return std::nullopt;
  return list;
}

// A resolution of two numbers keeps both of them in the sample's shape: one number says it.
std::string Changed(const Capture& capture, const std::string& text, const std::string& stage,
                    const std::string& option, const Json& value) {
  if (stage == "tile" && option == "enabled") {
    return WithTomlTable(capture.file, text, "tile", value.is_boolean() && value.get<bool>());
  }
  if (stage == "run" && option == "exclude") {
    const std::string fit = WithTomlValue(capture.file, text, "fit", "exclude", ListIn(value));
    return WithTomlValue(capture.file, fit, "refine", "exclude", ListIn(value));
  }
  if (stage == "sample" && value.is_null()) return text;  // it has no default
  return WithTomlValue(capture.file, text, stage, option, ValueOrNone(value));
}

std::string Joined(const Json& list) {
  std::string text;
  for (const Json& one : list) {
    if (one.is_string()) text += (text.empty() ? "" : ", ") + one.get<std::string>();
  }
  return text;
}

}  // namespace

Json OptionForm(const std::function<bool()>& cancelled) {
  Json resolution = OwnOption("resolution_px", "integer", 1024, "width of the maps in texels");
  resolution["low"] = kLeastResolution_px;
  resolution["high"] = kMostResolution_px;
  Json stages = Json::array();
  stages.push_back({{"name", "sample"},
                    {"summary", "the part of the surface that becomes maps"},
                    {"options", Json::array({resolution})}});
  stages.push_back(
      {{"name", "run"},
       {"summary", "the whole run"},
       {"options", Json::array({OwnOption("exclude", "text", "",
                                          "photographs held out from fitting, to judge the maps "
                                          "by; separated by commas")})}});
  for (const StageKind& stage : Stages()) {
    const Json answer = Described("glint-" + std::string(stage.name), cancelled);
    Json options = Json::array();
    if (stage.name == "tile") {
      options.push_back(OwnOption("enabled", "flag", false, "make the maps repeat without seams"));
    }
    for (const Json& option : answer.value("options", Json::array())) {
      if (option.value("positional", false) || IsOfTheRun(option.value("name", ""))) continue;
      options.push_back(FormOption(option, std::string(stage.name)));
    }
    stages.push_back({{"name", stage.name}, {"summary", stage.summary}, {"options", options}});
  }
  return {{"stages", stages}};
}

Json SavedOptions(const Capture& capture) {
  const auto document = ReadTomlFile(capture.file);
  std::ostringstream text;
  text << toml::json_formatter(*document);
  const Json all = Json::parse(text.str(), nullptr, false);
  Json saved = Json::object();
  if (!all.is_object()) return saved;
  for (const StageKind& stage : Stages()) {
    const std::string name(stage.name);
    if (all.contains(name) && all[name].is_object()) saved[name] = all[name];
  }
  saved["sample"] = {{"resolution_px", capture.resolution_px[0]}};
  saved["tile"]["enabled"] = capture.tiles;
  saved["run"] = Json::object();
  if (saved.contains("fit") && saved["fit"].contains("exclude")) {
    const Json list = saved["fit"]["exclude"];
    saved["run"]["exclude"] = list.is_string() ? list : Json(Joined(list));
  }
  return saved;
}

std::string WithOptions(const Capture& capture, const std::string& text, const Json& changes,
                        const Json& form) {
  if (!changes.is_object())
    throw HttpError{422, "found no options", "send {stage: {option: value}}"};
  std::string changed = text;
  for (const auto& [stage, options] : changes.items()) {
    if (!options.is_object()) ThrowValue(stage, "", options, "send {option: value}");
    for (const auto& [name, value] : options.items()) {
      const Json* option = FindOption(form, stage, name);
      if (option == nullptr) {
        throw HttpError{422, "found the unknown option " + stage + "." + name, "reload the page"};
      }
      if (!value.is_null()) CheckValue(stage, *option, value);
      changed = Changed(capture, changed, stage, name, value);
    }
  }
  return changed;
}

}  // namespace glint
