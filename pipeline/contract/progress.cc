#include "pipeline/contract/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace glint {
namespace {

constexpr int kBarWidth = 30;
constexpr double kRedrawEvery_s = 0.1;

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Progress::Progress(std::string label, std::int64_t total)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  Draw(true, "");
}

Progress::~Progress() {
  if (!terminal_) return;
  Draw(true, "");
  std::fputc('\n', stderr);
}

void Progress::Advance(std::int64_t steps, const std::string& note) {
  done_ += steps;
  Draw(false, note);
}

void Progress::Set(std::int64_t done, const std::string& note) {
  done_ = done;
  Draw(false, note);
}

void Progress::Draw(bool force, const std::string& note) {
  if (!terminal_) return;
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!force && Seconds(now - last_draw_) < kRedrawEvery_s) return;
  last_draw_ = now;
  const double fraction =
      std::clamp(static_cast<double>(done_) / static_cast<double>(total_), 0.0, 1.0);
  const double elapsed_s = Seconds(now - start_);
  const std::string filled(static_cast<size_t>(fraction * kBarWidth), '#');
  std::fprintf(stderr, "\r%-10s [%-*s] %3.0f%%", label_.c_str(), kBarWidth, filled.c_str(),
               100 * fraction);
  if (fraction > 0 && fraction < 1) {
    std::fprintf(stderr, " %4.0f s left", elapsed_s / fraction - elapsed_s);
  } else {
    std::fprintf(stderr, " %4.0f s     ", elapsed_s);
  }
  std::fprintf(stderr, " %s\033[K", note.c_str());
  std::fflush(stderr);
}

}  // namespace glint
