#include "pipeline/driver/programs.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <set>
#include <sstream>

#include "base/errors/errors.h"
#include "base/stages/stages.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct KnownVerb {
  std::string_view name, summary;
};

// In the order in which a person meets them; the stages stand where "stages" does.
constexpr std::string_view kStagesHere = "stages";
constexpr KnownVerb kKnownVerbs[] = {
    {"studio", "take photographs, run the stages and view the material in the browser"},
    {"demo", "make a synthetic capture and run every stage on it"},
    {"board", "make a calibration board to print"},
    {"init", "write a capture.toml for a folder of photographs"},
    {"run", "run every stage that is out of date"},
    {"status", "report which results are out of date, and why"},
    {"verify", "compare everything on disk with the hashes recorded in the manifests"},
    {kStagesHere, ""},
    {"response", "measure a camera's tone curve"},
    {"import", "import rectified photographs from other software"},
    {"estimate", "estimate the time and memory of every stage"},
    {"view", "open a capture's result page"},
    {"overview", "write one page about many captures"},
    {"completion", "print a shell completion script"},
    {"manual", "write manual pages"},
    {"eval", "compare maps or re-rendered views with ground truth"},
    {"synth", "make synthetic materials and captures"},
    {"train", "train the auto-encoder and the estimator"},
};

std::vector<fs::path> ProgramFolders() {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(self.parent_path());
  const char* path = std::getenv("PATH");
  std::istringstream list(path == nullptr ? "" : path);
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

bool IsProgram(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

// Levenshtein's distance.
size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

fs::path FindProgram(const std::string& name) {
  for (const fs::path& folder : ProgramFolders()) {
    if (IsProgram(folder / name)) return folder / name;
  }
  return {};
}

fs::path RequireGlintProgram(const std::string& name) {
  const fs::path program = FindProgram(name);
  if (program.empty()) {
    throw EnvironmentError(name +
                           ": no such program beside this one or in PATH; build or install Glint "
                           "completely (./dev build)");
  }
  return program;
}

std::vector<ProgramVerb> ListVerbs() {
  std::vector<ProgramVerb> verbs;
  std::set<std::string> others;
  for (const fs::path& folder : ProgramFolders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const std::string name = entry.path().filename();
      if (name.rfind("glint-", 0) == 0 && IsProgram(entry.path())) others.insert(name.substr(6));
    }
  }
  const auto add = [&](std::string_view name, const std::string& summary) {
    const auto found = others.find(std::string(name));
    if (found == others.end()) return;
    verbs.push_back({*found, summary});
    others.erase(found);
  };
  for (const KnownVerb& known : kKnownVerbs) {
    if (known.name != kStagesHere) {
      add(known.name, std::string(known.summary));
      continue;
    }
    for (const StageKind& stage : Stages()) add(stage.name, "stage: " + std::string(stage.summary));
  }
  for (const std::string& name : others) verbs.push_back({name, ""});
  return verbs;
}

std::string ClosestVerb(const std::string& mistyped, const std::vector<ProgramVerb>& verbs) {
  std::string closest;
  size_t least = std::max<size_t>(1, mistyped.size() / 2) + 1;
  for (const ProgramVerb& verb : verbs) {
    const size_t distance = EditDistance(mistyped, verb.name);
    if (distance >= least) continue;
    least = distance;
    closest = verb.name;
  }
  return closest;
}

}  // namespace glint
