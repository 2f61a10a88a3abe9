// `glint run`: writes glint/build.ninja and lets Ninja run the stages that are not up to date.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "pipeline/driver/edge.h"
#include "pipeline/driver/stage_graph.h"

namespace glint {

struct RunOptions {
  std::filesystem::path capture = ".";
  std::string from;      // first stage that may run; earlier results are taken as they are
  std::string until;     // last stage that runs
  bool force = false;    // stages in the range run although their results are up to date
  bool verbose = false;  // Ninja's own lines as well
  RunChoices choices;
  // Handed on to the stages; never changes a result.
  int threads = 0;
  double memory_gb = 0;  // 0: as each program decides (memory_limit.h)
  std::string log_level = "info";
  bool quiet_stdout = false;  // stages' results are not shown (--json)
};

struct RunSummary {
  std::filesystem::path capture;
  std::vector<std::string> stages;    // in the range, in order
  std::vector<EdgeOutcome> outcomes;  // of the stages whose programs were started

  bool Changed(const std::string& stage) const;
  std::string BriefReport() const;
  Json ToJson() const;
};

// Takes glint/.lock-run. A stage that fails has said why on stderr: an Error with its exit code and
// an empty message is thrown. Throws UserError and EnvironmentError for what is wrong before that.
RunSummary RunCapture(const RunOptions& options);

}  // namespace glint
