#include "pipeline/studio/workspace/left_out.h"

#include <set>
#include <string>
#include <vector>

#include "pipeline/studio/captures/capture_edit.h"
#include "pipeline/studio/captures/notes.h"
#include "pipeline/studio/captures/photo_list.h"
#include "pipeline/studio/photographs/advise.h"
#include "pipeline/studio/workspace/photo_review.h"

namespace glint {

void LeaveOutBad(const std::filesystem::path& capture, CheckQueue* checks) {
  std::set<std::string> undecided = UndecidedPhotos(capture);
  if (undecided.empty() || IsDraft(capture)) return;
  const CaptureState state = ReadState(capture);
  if (!state.capture || !state.capture->has_board) return;
  const CheckTask task = TaskOf(state);
  std::vector<NamedCheck> checked;
  std::vector<std::string> places;
  for (const StudioPhoto& photo : PhotosOf(state)) {
    const CheckedPhoto one = checks->Peek(photo.file, task);
    if (one.state != CheckState::kDone) continue;
    checked.push_back({photo.name, *one.check});
    places.push_back(photo.place);
  }
  const auto verdicts = JudgePhotos(checked, task);
  std::set<std::string> bad;
  for (size_t i = 0; i < places.size(); ++i) {
    if (undecided.erase(places[i]) == 0) continue;
    if (verdicts[i].state == PhotoVerdict::State::kBad) bad.insert(places[i]);
  }
  if (!bad.empty()) {
    EditLeftOut(capture,
                [&](std::set<std::string>* left_out) { left_out->insert(bad.begin(), bad.end()); });
  }
  NoteUndecided(capture, undecided);
}

}  // namespace glint
