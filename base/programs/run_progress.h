// Where a stage stands within a whole `glint run`, for its progress bar.
#pragma once

#include <optional>
#include <string>

namespace glint {

// Seconds as predicted (base/programs/cost_model.h) for the stages before this one, for this
// one and for those after it, and when the run began (seconds since 1970).
struct RunProgress {
  double began_s = 0;
  double before_s = 0, stage_s = 0, after_s = 0;

  // Share of the whole run that is done when `stage_share` of this stage is.
  double Share(double stage_share) const;
  // By how long this run has taken for what it has done; none while that says too little.
  std::optional<double> Remaining_s(double stage_share, double now_s) const;
};

inline constexpr char kRunProgressVariable[] = "GLINT_RUN_PROGRESS";

// "began before stage after"; none for a text that is not that.
std::optional<RunProgress> ParseRunProgress(const std::string& text);
std::string ToText(const RunProgress& progress);

// The wall clock: seconds since 1970.
double SecondsSince1970();

// "35 s", "4 min", "1 h 10 min"
std::string DurationText(double seconds);

}  // namespace glint
