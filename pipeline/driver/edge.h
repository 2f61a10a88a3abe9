// One edge of build.ninja at work: runs a stage's program for `glint run`, which learns through a
// descriptor what Ninja does not pass on: the exit code, and whether the result changed.
//
//   glint --edge STAGE PROGRAM [ARGUMENTS] [--kept ARGUMENTS]     in the capture's folder
//
// Those after --kept a person gave to the stage once; the stage notes them as such again.
//
// The environment says what may differ from run to run without making a result stale:
//   GLINT_RUN_FOLDER     the folder in which the person works
//   GLINT_RUN_CAPTURE    the capture as the person named it, so that messages do too
//   GLINT_RUN_ARGUMENTS  further arguments, one a line (threads, log level)
//   GLINT_RUN_OUTCOMES   number of the descriptor to note outcomes on
//   GLINT_RUN_PLAN       when the run began and how long its stages will take, for progress bars
//   GLINT_RUN_NINJA      Ninja's process number; where this process' parent is another, Ninja was
//                        killed before this process began, which then does nothing
//   GLINT_RUN_STDOUT     number of the descriptor for the program's stdout: Ninja's own has its
//   remarks
// Without them the program runs on the current folder and nothing is noted.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace glint {

inline constexpr char kEdgeFlag[] = "--edge";
inline constexpr char kKeptFlag[] = "--kept";
inline constexpr char kRunFolderVariable[] = "GLINT_RUN_FOLDER";
inline constexpr char kRunCaptureVariable[] = "GLINT_RUN_CAPTURE";
inline constexpr char kRunArgumentsVariable[] = "GLINT_RUN_ARGUMENTS";
inline constexpr char kRunOutcomesVariable[] = "GLINT_RUN_OUTCOMES";
inline constexpr char kRunPlanVariable[] = "GLINT_RUN_PLAN";
inline constexpr char kRunNinjaVariable[] = "GLINT_RUN_NINJA";
inline constexpr char kRunStdoutVariable[] = "GLINT_RUN_STDOUT";

struct EdgeOutcome {
  std::string stage;
  int code = 0;          // exit code, or 128 + signal
  bool changed = false;  // the stage's manifest was written anew
};

// The stages that a run will probably go through, with their seconds as predicted.
struct RunPlan {
  double began_s = 0;  // since 1970
  std::vector<std::pair<std::string, double>> stages;
};
std::string ToText(const RunPlan& plan);
// Where `stage` stands in a plan's text; "" where the text is none, or without the stage.
std::string ProgressOf(const std::string& plan, const std::string& stage);

// Returns the program's exit code. `words` are what follows --edge.
int RunEdge(const std::vector<std::string>& words);

// An anonymous file that edges append their outcomes to; it takes no space on any disk.
class OutcomeFile {
 public:
  OutcomeFile();
  ~OutcomeFile();
  OutcomeFile(const OutcomeFile&) = delete;
  OutcomeFile& operator=(const OutcomeFile&) = delete;
  int descriptor() const { return descriptor_; }
  std::vector<EdgeOutcome> Read() const;

 private:
  int descriptor_ = -1;
};

}  // namespace glint
