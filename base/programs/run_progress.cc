#include "base/programs/run_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <locale>
#include <sstream>

namespace glint {
namespace {

// Below this share the elapsed time is mostly that of starting programs.
constexpr double kLeastShare = 0.03;

}  // namespace

double RunProgress::Share(double stage_share) const {
  const double all_s = before_s + stage_s + after_s;
  if (!(all_s > 0)) return 0;
  return std::clamp((before_s + stage_share * stage_s) / all_s, 0.0, 1.0);
}

std::optional<double> RunProgress::Remaining_s(double stage_share, double now_s) const {
  const double share = Share(stage_share);
  if (share < kLeastShare) return std::nullopt;
  return std::max(0.0, (now_s - began_s) * (1 - share) / share);
}

std::optional<RunProgress> ParseRunProgress(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  RunProgress progress;
  if (!(stream >> progress.began_s >> progress.before_s >> progress.stage_s >> progress.after_s)) {
    return std::nullopt;
  }
  return progress;
}

std::string ToText(const RunProgress& progress) {
  return fmt::format("{} {} {} {}", progress.began_s, progress.before_s, progress.stage_s,
                     progress.after_s);
}

double SecondsSince1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string DurationText(double seconds) {
  constexpr double kMinute_s = 60;
  if (seconds < 1.5 * kMinute_s) return fmt::format("{:.0f} s", seconds);
  const int minutes = static_cast<int>(std::lround(seconds / kMinute_s));
  if (minutes < 60) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace glint
