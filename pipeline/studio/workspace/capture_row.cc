#include "pipeline/studio/workspace/capture_row.h"

#include <algorithm>

#include "pipeline/studio/captures/notes.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

double LatestPhoto_s(const std::vector<StudioPhoto>& photos) {
  double latest_s = 0;
  for (const StudioPhoto& photo : photos) latest_s = std::max(latest_s, photo.added_s);
  return latest_s;
}

double ReportedAt_s(const fs::path& capture) {
  return ChangedAt_s(capture / "glint" / "report" / "manifest.json");
}

// "done" or "out of date", of a capture with a report.
std::string StatusOfResult(const LibraryEntry& entry, const std::vector<StudioPhoto>& photos,
                           double result_s) {
  const double described_s = std::max(ChangedAt_s(entry.folder / "capture.toml"),
                                      ChangedAt_s(entry.folder / "board.json"));
  return std::max(described_s, LatestPhoto_s(photos)) > result_s ? "out of date" : "done";
}

std::string StatusOf(const LibraryEntry& entry, const CaptureState& state,
                     const std::vector<StudioPhoto>& photos, RunManager* runs) {
  if (runs->IsRunning(entry.id) || RunsElsewhere(entry.folder)) return "running";
  if (!state.problem.message.empty()) return "failed";
  const bool imported = state.capture && state.capture->imported();
  const bool none_used = std::all_of(photos.begin(), photos.end(),
                                     [](const StudioPhoto& photo) { return photo.left_out; });
  if (none_used && !imported) return "empty";
  const double report_s = ReportedAt_s(entry.folder);
  const double record_s = ChangedAt_s(StudioFolderOf(entry.folder) / "run.json");
  const auto last = runs->Look(entry.id, entry.folder);
  if (last && last->state == "failed" && record_s > report_s) return "failed";
  if (report_s == 0) return "ready";
  const bool done = last && last->state == "done";
  return StatusOfResult(entry, photos, done ? std::max(report_s, record_s) : report_s);
}

Json SizeOf(const CaptureState& state) {
  if (state.capture) return state.capture->sample_size_mm;
  if (state.draft && state.draft->size_mm) return *state.draft->size_mm;
  return nullptr;
}

double CaptureChangedAt_s(const LibraryEntry& entry, const std::vector<StudioPhoto>& photos) {
  const double changed_s = std::max({ChangedAt_s(entry.folder / "capture.toml"),
                                     ReportedAt_s(entry.folder), LatestPhoto_s(photos)});
  return changed_s > 0 ? changed_s : ChangedAt_s(entry.folder);
}

}  // namespace

Json RowJson(const LibraryEntry& entry, const CaptureState& state,
             const std::vector<StudioPhoto>& photos, RunManager* runs) {
  return {{"id", entry.id},
          {"name", entry.name},
          {"kind", KindOf(state)},
          {"size_mm", SizeOf(state)},
          {"photographs", photos.size()},
          {"verdict", NotedVerdict(entry.folder)},
          {"status", StatusOf(entry, state, photos, runs)},
          {"thumbnail", nullptr},
          {"changed_s", CaptureChangedAt_s(entry, photos)}};
}

}  // namespace glint
