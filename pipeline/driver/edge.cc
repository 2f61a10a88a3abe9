#include "pipeline/driver/edge.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <sstream>

#include "base/errors/errors.h"
#include "base/programs/options.h"
#include "base/programs/run_progress.h"
#include "base/stages/stages.h"
#include "pipeline/driver/child_process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::string Variable(const char* name, const std::string& fallback) {
  const char* value = std::getenv(name);
  return value == nullptr || *value == '\0' ? fallback : value;
}

// What distinguishes one writing of a file from the next.
struct FileStamp {
  ino_t inode = 0;
  timespec time{};
  explicit FileStamp(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return;
    inode = status.st_ino;
    time = status.st_mtim;
  }
  bool operator==(const FileStamp& other) const {
    return inode == other.inode && time.tv_sec == other.time.tv_sec &&
           time.tv_nsec == other.time.tv_nsec;
  }
};

// "method,seed" of {"--method", "latent", "--seed", "3"}.
std::string OptionNames(const std::vector<std::string>& arguments) {
  std::string names;
  for (const std::string& argument : arguments) {
    if (argument.starts_with("--")) names += (names.empty() ? "" : ",") + argument.substr(2);
  }
  return names;
}

// −1: none.
int DescriptorVariable(const char* name) { return std::atoi(Variable(name, "-1").c_str()); }

void Note(const EdgeOutcome& outcome) {
  const int descriptor = DescriptorVariable(kRunOutcomesVariable);
  if (descriptor < 0) return;
  const std::string line = outcome.stage + " " + std::to_string(outcome.code) + " " +
                           (outcome.changed ? "1" : "0") + "\n";
  // A lost note costs the exact exit code only; `glint run` then says that the stage failed.
  [[maybe_unused]] const ssize_t written = ::write(descriptor, line.data(), line.size());
}

}  // namespace

std::string ToText(const RunPlan& plan) {
  std::string text = fmt::format("{}", plan.began_s);
  for (const auto& [stage, seconds] : plan.stages) text += fmt::format(" {} {}", stage, seconds);
  return text;
}

std::string ProgressOf(const std::string& plan, const std::string& stage) {
  std::istringstream stream(plan);
  stream.imbue(std::locale::classic());
  RunProgress progress;
  if (!(stream >> progress.began_s)) return "";
  bool found = false;
  std::string name;
  for (double seconds = 0; stream >> name >> seconds;) {
    (name == stage ? progress.stage_s : found ? progress.after_s : progress.before_s) += seconds;
    found |= name == stage;
  }
  return found ? ToText(progress) : "";
}

int RunEdge(const std::vector<std::string>& words) {
  if (words.size() < 2) {
    std::fprintf(stderr, "glint: error: %s needs a stage and a program\n", kEdgeFlag);
    return kExitUser;
  }
  // Ninja dies with `glint run`, this process with Ninja, the program with this process.
  DieWithParent(kRunNinjaVariable);
  ChildProcess child;
  child.arguments = {words[1], Variable(kRunCaptureVariable, ".")};
  const auto kept = std::find(words.begin() + 2, words.end(), kKeptFlag);
  child.arguments.insert(child.arguments.end(), words.begin() + 2, kept);
  if (kept != words.end()) child.arguments.insert(child.arguments.end(), kept + 1, words.end());
  std::istringstream more(Variable(kRunArgumentsVariable, ""));
  for (std::string word; std::getline(more, word);) child.arguments.push_back(word);

  const int result_descriptor = DescriptorVariable(kRunStdoutVariable);
  if (result_descriptor >= 0) ::dup2(result_descriptor, STDOUT_FILENO);

  child.environment = {{kRunProgressVariable, ProgressOf(Variable(kRunPlanVariable, ""), words[0])},
                       {kRunOptionsVariable, OptionNames({words.begin() + 2, kept})}};
  const fs::path manifest = fs::absolute(ManifestPath(words[0]));
  const FileStamp before(manifest);
  EdgeOutcome outcome;
  outcome.stage = words[0];
  try {
    fs::current_path(Variable(kRunFolderVariable, "."));
    outcome.code = RunChild(child);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "glint: error: %s\n", error.what());
    outcome.code = kExitEnvironment;
  }
  outcome.changed = !(before == FileStamp(manifest));
  Note(outcome);
  return outcome.code;
}

OutcomeFile::OutcomeFile() : descriptor_(::memfd_create("glint-run", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw EnvironmentError("cannot make an anonymous file");
}

OutcomeFile::~OutcomeFile() { ::close(descriptor_); }

std::vector<EdgeOutcome> OutcomeFile::Read() const {
  std::string text(1 << 16, '\0');
  const ssize_t size = ::pread(descriptor_, text.data(), text.size(), 0);
  std::istringstream lines(size > 0 ? text.substr(0, static_cast<size_t>(size)) : "");
  std::vector<EdgeOutcome> outcomes;
  for (EdgeOutcome outcome; lines >> outcome.stage >> outcome.code >> outcome.changed;) {
    outcomes.push_back(outcome);
  }
  return outcomes;
}

}  // namespace glint
