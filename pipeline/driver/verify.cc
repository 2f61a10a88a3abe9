#include "pipeline/driver/verify.h"

#include <algorithm>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/formats/manifest.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

void Compare(const fs::path& file, const std::string& name, const std::string& hash,
             const std::string& kind, StageFindings* findings) {
  ++findings->files;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    findings->problems.push_back(kind + " " + name + " is missing");
  } else if (HashFile(file) != hash) {
    findings->problems.push_back(kind + " " + name + " has changed");
  }
}

StageFindings VerifyStage(const fs::path& manifest_file) {
  const fs::path folder = manifest_file.parent_path();
  StageFindings findings;
  findings.stage = folder.filename().string();
  Manifest manifest;
  try {
    manifest = ReadManifest(manifest_file);
  } catch (const UserError& error) {
    findings.problems.push_back(error.what());
    return findings;
  }
  for (const ManifestOutput& output : manifest.outputs) {
    Compare(folder / output.path, output.path, output.hash, "output", &findings);
  }
  for (const ManifestInput& input : manifest.inputs) {
    if (input.path.rfind(kOutsidePrefix, 0) == 0) continue;
    Compare((folder / input.path).lexically_normal(), input.path, input.hash, "input", &findings);
  }
  return findings;
}

}  // namespace

bool Verification::intact() const {
  return std::all_of(stages.begin(), stages.end(),
                     [](const StageFindings& stage) { return stage.problems.empty(); });
}

std::string Verification::Text() const {
  std::string text;
  for (const StageFindings& stage : stages) {
    text += stage.stage + ": " + std::to_string(stage.files) + " files compared" +
            (stage.problems.empty() ? ", as written\n" : "\n");
    for (const std::string& problem : stage.problems) text += "  " + problem + "\n";
  }
  if (!intact()) text += "continue with: glint run " + capture.string() + "\n";
  return text;
}

Json Verification::ToJson() const {
  Json list = Json::array();
  for (const StageFindings& stage : stages) {
    list.push_back({{"stage", stage.stage}, {"files", stage.files}, {"problems", stage.problems}});
  }
  return {{"capture", capture.generic_string()}, {"intact", intact()}, {"stages", list}};
}

Verification VerifyCapture(const fs::path& capture) {
  Verification verification{capture, {}};
  std::vector<fs::path> manifests;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(capture / "glint", error)) {
    if (fs::exists(entry.path() / "manifest.json")) {
      manifests.push_back(entry.path() / "manifest.json");
    }
  }
  if (manifests.empty()) {
    throw UserError(capture / "glint", "", "no results",
                    "make some with: glint run " + capture.string());
  }
  std::sort(manifests.begin(), manifests.end());
  for (const fs::path& file : manifests) verification.stages.push_back(VerifyStage(file));
  return verification;
}

}  // namespace glint
