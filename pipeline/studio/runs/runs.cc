#include "pipeline/studio/runs/runs.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json_file.h"
#include "base/formats/capture.h"
#include "base/programs/progress.h"
#include "base/programs/subprocess.h"
#include "pipeline/driver/programs.h"
#include "pipeline/driver/stage_graph.h"
#include "pipeline/studio/captures/library.h"
#include "pipeline/studio/captures/program_message.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/runs/results.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kSignalBase = 128;
constexpr int kInterrupted = kSignalBase + SIGINT;
constexpr int kKilled = kSignalBase + SIGKILL;

fs::path RecordOf(const fs::path& folder) { return StudioFolderOf(folder) / "run.json"; }

std::string TextIn(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The last whole line of a file that another program appends to.
std::string LastLine(const fs::path& file) {
  constexpr std::streamoff kTail_bytes = 4096;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : 0;
  if (size <= 0) return "";
  stream.seekg(std::max<std::streamoff>(0, size - kTail_bytes));
  std::string tail((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const size_t end = tail.rfind('\n');
  if (end == std::string::npos || end == 0) return "";
  const size_t begin = tail.rfind('\n', end - 1);
  return tail.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1));
}

std::vector<RunStage> StagesOf(const fs::path& folder, bool quick) {
  RunChoices choices;
  if (quick) choices.method = "initial";
  std::vector<RunStage> stages;
  for (const StageStep& step : StageSteps(ReadCapture(folder), choices)) {
    stages.push_back({step.stage, "waiting", std::nullopt});
  }
  return stages;
}

// Of a run that was killed, what it wrote says nothing; of one that wrote nothing, only its code is
// known.
ProgramMessage FailureIn(const fs::path& log, int code) {
  const std::string remedy = "run it again: earlier results are kept, and it continues from there";
  if (code == kKilled) {
    return {"the run was killed (signal 9), perhaps because memory ran out",
            remedy + "; where that happens again, lower the resolution of the maps"};
  }
  if (code > kSignalBase) {
    return {"the run was ended by signal " + std::to_string(code - kSignalBase), remedy};
  }
  const ProgramMessage said = MessageIn(TextIn(log));
  if (!said.message.empty()) return said;
  return {"the run ended with exit code " + std::to_string(code) + " without a message", remedy};
}

bool IsAfter(const fs::path& file, fs::file_time_type time) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && written >= time;
}

// Stages that have written a new result are done; the one at work keeps its new files in a hidden
// folder; those before it that did neither are up to date.
void AdvanceStages(const fs::path& work, fs::file_time_type began, std::vector<RunStage>* stages) {
  std::error_code error;
  size_t at_work = 0;
  for (size_t i = 0; i < stages->size(); ++i) {
    RunStage& stage = (*stages)[i];
    if (IsAfter(work / stage.name / "manifest.json", began)) {
      stage.state = "done";
      at_work = i + 1;
    } else if (fs::exists(work / ("." + stage.name + ".new"), error)) {
      at_work = i;
    }
  }
  for (size_t i = 0; i < stages->size(); ++i) {
    RunStage& stage = (*stages)[i];
    if (stage.state == "done") continue;
    stage.state = i < at_work ? "up to date" : i == at_work ? "running" : "waiting";
  }
}

// Once the run has ended, no stage runs.
void EndStages(RunView* view) {
  const bool done = view->state == "done", failed = view->state == "failed";
  for (RunStage& stage : view->stages) {
    stage.share.reset();
    if (stage.state == "running") {
      stage.state = done ? "up to date" : failed ? "failed" : "waiting";
    } else if (stage.state == "waiting" && done) {
      stage.state = "up to date";
    }
  }
}

void KeepRecord(const fs::path& folder, const RunView& view) {
  try {
    WriteFileAtomically(RecordOf(folder), ToJson(view).dump(1) + "\n");
  } catch (const Error&) {
  }
}

}  // namespace

struct RunManager::Run {
  std::string capture;
  fs::path folder;
  RunView view;
  fs::file_time_type began;
  std::atomic<bool> cancel = false, ended = false;
  std::thread thread;
};

Json ToJson(const RunView& view) {
  Json json = {{"state", view.state}, {"quick", view.quick},    {"stages", Json::array()},
               {"share", view.share}, {"remaining_s", nullptr}, {"message", nullptr},
               {"remedy", nullptr}};
  for (const RunStage& stage : view.stages) {
    json["stages"].push_back({{"name", stage.name}, {"state", stage.state}, {"share", nullptr}});
    if (stage.share) json["stages"].back()["share"] = *stage.share;
  }
  if (view.remaining_s) json["remaining_s"] = *view.remaining_s;
  if (!view.message.empty()) json["message"] = view.message;
  if (!view.remedy.empty()) json["remedy"] = view.remedy;
  return json;
}

RunManager::RunManager(std::function<void(const std::string&)> on_change)
    : on_change_(std::move(on_change)) {}

