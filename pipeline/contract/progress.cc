#include "pipeline/contract/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace glint {
namespace {

constexpr int kBarWidth = 30;
constexpr double kRedrawEvery_s = 0.1;

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::optional<RunProgress> WholeRun() {
  const char* text = std::getenv(kRunProgressVariable);
  return text == nullptr ? std::nullopt : ParseRunProgress(text);
}

}  // namespace

Progress::Progress(std::string label, std::int64_t total, Part part)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      part_(part),
      run_(WholeRun()),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  Draw(true, "");
}

Progress::~Progress() {
  if (!terminal_) return;
  if (!run_) Draw(true, "");
  std::fputs(run_ ? "\r\033[K" : "\n", stderr);
}

void Progress::Advance(std::int64_t steps, const std::string& note) {
  done_ += steps;
  Draw(false, note);
}

void Progress::Set(std::int64_t done, const std::string& note) {
  done_ = done;
  Draw(false, note);
}

std::string Progress::Line(const std::string& note) const {
  const double own = std::clamp(static_cast<double>(done_) / static_cast<double>(total_), 0.0, 1.0);
  double share = own;
  std::optional<double> left_s;
  if (run_) {
    const double of_stage = part_.begin + own * (part_.end - part_.begin);
    share = run_->Share(of_stage);
    left_s = run_->Remaining_s(of_stage, SecondsSince1970());
  } else if (own > 0 && own < 1) {
    left_s = Seconds(std::chrono::steady_clock::now() - start_) * (1 - own) / own;
  }
  const std::string filled(static_cast<size_t>(share * kBarWidth), '#');
  return fmt::format("{:<10} [{:<{}}] {:3.0f}%  {:<14} {}", label_, filled, kBarWidth, 100 * share,
                     left_s ? DurationText(*left_s) + " left" : "", note);
}

void Progress::Draw(bool force, const std::string& note) {
  if (!terminal_) return;
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!force && Seconds(now - last_draw_) < kRedrawEvery_s) return;
  last_draw_ = now;
  std::fprintf(stderr, "\r%s\033[K", Line(note).c_str());
  std::fflush(stderr);
}

}  // namespace glint
