#include "pipeline/driver/run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash_cache.h"
#include "base/formats/manifest.h"
#include "base/photos/photo_name.h"
#include "base/programs/capture_size.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "base/programs/run_progress.h"
#include "base/stages/stages.h"
#include "pipeline/driver/child_process.h"
#include "pipeline/driver/kept_options.h"
#include "pipeline/driver/ninja_file.h"
#include "pipeline/driver/programs.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kSignalBase = 128;
constexpr int kNinjaInterrupted = 2;
// A run that was just killed takes its children with it, which is not instantaneous.
constexpr int kLockAttempts = 20;
constexpr auto kLockPause = std::chrono::milliseconds(100);

std::unique_ptr<FileLock> LockRun(const fs::path& work) {
  std::error_code error;
  fs::create_directories(work, error);
  if (error) {
    throw EnvironmentError(work.string() + ": cannot create the folder: " + error.message() +
                           "; make the capture's folder writable");
  }
  for (int attempt = 1;; ++attempt) {
    try {
      return std::make_unique<FileLock>(work / ".lock-run", "another glint run of this capture");
    } catch (const UserError&) {
      if (attempt == kLockAttempts) throw;
    }
    std::this_thread::sleep_for(kLockPause);
  }
}

// Temporary files of runs that were killed while they wrote; under the run's lock nobody is.
void RemoveLeftovers(const fs::path& work) {
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::directory_iterator(work, error)) {
    const std::string name = entry.path().filename();
    for (const char* file : {"build.ninja.tmp", ".hashes.json.tmp"}) {
      if (name.rfind(file, 0) == 0) leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& file : leftovers) fs::remove(file, error);
}

fs::path RequireNinja() {
  fs::path ninja = FindProgram("ninja");
  if (!ninja.empty()) return ninja;
  throw EnvironmentError(
      "ninja: no such program in PATH; install it with: apt-get install ninja-build");
}

// Files outside the capture, which the manifest does not say the place of.
void AddOutsideInputs(const fs::path& run_file, const Manifest& manifest, HashCache* hashes,
                      NinjaEdge* edge) {
  std::ifstream stream(run_file);
  const Json facts = Json::parse(stream, nullptr, false);
  if (!facts.is_object() || !facts.contains("outside") || !facts["outside"].is_array()) return;
  std::vector<std::string> recorded;  // hashes, in the order of the places
  for (const ManifestInput& input : manifest.inputs) {
    if (input.path.rfind(kOutsidePrefix, 0) == 0) recorded.push_back(input.hash);
  }
  for (size_t i = 0; i < facts["outside"].size(); ++i) {
    const Json& path = facts["outside"][i];
    if (!path.is_string()) continue;
    const std::string hash = hashes->Hash(path.get<std::string>());
    if (hash.empty() || (i < recorded.size() && hash != recorded[i])) edge->always = true;
    if (!hash.empty()) edge->more_inputs.push_back(path.get<std::string>());
  }
}

// Adds to an edge what its last result says: files it read that the graph does not know, and
// whether something is amiss that the times of the inputs do not show.
void LookAtLastResult(const Capture& capture, HashCache* hashes, NinjaEdge* edge) {
  const fs::path file = capture.folder / edge->step.manifest;
  if (!fs::exists(file)) return;
  Manifest manifest;
  try {
    manifest = ReadManifest(file, edge->step.stage);
  } catch (const UserError&) {
    edge->always = true;
    return;
  }
  const fs::path stage_folder = fs::path("glint") / edge->step.stage;
  AddOutsideInputs(file.parent_path() / "run.json", manifest, hashes, edge);
  for (const ManifestInput& input : manifest.inputs) {
    if (input.path.rfind(kOutsidePrefix, 0) == 0) continue;
    const fs::path path = (stage_folder / input.path).lexically_normal();
    if (fs::exists(capture.folder / path)) {
      edge->more_inputs.push_back(path.generic_string());
    }
    if (hashes->Hash(capture.folder / path) != input.hash) edge->always = true;
  }
  for (const ManifestOutput& output : manifest.outputs) {
    if (hashes->Hash(file.parent_path() / output.path) != output.hash) edge->always = true;
  }
}

// Content of the step's inputs that no stage writes.
std::string ContentOf(const Capture& capture, const StageStep& step, HashCache* hashes) {
  std::string content;
  for (const std::string& input : step.inputs) {
    const bool written_by_a_stage = input.rfind("glint/", 0) == 0;
    if (!written_by_a_stage) content += hashes->Hash(capture.folder / input) + "\n";
  }
  return content;
}