RunManager::~RunManager() {
  std::map<std::string, std::shared_ptr<Run>> runs;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    runs.swap(runs_);
  }
  for (auto& [id, run] : runs) run->cancel = true;
  for (auto& [id, run] : runs) run->thread.join();
}

void RunManager::Start(const std::string& capture, const fs::path& folder, bool quick) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (const auto found = runs_.find(capture); found != runs_.end()) {
    if (!found->second->ended) {
      throw HttpError{409, "this capture is being run already", "wait for it, or cancel it"};
    }
    found->second->thread.join();
    runs_.erase(found);
  }
  if (RunsElsewhere(folder)) {
    throw HttpError{409, "another glint run is working on this capture", "wait until it has ended"};
  }
  auto run = std::make_shared<Run>();
  run->capture = capture;
  run->folder = folder;
  run->view.quick = quick;
  run->view.stages = StagesOf(folder, quick);
  run->began = fs::file_time_type::clock::now();
  std::error_code error;
  fs::create_directories(StudioFolderOf(folder), error);
  if (error) {
    throw HttpError{500, "the capture's folder cannot be written: " + error.message(),
                    "make it writable"};
  }
  KeepPreviousMaps(folder);
  Run* const one = run.get();
  run->thread = std::thread([this, one] { Watch(one); });
  runs_[capture] = run;
}

void RunManager::Cancel(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto found = runs_.find(capture);
  if (found != runs_.end()) found->second->cancel = true;
}

bool RunManager::IsRunning(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto found = runs_.find(capture);
  return found != runs_.end() && !found->second->ended;
}

std::optional<RunView> RunManager::Look(const std::string& capture, const fs::path& folder) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto found = runs_.find(capture);
    if (found != runs_.end()) return found->second->view;
  }
  std::error_code error;
  if (!fs::is_regular_file(RecordOf(folder), error)) return std::nullopt;
  try {
    const Json json = ReadJsonFile(RecordOf(folder), "run it again");
    RunView view;
    view.state = json.at("state").get<std::string>();
    view.quick = json.at("quick").get<bool>();
    view.share = json.at("share").get<double>();
    if (json.at("message").is_string()) view.message = json["message"].get<std::string>();
    if (json.at("remedy").is_string()) view.remedy = json["remedy"].get<std::string>();
    for (const Json& stage : json.at("stages")) {
      view.stages.push_back({stage.at("name").get<std::string>(),
                             stage.at("state").get<std::string>(), std::nullopt});
    }
    return view;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

// Its exit code; why it could not start goes to `failure`.
int RunManager::RunProgram(Run* run, const fs::path& log, std::string* failure) {
  const fs::path progress = StudioFolderOf(run->folder) / "progress";
  std::error_code error;
  fs::remove(log, error);
  std::ofstream(progress, std::ios::trunc).close();
  try {
    std::vector<std::string> command = {RequireGlintProgram("glint-run").string(),
                                        run->folder.string()};
    if (run->view.quick) command.emplace_back("--quick");
    RunInGroupOptions options;
    options.environment = {std::string(kProgressFileVariable) + "=" + progress.string()};
    options.cancelled = [&] {
      UpdateProgress(run);
      return run->cancel.load();
    };
    return RunInGroup(command, log, options);
  } catch (const Error& cannot_start) {
    *failure = cannot_start.what();
    return kExitEnvironment;
  }
}

void RunManager::Watch(Run* run) {
  const fs::path log = StudioFolderOf(run->folder) / "run.log";
  std::string failure;
  const int code = RunProgram(run, log, &failure);
  UpdateProgress(run);
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    RunView& view = run->view;
    view.remaining_s.reset();
    view.state = code == 0 ? "done" : run->cancel || code == kInterrupted ? "cancelled" : "failed";
    if (view.state == "done") view.share = 1;
    EndStages(&view);
    if (view.state == "failed") {
      const ProgramMessage said = failure.empty() ? FailureIn(log, code) : SplitMessage(failure);
      view.message = said.message;
      view.remedy = said.remedy;
    }
    KeepRecord(run->folder, view);
    run->ended = true;
  }
  on_change_(run->capture);
}

void RunManager::UpdateProgress(Run* run) {
  const Json last = Json::parse(LastLine(StudioFolderOf(run->folder) / "progress"), nullptr, false);
  bool changed = false;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    RunView& view = run->view;
    const std::string before = ToJson(view).dump();
    AdvanceStages(run->folder / "glint", run->began, &view.stages);
    if (last.is_object()) {
      view.share = std::max(view.share, last.value("share", 0.0));
      view.remaining_s.reset();
      if (last.contains("remaining_s") && last["remaining_s"].is_number()) {
        view.remaining_s = last["remaining_s"].get<double>();
      }
    }
    changed = ToJson(view).dump() != before;
  }
  if (changed) on_change_(run->capture);
}

bool RunsElsewhere(const fs::path& capture) {
  const fs::path file = capture / "glint" / ".lock-run";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  try {
    const FileLock lock(file, "");
    return false;
  } catch (const UserError&) {
    return true;
  } catch (const Error&) {  // a read-only folder: nobody writes there
    return false;
  }
}

}  // namespace glint
