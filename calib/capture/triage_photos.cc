#include "calib/capture/triage_photos.h"

#include <spdlog/spdlog.h>

namespace glint {
namespace {

void Drop(const Remark& remark, std::vector<DetectedPhoto>* photos) {
  for (DetectedPhoto& photo : *photos) {
    if (photo.name != remark.photo || photo.board_photo) continue;
    photo.detection.corners.clear();
    photo.detection.problem = remark.text;
    photo.paper.clear();
  }
}

}  // namespace

std::vector<Remark> TriagePhotos(const CalibOptions& options, std::vector<DetectedPhoto>* photos) {
  if (options.triage == "off") return {};
  std::vector<PhotoMeasures> measures;
  for (const DetectedPhoto& photo : *photos) measures.push_back(photo.measures);
  const std::vector<Remark> remarks = Triage(measures);
  for (const Remark& remark : remarks) {
    const bool dropped = options.triage == "drop" && remark.condemns;
    if (dropped) {
      Drop(remark, photos);
    } else if (remark.photo.empty()) {
      spdlog::warn("{}", remark.text);
    } else {
      spdlog::warn("{}: {}", remark.photo, remark.text);
    }
  }
  return remarks;
}

}  // namespace glint
