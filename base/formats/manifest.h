// The manifest of a stage's result; docs/manifest.md and manifest.schema.json define the format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/files/json.h"

namespace glint {

inline constexpr int kManifestFormat = 1;

// Before the name of an input that is no part of the capture (weights, say); run.json beside the
// manifest says where it lay.
inline constexpr char kOutsidePrefix[] = "outside:";

struct ManifestInput {
  std::string path;  // relative to the manifest's folder, '/' as separator; or outside:NAME
  std::string hash;
};

struct ManifestOutput {
  std::string path;
  std::string hash;
  int width = 0, height = 0;  // 0 for files that are no images
  std::vector<std::string> channels;
};

struct Manifest {
  std::string stage;
  int stage_version = 1;
  std::vector<ManifestInput> inputs;
  Json options = Json::object();
  std::vector<ManifestOutput> outputs;
  Json data = Json::object();     // what the next stage needs
  Json metrics = Json::object();  // what a person wants to know
};

Json ToJson(const Manifest& manifest);

// Reads and checks structure, format and stage. `expected_stage` empty: any. Throws UserError
// naming file, field, found and remedy.
Manifest ReadManifest(const std::filesystem::path& file, const std::string& expected_stage = "");

// Compares the outputs on disk with their hashes; throws UserError on the first that differs.
void VerifyOutputs(const std::filesystem::path& manifest_file, const Manifest& manifest);

// How metals were expected where the maps of a stage come from (fit's option): "rare" where its
// manifest, of another program or an older version, does not tell. Throws UserError: not a text.
std::string MetalsOf(const std::filesystem::path& manifest_file, const Manifest& manifest);

// Field access for `data` with errors that name the file and the field ("data.views[3].exposure").
const Json& RequireField(const std::filesystem::path& file, const Json& object,
                         const std::string& object_name, const std::string& field);
double RequireNumber(const std::filesystem::path& file, const Json& object,
                     const std::string& object_name, const std::string& field);
// A field that may be left out; above 0 where it is there.
std::optional<double> PositiveNumberIfAny(const std::filesystem::path& file, const Json& object,
                                          const std::string& object_name, const std::string& field);
// A whole number that an int holds, 0 or more.
int RequireCount(const std::filesystem::path& file, const Json& object,
                 const std::string& object_name, const std::string& field);
bool RequireBool(const std::filesystem::path& file, const Json& object,
                 const std::string& object_name, const std::string& field);
std::string RequireString(const std::filesystem::path& file, const Json& object,
                          const std::string& object_name, const std::string& field);
// An array of exactly `count` finite numbers.
std::vector<double> RequireNumbers(const std::filesystem::path& file, const Json& object,
                                   const std::string& object_name, const std::string& field,
                                   std::size_t count);

}  // namespace glint
