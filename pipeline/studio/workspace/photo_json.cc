#include "pipeline/studio/workspace/photo_json.h"

#include <algorithm>

namespace glint {
namespace {

// 1: edges as sharp as a good phone's (1.5 px of 4000, triage.h), falling with their width.
Json SharpnessOf(const PhotoMeasures& measures) {
  constexpr double kGoodShare = 1.5 / 4000;
  const double width_px = std::max(measures.edge_px, measures.blur_px);
  const int side_px = std::max(measures.file.image.width, measures.file.image.height);
  if (!(width_px > 0) || side_px == 0) return nullptr;
  return std::min(1.0, kGoodShare * side_px / width_px);
}

Json DirectionJson(const std::optional<Direction>& direction) {
  if (!direction) return nullptr;
  return {{"tilt_deg", direction->tilt_deg}, {"azimuth_deg", direction->azimuth_deg}};
}

}  // namespace

Json WaitingPhotoJson(const StudioPhoto& photo) {
  return {{"id", photo.id},           {"name", photo.name},         {"thumbnail", nullptr},
          {"state", "waiting"},       {"left_out", photo.left_out}, {"reason", nullptr},
          {"remedy", nullptr},        {"board_found", false},       {"sharpness", nullptr},
          {"clipped_share", nullptr}, {"tilt_deg", nullptr},        {"azimuth_deg", nullptr},
          {"same_as", nullptr},       {"added_s", photo.added_s}};
}

void AddCheck(const CheckedPhoto& checked, const std::string& thumbnail, Json* json) {
  const PhotoCheck& check = *checked.check;
  if (!checked.thumbnail.empty()) {
    (*json)["thumbnail"] = thumbnail + "?v=" + checked.content.substr(0, 8);
  }
  (*json)["board_found"] = check.board_found;
  if (!check.unreadable.empty()) return;
  (*json)["sharpness"] = SharpnessOf(check.measures);
  (*json)["clipped_share"] = check.board_found ? check.clipped_share : check.measures.clipped;
  if (!check.pose) return;
  const Direction direction = DirectionOf(check.pose->camera_in_sample_mm);
  (*json)["tilt_deg"] = direction.tilt_deg;
  (*json)["azimuth_deg"] = direction.azimuth_deg;
}

void AddVerdict(const PhotoVerdict& verdict, const std::map<std::string, std::string>& ids,
                Json* json) {
  (*json)["state"] = StateName(verdict.state);
  if (!verdict.reason.empty()) (*json)["reason"] = verdict.reason;
  if (!verdict.remedy.empty()) (*json)["remedy"] = verdict.remedy;
  const auto same = ids.find(verdict.same_as);
  if (same != ids.end()) (*json)["same_as"] = same->second;
}

Json AdviceJson(const StudioAdvice& advice) {
  return {{"verdict", advice.verdict},
          {"sentence", advice.sentence},
          {"target", DirectionJson(advice.target)},
          {"enough", advice.enough},
          {"list", advice.list}};
}

}  // namespace glint
