// A capture's photographs with everything that is said of them, each and together.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "pipeline/studio/captures/capture_state.h"
#include "pipeline/studio/captures/photo_list.h"
#include "pipeline/studio/photographs/advise.h"
#include "pipeline/studio/photographs/check_queue.h"

namespace glint {

// What the photographs of a capture are checked against; of a draft: nothing.
CheckTask TaskOf(const CaptureState& state);

// Where checks of the capture's photographs are kept.
std::filesystem::path CheckFolderOf(const std::filesystem::path& capture);

struct PhotoReview {
  Json photographs = Json::array();
  StudioAdvice advice;
};

class PhotoReviewer {
 public:
  // Photographs that have not been checked are queued. `thumbnails` stands before their ids in
  // addresses.
  PhotoReview Review(const std::string& capture, const CaptureState& state,
                     const std::vector<StudioPhoto>& photos, const std::string& thumbnails,
                     CheckQueue* checks);

 private:
  struct Judgement;  // takes a while for hundreds of photographs, so that the last one is kept
  struct Checked;
  std::shared_ptr<const Judgement> JudgementOf(const std::string& capture,
                                               const CaptureState& state, const Checked& checked);

  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const Judgement>> judgements_;  // by capture
};

}  // namespace glint
