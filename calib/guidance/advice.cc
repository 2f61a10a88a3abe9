#include "calib/guidance/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/name_list.h"
#include "calib/guidance/expected_error.h"

namespace glint {
namespace {

using List = std::vector<Advice>;

std::string Counted(size_t count) {
  return fmt::format("{} photograph{}", count, count == 1 ? "" : "s");
}

int Percent(double share) { return static_cast<int>(std::lround(100 * share)); }

void AddOverBoard(const GuidanceInput& input, List* list) {
  if (input.over_board.empty()) return;
  list->push_back({"over_board", Importance::kNeeded,
                   "the sample as described overlaps the printed board (" + input.over_board +
                       "), which would become part of the material: correct [sample] size_mm and "
                       "centre_mm, or [board] window"});
}

void AddUnseen(const Verdict& v, List* list) {
  if (1 - v.shown_share < v.limits.unseen_share) return;
  std::vector<bool> cells;
  for (const int photos : v.coverage.photos) cells.push_back(photos == 0);
  list->push_back({"unseen", Importance::kNeeded,
                   fmt::format("{:.2g} % of the sample ({}) is in no photograph: take one with the "
                               "whole sample in it",
                               100 * (1 - v.shown_share), RegionName(v.coverage.grid, cells))});
}

void AddFindings(const GuidanceInput& input, List* list) {
  for (const std::string& finding : input.board_findings) {
    list->push_back({"board", Importance::kUseful, finding});
  }
  for (const std::string& finding : input.light_findings) {
    list->push_back({"light", Importance::kUseful, finding});
  }
}

void AddFocal(const GuidanceInput& input, const Verdict& v, List* list) {
  const std::string remedy = "take two or three tilted by 20 to 40° toward different sides";
  if (input.focal_assumed) {
    list->push_back({"focal", Importance::kNeeded,
                     "the focal length cannot be determined from these photographs, so angles here "
                     "are approximate and a calibration would fail: " +
                         remedy});
  } else if (input.focal_sigma >= v.limits.focal_sigma) {
    list->push_back({"focal", Importance::kUseful,
                     fmt::format("the focal length is known only to {:.1f} %: {}",
                                 100 * input.focal_sigma, remedy)});
  }
}

void AddFew(const Verdict& v, List* list) {
  const size_t now = v.views.size();
  const int few = v.limits.few_photos, enough = v.limits.enough_photos;
  if (now >= static_cast<size_t>(enough)) return;
  const bool very_few = now < static_cast<size_t>(few);
  const int then = very_few ? few : enough;
  const ExpectedError a = ErrorForPhotos(static_cast<double>(now)), b = ErrorForPhotos(then);
  list->push_back(
      {"few", very_few ? Importance::kUseful : Importance::kHint,
       fmt::format("{} more photograph{} ({} in all) would lower the error of renderings by about "
                   "{} % and that of the maps by {} % (docs/results/table1.md; rough)",
                   then - now, then - now == 1 ? "" : "s", then, Percent(1 - b.render / a.render),
                   Percent(1 - b.maps / a.maps))});
}

double LargestTilt_deg(const Verdict& v) {
  double largest = 0;
  for (const ViewFacts& view : v.views) largest = std::max(largest, view.camera.tilt_deg);
  return largest;
}

void AddTilted(const Verdict& v, List* list) {
  if (v.tilted_views > 0) return;
  list->push_back({"tilted", Importance::kUseful,
                   fmt::format("all photographs look straight down (within {:.0f}°), which reveals "
                               "little about relief and gloss: take some tilted by 20 to 40° from "
                               "several sides",
                               LargestTilt_deg(v))});
}

void AddSides(const Verdict& v, List* list) {
  if (v.tilted_views == 0 || v.gap.width_deg <= v.limits.gap_deg) return;
  list->push_back({"sides", Importance::kUseful,
                   fmt::format("no tilted photograph from the {} (a gap of {:.0f}° out of 360°): "
                               "take one from there, tilted by 20 to 40°",
                               SideName(v.gap.middle_deg), v.gap.width_deg)});
}

void AddTop(const Verdict& v, List* list) {
  if (v.top_views > 0) return;
  double nearest = 180;
  for (const ViewFacts& view : v.views) nearest = std::min(nearest, view.camera.tilt_deg);
  list->push_back(
      {"top", Importance::kUseful,
       fmt::format("no photograph within {:.0f}° of vertical (the nearest is {:.0f}° off), from "
                   "which the fit would be initialised: take one from directly above",
                   v.limits.top_deg, nearest)});
}

void AddHighlight(const Verdict& v, List* list) {
  const double dark_share = v.shown_share - v.highlight_share;
  if (dark_share < v.limits.dark_share) return;
  std::vector<bool> cells;
  for (size_t i = 0; i < v.coverage.grid.cells(); ++i) {
    cells.push_back(v.coverage.photos[i] > 0 &&
                    v.coverage.least_half_angle_deg[i] > v.limits.highlight_deg);
  }
  std::string text = fmt::format("{} % of the sample ({}) never shows a highlight",
                                 Percent(dark_share), RegionName(v.coverage.grid, cells));
  if (!v.suggestions.empty()) {
    text += fmt::format(": take one {} (adds a highlight to {} %)",
                        InWords(v.suggestions[0].direction), Percent(v.suggestions[0].gain_share));
  }
  if (v.suggestions.size() > 1) {
    text += ", then";
    for (size_t i = 1; i < v.suggestions.size(); ++i) {
      text += (i > 1 ? " and " : " ") + InWords(v.suggestions[i].direction);
    }
    text += fmt::format(" ({} % in all)", Percent(v.highlight_share_then - v.highlight_share));
  }
  list->push_back({"highlight", Importance::kUseful, text});
}

void AddResolution(const GuidanceInput& input, const Verdict& v, List* list) {
  const double px = v.sharpest_texel_px;
  if (px <= 0 || px >= v.limits.texel_px) return;
  double distance_mm = 0;
  for (const ViewFacts& view : v.views) {
    if (view.texel_px == px) distance_mm = view.distance_mm;
  }
  list->push_back(
      {"resolution", Importance::kUseful,
       fmt::format("the sample is small in the photographs: a pixel of the sharpest "
                   "covers {:.1f} texels; move as close as {:.0f} mm (now {:.0f}), or set "
                   "resolution_px = {:.0f}",
                   1 / px, distance_mm * px, distance_mm,
                   std::max(8.0, std::floor(input.resolution_px[0] * px)))});
}

// Pixels that are blurred tell as much as fewer sharp ones.
void AddSoft(const GuidanceInput& input, const Verdict& v, List* list) {
  const ViewFacts* best = nullptr;
  double most_px = 0;  // sharp pixels per texel
  for (const ViewFacts& view : v.views) {
    if (view.blur_px <= 0 || view.texel_px <= 0) return;
    const double px = view.texel_px * std::min(1.0, v.limits.sharp_px / view.blur_px);
    if (px <= most_px) continue;
    most_px = px;
    best = &view;
  }
  if (best == nullptr || most_px >= v.limits.texel_px) return;
  if (v.sharpest_texel_px < v.limits.texel_px) return;  // that is said already
  list->push_back(
      {"soft", Importance::kHint,
       fmt::format(
           "the photographs are soft: even in {} edges are blurred by {:.1f} px (sigma; {:.1f} "
           "is sharp), {:.1f} texels, so that maps show little more than with resolution_px "
           "= {:.0f}; wipe the lens, lock the focus on the board, and move closer",
           best->photo, best->blur_px, v.limits.sharp_px, best->blur_px / best->texel_px,
           std::max(8.0, std::floor(input.resolution_px[0] * most_px)))});
}

void AddCut(const Verdict& v, List* list) {
  std::vector<std::string> names;
  for (const ViewFacts& view : v.views) {
    if (1 - view.shown_share > v.limits.cut_share) {
      names.push_back(fmt::format("{} {} %", view.photo, Percent(view.shown_share)));
    }
  }
  if (names.empty()) return;
  list->push_back({"cut", Importance::kHint,
                   fmt::format("{} show{} only part of the sample: {}", Counted(names.size()),
                               names.size() == 1 ? "s" : "", NameList(names))});
}

}  // namespace

void AddClipped(const Verdict& v, const std::string& remedy, List* list) {
  std::vector<std::string> names;
  double worst = 0;
  for (const ViewFacts& view : v.views) {
    if (view.clipped_share <= v.limits.clipped_share) continue;
    names.push_back(view.photo);
    worst = std::max(worst, view.clipped_share);
  }
  if (names.empty()) return;
  list->push_back({"clipped", Importance::kUseful,
                   fmt::format("up to {} % of the sample is clipped in {} ({}): {}", Percent(worst),
                               Counted(names.size()), NameList(names), remedy)});
}

void AddLeftOut(const GuidanceInput& input, const Verdict& v, const std::string& remedy,
                List* list) {
  if (input.left_out.empty()) return;
  const size_t all = input.left_out.size() + v.views.size();
  const double share = static_cast<double>(input.left_out.size()) / static_cast<double>(all);
  std::vector<std::string> reasons;
  for (const LeftOutPhoto& photo : input.left_out) {
    reasons.push_back(photo.name + ": " + photo.reason);
  }
  list->push_back(
      {"left_out", share > v.limits.left_out_share ? Importance::kUseful : Importance::kHint,
       fmt::format("{} of {} photographs {} left out ({}): {}", input.left_out.size(), all,
                   input.left_out.size() == 1 ? "is" : "are", NameList(reasons, 2), remedy)});
}

std::vector<Advice> AdviceFor(const GuidanceInput& input, const Verdict& verdict) {
  List list;
  AddOverBoard(input, &list);
  AddUnseen(verdict, &list);
  AddFindings(input, &list);
  AddFocal(input, verdict, &list);
  AddFew(verdict, &list);
  AddTilted(verdict, &list);
  AddSides(verdict, &list);
  AddTop(verdict, &list);
  AddHighlight(verdict, &list);
  AddClipped(verdict, "use a shorter exposure or step back", &list);
  AddResolution(input, verdict, &list);
  AddSoft(input, verdict, &list);
  AddLeftOut(input, verdict, "take them again", &list);
  AddCut(verdict, &list);
  std::stable_sort(list.begin(), list.end(), [](const Advice& a, const Advice& b) {
    return static_cast<int>(a.importance) < static_cast<int>(b.importance);
  });
  return list;
}

}  // namespace glint
