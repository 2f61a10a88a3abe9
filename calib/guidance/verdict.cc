#include "calib/guidance/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/guidance/advice.h"
#include "calib/guidance/expected_error.h"
#include "calib/guidance/light_advice.h"

namespace glint {
namespace {

constexpr size_t kMostLines = 6;

ViewFacts FactsOf(const GuidanceInput& input, const GuidancePhoto& photo,
                  const CoverageGrid& grid) {
  ViewFacts facts;
  facts.photo = photo.name;
  facts.camera = DirectionOf(photo.camera_in_sample_mm);
  facts.light = DirectionOf(photo.light_in_sample_mm);
  facts.distance_mm = photo.camera_in_sample_mm.norm();
  facts.shown_share = ShownShare(photo, grid);
  facts.clipped_share = photo.clipped_share;
  facts.blur_px = photo.blur_px;
  facts.texel_px = PixelsPerMm(photo) * input.sample_size_mm[0] / input.resolution_px[0];
  facts.least_half_angle_deg = 180;
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    const Eigen::Vector2d at = grid.Centre_mm(cell);
    if (!ShowsPoint(photo, at)) continue;
    facts.least_half_angle_deg =
        std::min(facts.least_half_angle_deg,
                 HalfAngle_deg(photo.camera_in_sample_mm, photo.light_in_sample_mm, at));
  }
  return facts;
}

std::string ImportanceName(Importance importance) {
  switch (importance) {
    case Importance::kNeeded:
      return "needed";
    case Importance::kUseful:
      return "useful";
    case Importance::kHint:
      break;
  }
  return "hint";
}

Json ToJson(const Direction& direction) {
  return {{"tilt_deg", direction.tilt_deg}, {"azimuth_deg", direction.azimuth_deg}};
}

Json ViewsJson(const Verdict& verdict) {
  Json views = Json::array();
  for (const ViewFacts& view : verdict.views) {
    views.push_back({{"photo", view.photo},
                     {"tilt_deg", view.camera.tilt_deg},
                     {"azimuth_deg", view.camera.azimuth_deg},
                     {"light_tilt_deg", view.light.tilt_deg},
                     {"light_azimuth_deg", view.light.azimuth_deg},
                     {"distance_mm", view.distance_mm},
                     {"least_half_angle_deg", view.least_half_angle_deg},
                     {"sample_shown", view.shown_share},
                     {"sample_clipped", view.clipped_share},
                     {"pixels_per_texel", view.texel_px}});
  }
  return views;
}

}  // namespace

std::string Verdict::Word() const {
  std::string word = "good";
  for (const Advice& one : advice) {
    if (one.importance == Importance::kNeeded) return "not enough";
    if (one.importance == Importance::kUseful) word = "usable";
  }
  return word;
}

std::string Verdict::Summary() const {
  if (fixed_camera) return LightSummary(*this);
  double low = 180, high = 0;
  for (const ViewFacts& view : views) {
    low = std::min(low, view.camera.tilt_deg);
    high = std::max(high, view.camera.tilt_deg);
  }
  std::string text = fmt::format(
      "{} photograph{}, {} within {:.0f}° of vertical, tilts {:.0f} to {:.0f}°; a highlight on "
      "{:.0f} % of the sample",
      views.size(), views.size() == 1 ? "" : "s", top_views, limits.top_deg, low, high,
      100 * highlight_share);
  if (sharpest_texel_px > 0) text += fmt::format("; {:.1f} pixels per texel", sharpest_texel_px);
  return text;
}

Verdict Judge(const GuidanceInput& input, const GuidanceLimits& limits) {
  Verdict verdict;
  verdict.limits = limits;
  const CoverageGrid grid = MakeCoverageGrid(input.sample_size_mm);
  for (const GuidancePhoto& photo : input.photos) {
    verdict.views.push_back(FactsOf(input, photo, grid));
    const ViewFacts& view = verdict.views.back();
    if (view.camera.tilt_deg <= limits.top_deg) ++verdict.top_views;
    if (view.camera.tilt_deg >= limits.tilted_deg) ++verdict.tilted_views;
    verdict.sharpest_texel_px = std::max(verdict.sharpest_texel_px, view.texel_px);
  }
  verdict.gap = LargestGap(input.photos, limits.tilted_deg);
  verdict.coverage = ComputeCoverage(grid, input.photos);
  verdict.fixed_camera = input.fixed_camera;
  if (input.fixed_camera) DescribeLights(input, &verdict);
  verdict.shown_share = verdict.coverage.ShownShare();
  verdict.highlight_share = verdict.coverage.HighlightShare(limits.highlight_deg);
  if (!input.fixed_camera)
    verdict.suggestions =
        SuggestForHighlights(verdict.coverage, input.photos, limits.highlight_deg);
  verdict.highlight_share_then = verdict.highlight_share;
  for (const Suggestion& one : verdict.suggestions) {
    verdict.highlight_share_then += one.gain_share;
  }
  verdict.advice = input.fixed_camera ? LightAdviceFor(input, verdict) : AdviceFor(input, verdict);
  return verdict;
}

std::string TextOf(const Verdict& verdict) {
  std::string text = "guidance: " + verdict.Word() + ": " + verdict.Summary() + "\n";
  for (size_t i = 0; i < std::min(kMostLines, verdict.advice.size()); ++i) {
    text += "  - " + verdict.advice[i].text + "\n";
  }
  return text;
}

Json ToJson(const Verdict& verdict) {
  const ExpectedError expected = ErrorForPhotos(static_cast<double>(verdict.views.size()));
  Json json;
  json["verdict"] = verdict.Word();
  json["summary"] = verdict.Summary();
  json["advice"] = Json::array();
  for (const Advice& one : verdict.advice) {
    json["advice"].push_back(
        {{"topic", one.topic}, {"importance", ImportanceName(one.importance)}, {"text", one.text}});
  }
  json["photographs"] = verdict.views.size();
  json["top_views"] = verdict.top_views;
  json["tilted_views"] = verdict.tilted_views;
  json["largest_gap_deg"] = verdict.gap.width_deg;
  if (verdict.fixed_camera) {
    json["lights"] = {{"largest_gap_deg", verdict.light_gap.width_deg},
                      {"lowest_deg", verdict.lowest_light_deg},
                      {"highest_deg", verdict.highest_light_deg}};
  }
  json["highlight_deg"] = verdict.limits.highlight_deg;
  json["highlight_share"] = verdict.highlight_share;
  json["highlight_share_with_suggestions"] = verdict.highlight_share_then;
  json["shown_share"] = verdict.shown_share;
  json["pixels_per_texel"] = verdict.sharpest_texel_px;
  json["expected_error"] = {{"maps", expected.maps}, {"render", expected.render}};
  json["suggestions"] = Json::array();
  for (const Suggestion& one : verdict.suggestions) {
    json["suggestions"].push_back(ToJson(one.direction));
    json["suggestions"].back()["gain"] = one.gain_share;
  }
  json["views"] = ViewsJson(verdict);
  return json;
}

}  // namespace glint