// Earlier stages' manifests that no step of this run writes must be there.
void RequireEarlierResults(const Capture& capture, const std::vector<StageStep>& steps) {
  for (const StageStep& step : steps) {
    for (const std::string& earlier : step.waits_for) {
      bool among_steps = false;
      for (const StageStep& other : steps) among_steps |= other.stage == earlier;
      const fs::path file = capture.folder / ManifestPath(earlier);
      if (among_steps || fs::exists(file)) continue;
      const bool imported = capture.imported() && FindStage(earlier)->imported;
      throw UserError(
          file, "", "no such file",
          imported
              ? "write it with glint import, or describe the [board] in " + capture.file.string()
              : "stage " + step.stage + " reads it: run without --from " + steps.front().stage);
    }
  }
}

std::vector<NinjaEdge> Edges(const Capture& capture, const std::vector<StageStep>& steps,
                             bool force) {
  HashCache hashes(capture.work() / ".hashes.json");
  std::vector<NinjaEdge> edges;
  for (const StageStep& step : steps) {
    NinjaEdge edge;
    edge.step = step;
    edge.program = RequireGlintProgram("glint-" + step.stage);
    LookAtLastResult(capture, &hashes, &edge);
    edge.content = ContentOf(capture, step, &hashes);
    edge.always |= force;
    edges.push_back(std::move(edge));
  }
  hashes.Save();
  return edges;
}

// The stages that will run, as far as can be told before they are asked: those without a sound
// result, and those that read what these write.
RunPlan PlanOf(const Capture& capture, const std::vector<NinjaEdge>& edges) {
  const CaptureSize size = SizeOf(capture);
  RunPlan plan;
  plan.began_s = SecondsSince1970();
  std::set<std::string> running;
  for (const NinjaEdge& edge : edges) {
    const StageStep& step = edge.step;
    bool runs = edge.always || !fs::exists(capture.folder / step.manifest);
    for (const std::string& earlier : step.waits_for) runs |= running.count(earlier) > 0;
    if (!runs) continue;
    running.insert(step.stage);
    plan.stages.emplace_back(step.stage, PredictedSeconds(step.cost, size));
  }
  return plan;
}

// Where the stages' results go: to this program's stdout, or nowhere.
class ResultDescriptor {
 public:
  explicit ResultDescriptor(bool quiet)
      : value_(quiet ? ::open("/dev/null", O_WRONLY | O_CLOEXEC)
                     : ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)) {}
  ~ResultDescriptor() {
    if (value_ >= 0) ::close(value_);
  }
  ResultDescriptor(const ResultDescriptor&) = delete;
  ResultDescriptor& operator=(const ResultDescriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

ChildProcess NinjaProcess(const fs::path& ninja, const Capture& capture, const RunOptions& options,
                          const std::vector<StageStep>& steps, const RunPlan& plan, int outcomes,
                          int results) {
  ChildProcess child;
  child.arguments = {ninja.string(), "-C", capture.folder.string(), "-f", "glint/build.ninja"};
  if (options.verbose) {
    child.arguments.insert(child.arguments.end(), {"-v", "-d", "explain"});
  } else {
    child.arguments.push_back("--quiet");
  }
  for (const StageStep& step : steps) child.arguments.push_back(step.manifest);
  std::string more;
  if (options.threads > 0) more += "--threads\n" + std::to_string(options.threads) + "\n";
  if (options.memory_gb > 0) more += fmt::format("--memory\n{}\n", options.memory_gb);
  if (options.log_level != "info") more += "--log-level\n" + options.log_level + "\n";
  if (options.force) more += "--force\n";
  child.environment = {{kRunFolderVariable, fs::current_path().string()},
                       {kRunCaptureVariable, capture.folder.string()},
                       {kRunArgumentsVariable, more},
                       {kRunOutcomesVariable, std::to_string(outcomes)},
                       {kRunPlanVariable, ToText(plan)},
                       {kRunStdoutVariable, std::to_string(results)}};
  if (!options.verbose) child.environment[kOneLineVariable] = "1";
  child.kept_descriptors = {outcomes, results};
  child.number_variable = kRunNinjaVariable;
  // On stdout Ninja makes remarks, and repeats what a failing stage has said; errors of its own go
  // to stderr.
  child.on_line = [&options](const std::string& line) {
    if (options.verbose) std::fprintf(stderr, "%s\n", line.c_str());
  };
  return child;
}

// Says how a run failed, with the exit code of the stage that did.
[[noreturn]] void ThrowFailure(const RunSummary& summary, int ninja_code) {
  for (const EdgeOutcome& outcome : summary.outcomes) {
    if (outcome.code == 0) continue;
    if (outcome.code <= kSignalBase) throw Error(static_cast<ExitCode>(outcome.code), "");
    const int signal = outcome.code - kSignalBase;
    const std::string killed =
        "glint-" + outcome.stage + " was ended by signal " + std::to_string(signal) + "; ";
    if (signal == SIGKILL) {
      throw EnvironmentError(killed +
                             "perhaps memory ran out: lower sample.resolution_px; earlier results "
                             "are kept, and the next glint run continues from there");
    }
    throw ComputationError(killed +
                           "earlier results are kept, and the next glint run continues from there");
  }
  if (ninja_code == kNinjaInterrupted || ninja_code == kSignalBase + SIGINT) {
    throw EnvironmentError(
        "interrupted; earlier results are kept, and the next glint run continues from there");
  }
  throw EnvironmentError("Ninja failed (exit code " + std::to_string(ninja_code) +
                         ") before a stage did; is the disk full, or " +
                         (summary.capture / "glint").string() + " not writable?");
}

// Before anything runs: a name that is none would only be met after calibration. (Views are named
// by their number, or by their photograph; an imported set's names are read by the first stage.)
void RequireKnownViews(const Capture& capture, const std::vector<std::string>& names) {
  if (capture.imported()) return;
  const auto known = [&](const std::string& name) {
    return name.starts_with("view_") ||
           std::any_of(capture.photos.begin(), capture.photos.end(),
                       [&](const std::string& photo) { return NamesPhoto(name, photo); });
  };
  for (const std::string& name : RejoinedNames(names, known)) {
    if (known(name)) continue;
    throw UserError(fmt::format("--exclude: found no photograph named '{}'; there are: {}", name,
                                fmt::join(capture.photos, ", ")));
  }
}

}  // namespace

