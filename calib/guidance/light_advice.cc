#include "calib/guidance/light_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/guidance/advice.h"

namespace glint {
namespace {

// Lights nearer than this to the normal come from no side.
constexpr double kAbove_deg = 20;

double Elevation_deg(const ViewFacts& view) { return 90 - view.light.tilt_deg; }

void AddFewLights(const Verdict& v, std::vector<Advice>* list) {
  const int now = static_cast<int>(v.views.size());
  if (now >= v.limits.enough_lights) return;
  list->push_back({"few_lights",
                   now < v.limits.few_lights ? Importance::kUseful : Importance::kHint,
                   fmt::format("{} light{}: {} or more, spread over the hemisphere, are needed to "
                               "tell gloss, relief and shadows apart",
                               now, now == 1 ? "" : "s", v.limits.enough_lights)});
}

void AddLightSides(const Verdict& v, std::vector<Advice>* list) {
  if (v.light_gap.width_deg <= v.limits.light_gap_deg) return;
  list->push_back(
      {"light_sides", Importance::kUseful,
       fmt::format("no light from the {} (a gap of {:.0f}° out of 360°), so slopes toward "
                   "it are poorly determined: add some from there",
                   SideName(v.light_gap.middle_deg), v.light_gap.width_deg)});
}

void AddHeights(const Verdict& v, std::vector<Advice>* list) {
  if (v.highest_light_deg < v.limits.high_deg) {
    list->push_back(
        {"high_lights", Importance::kUseful,
         fmt::format("the highest light is {:.0f}° above the sample's plane: highlights on level "
                     "parts, which reveal roughness, need lights above {:.0f}°",
                     v.highest_light_deg, v.limits.high_deg)});
  }
  if (v.lowest_light_deg > v.limits.low_deg) {
    list->push_back({"low_lights", Importance::kHint,
                     fmt::format("the lowest light is {:.0f}° above the sample's plane: fine "
                                 "relief shows best in light from 15 to {:.0f}°",
                                 v.lowest_light_deg, v.limits.low_deg)});
  }
}

}  // namespace

void DescribeLights(const GuidanceInput& input, Verdict* verdict) {
  std::vector<GuidancePhoto> from_light = input.photos;
  for (GuidancePhoto& photo : from_light) photo.camera_in_sample_mm = photo.light_in_sample_mm;
  verdict->light_gap = LargestGap(from_light, kAbove_deg);
  for (const ViewFacts& view : verdict->views) {
    verdict->lowest_light_deg = std::min(verdict->lowest_light_deg, Elevation_deg(view));
    verdict->highest_light_deg = std::max(verdict->highest_light_deg, Elevation_deg(view));
  }
}

std::string LightSummary(const Verdict& verdict) {
  return fmt::format(
      "camera fixed, {} light{}, {:.0f} to {:.0f}° above the sample's plane, the largest gap in "
      "azimuth {:.0f}°",
      verdict.views.size(), verdict.views.size() == 1 ? "" : "s", verdict.lowest_light_deg,
      verdict.highest_light_deg, verdict.light_gap.width_deg);
}

std::vector<Advice> LightAdviceFor(const GuidanceInput& input, const Verdict& verdict) {
  std::vector<Advice> list;
  AddFewLights(verdict, &list);
  AddLightSides(verdict, &list);
  AddHeights(verdict, &list);
  AddClipped(verdict, "use a shorter exposure", &list);
  AddLeftOut(input, verdict, "correct the list of lights, or leave these photographs out", &list);
  std::stable_sort(list.begin(), list.end(), [](const Advice& a, const Advice& b) {
    return static_cast<int>(a.importance) < static_cast<int>(b.importance);
  });
  return list;
}

}  // namespace glint
