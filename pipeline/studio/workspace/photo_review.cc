#include "pipeline/studio/workspace/photo_review.h"

#include "base/photos/photo_name.h"
#include "pipeline/studio/captures/library.h"
#include "pipeline/studio/workspace/photo_json.h"

namespace glint {
namespace {

// What a judgement depends on beside the photographs.
std::string KeyOfTask(const CaptureState& state) {
  if (!state.capture) return "draft\n";
  return TaskOf(state).Key() + std::to_string(state.capture->resolution_px[0]) + " " +
         std::to_string(static_cast<int>(state.capture->kind)) + "\n";
}

StudioAdvice AdviceOf(const CaptureState& state, const std::vector<NamedCheck>& used,
                      const std::vector<LeftOutPhoto>& left_out) {
  if (state.capture) return AdviseFor(*state.capture, used, left_out);
  if (!state.draft) return {};
  Capture nothing_known;
  nothing_known.photos = {"photographs"};  // not an imported set
  return AdviseFor(nothing_known, used, left_out);
}

}  // namespace

struct PhotoReviewer::Judgement {
  std::string key;  // of everything it depends on
  std::vector<PhotoVerdict> verdicts;
  StudioAdvice advice;
};

// The photographs whose check is done.
struct PhotoReviewer::Checked {
  std::string key;
  std::vector<NamedCheck> checks;
  std::vector<size_t> index;   // of each among all photographs
  std::vector<bool> left_out;  // by the person, or earlier
};

CheckTask TaskOf(const CaptureState& state) {
  return state.capture ? CheckTaskOf(*state.capture) : CheckTask();
}

std::filesystem::path CheckFolderOf(const std::filesystem::path& capture) {
  return StudioFolderOf(capture) / "checks";
}

std::shared_ptr<const PhotoReviewer::Judgement> PhotoReviewer::JudgementOf(
    const std::string& capture, const CaptureState& state, const Checked& checked) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto& kept = judgements_[capture];
    if (kept && kept->key == checked.key) return kept;
  }
  auto judgement = std::make_shared<Judgement>();
  judgement->key = checked.key;
  judgement->verdicts = JudgePhotos(checked.checks, TaskOf(state));
  std::vector<NamedCheck> used;
  std::vector<LeftOutPhoto> left_out;
  for (size_t i = 0; i < checked.checks.size(); ++i) {
    const PhotoVerdict& verdict = judgement->verdicts[i];
    const bool bad = verdict.state == PhotoVerdict::State::kBad;
    if (!bad && !checked.left_out[i]) used.push_back(checked.checks[i]);
    if (bad) left_out.push_back({checked.checks[i].name, verdict.reason});
  }
  judgement->advice = AdviceOf(state, used, left_out);
  const std::lock_guard<std::mutex> guard(mutex_);
  judgements_[capture] = judgement;
  return judgement;
}

PhotoReview PhotoReviewer::Review(const std::string& capture, const CaptureState& state,
                                  const std::vector<StudioPhoto>& photos,
                                  const std::string& thumbnails, CheckQueue* checks) {
  PhotoReview review;
  Checked checked;
  checked.key = KeyOfTask(state);
  std::map<std::string, std::string> ids;
  const CheckTask task = TaskOf(state);
  for (const StudioPhoto& photo : photos) {
    Json& json = review.photographs.emplace_back(WaitingPhotoJson(photo));
    ids[photo.name] = photo.id;
    if (SplitPhotoName(photo.file).frame >= 0) {  // of a video: a stage will look at it
      json["state"] = "good";
      continue;
    }
    const CheckedPhoto one = checks->Look(capture, photo.file, task, CheckFolderOf(state.folder));
    if (one.state != CheckState::kDone) {
      json["state"] = one.state == CheckState::kWaiting ? "waiting" : "checking";
      continue;
    }
    AddCheck(one, thumbnails + photo.id, &json);
    checked.checks.push_back({photo.name, *one.check});
    checked.index.push_back(review.photographs.size() - 1);
    checked.left_out.push_back(photo.left_out);
    checked.key += photo.place + "\n" + one.content + (photo.left_out ? "-\n" : "+\n");
  }
  const auto judgement = JudgementOf(capture, state, checked);
  for (size_t i = 0; i < checked.checks.size(); ++i) {
    AddVerdict(judgement->verdicts[i], ids, &review.photographs[checked.index[i]]);
  }
  review.advice = judgement->advice;
  return review;
}

}  // namespace glint