bool RunSummary::Changed(const std::string& stage) const {
  for (const EdgeOutcome& outcome : outcomes) {
    if (outcome.stage == stage && outcome.changed) return true;
  }
  return false;
}

std::string RunSummary::BriefReport() const {
  std::string kept;
  for (const std::string& stage : stages) {
    if (!Changed(stage)) kept += (kept.empty() ? "" : ", ") + stage;
  }
  std::string text;
  if (!kept.empty()) text += "up to date: " + kept + "\n";
  for (const std::string& stage : stages) {
    const fs::path folder = capture / "glint" / stage;
    if (stage == "export") text += "maps and materials: " + folder.string() + "\n";
    if (stage == "report") {
      text += "page: " + (folder / "index.html").string() + "   (glint view " + capture.string() +
              " opens it)\n";
    }
  }
  return text;
}

Json RunSummary::ToJson() const {
  Json stages_json = Json::array();
  for (const std::string& stage : stages) {
    stages_json.push_back({{"stage", stage},
                           {"state", Changed(stage) ? "computed" : "up to date"},
                           {"manifest", (capture / ManifestPath(stage)).generic_string()}});
  }
  Json started = Json::array();
  for (const EdgeOutcome& outcome : outcomes) started.push_back(outcome.stage);
  return {{"capture", capture.generic_string()}, {"stages", stages_json}, {"started", started}};
}

RunSummary RunCapture(const RunOptions& options) {
  const Capture capture = ReadCapture(options.capture);
  RequireKnownViews(capture, options.choices.exclude);
  std::vector<StageStep> steps =
      SelectSteps(StageSteps(capture, options.choices), options.from, options.until);
  for (const std::string& note : KeepOptions(capture, &steps)) spdlog::info("{}", note);
  RequireEarlierResults(capture, steps);
  const fs::path ninja = RequireNinja();
  const auto lock = LockRun(capture.work());
  RemoveLeftovers(capture.work());
  const std::vector<NinjaEdge> edges = Edges(capture, steps, options.force);
  const RunPlan plan = PlanOf(capture, edges);
  for (const auto& [stage, seconds] : plan.stages) {
    RequireMemoryForStage(stage, capture, SizeOf(capture), std::max(1, options.threads));
  }
  WriteFileAtomically(capture.work() / "build.ninja",
                      NinjaText(edges, RequireGlintProgram("glint"), options.choices));
  const OutcomeFile outcomes;
  const ResultDescriptor results(options.quiet_stdout);
  ChildProcess child =
      NinjaProcess(ninja, capture, options, steps, plan, outcomes.descriptor(), results.get());
  child.kept_descriptors.push_back(lock->descriptor());
  const int code = RunChild(child);
  RunSummary summary;
  summary.capture = capture.folder;
  for (const StageStep& step : steps) summary.stages.push_back(step.stage);
  summary.outcomes = outcomes.Read();
  if (code != 0) ThrowFailure(summary, code);
  return summary;
}

}  // namespace glint
