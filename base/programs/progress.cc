#include "base/programs/progress.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "base/files/json.h"

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

int OpenProgressFile() {
  const char* file = std::getenv(kProgressFileVariable);
  return file == nullptr ? -1 : ::open(file, O_WRONLY | O_APPEND | O_NONBLOCK | O_CLOEXEC);
}

}  // namespace

Progress::Progress(std::string label, std::int64_t total, Part part)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      part_(part),
      run_(WholeRun()),
      terminal_(::isatty(STDERR_FILENO) == 1),
      file_(OpenProgressFile()),
      start_(std::chrono::steady_clock::now()) {
  Draw(true, "");
}

Progress::~Progress() {
  if (!run_) Draw(true, "");
  if (terminal_) std::fputs(run_ ? "\r\033[K" : "\n", stderr);
  if (file_ >= 0) ::close(file_);
}

void Progress::Advance(std::int64_t steps, const std::string& note) {
  done_ += steps;
  Draw(false, note);
}

void Progress::Set(std::int64_t done, const std::string& note) {
  done_ = done;
  Draw(false, note);
}

Progress::State Progress::Now() const {
  const double own = std::clamp(static_cast<double>(done_) / static_cast<double>(total_), 0.0, 1.0);
  if (run_) {
    const double of_stage = part_.begin + own * (part_.end - part_.begin);
    return {run_->Share(of_stage), run_->Remaining_s(of_stage, SecondsSince1970())};
  }
  if (!(own > 0 && own < 1)) return {own, std::nullopt};
  return {own, Seconds(std::chrono::steady_clock::now() - start_) * (1 - own) / own};
}

std::string Progress::Line(const State& state, const std::string& note) const {
  const std::string filled(static_cast<size_t>(state.share * kBarWidth), '#');
  return fmt::format("{:<10} [{:<{}}] {:3.0f}%  {:<14} {}", label_, filled, kBarWidth,
                     100 * state.share,
                     state.remaining_s ? DurationText(*state.remaining_s) + " left" : "", note);
}

void Progress::WriteToFile(const State& state, const std::string& note) const {
  Json json = {{"label", label_}, {"share", state.share}, {"remaining_s", nullptr}, {"note", note}};
  if (state.remaining_s) json["remaining_s"] = *state.remaining_s;
  const std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  // Whoever reads may have gone, or be slow: the work goes on all the same.
  [[maybe_unused]] const ssize_t written = ::write(file_, line.data(), line.size());
}

void Progress::Draw(bool force, const std::string& note) {
  if (!terminal_ && file_ < 0) return;
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!force && Seconds(now - last_draw_) < kRedrawEvery_s) return;
  last_draw_ = now;
  const State state = Now();
  if (file_ >= 0) WriteToFile(state, note);
  if (!terminal_) return;
  std::fprintf(stderr, "\r%s\033[K", Line(state, note).c_str());
  std::fflush(stderr);
}

}  // namespace glint
