#include "base/stages/stages.h"

#include <algorithm>
#include <iterator>

namespace glint {
namespace {

constexpr StageKind kStages[] = {
    {.name = "calib",
     .summary = "cameras, poses and lights from the board",
     .cost = {.start_s = 1.4,
              .photograph_px_us = 0.0205,
              .start_MB = 140,
              .photograph_MB = 7.5,
              .decoded_px_bytes = 6},
     .runs = Runs::kFromPhotographs,
     .reads = {.photographs = true, .board_photographs = true},
     .gives = Gives::kCalibration},
    {.name = "rectify",
     .summary = "rectified top views of the sample in linear radiance",
     .cost = {.start_s = 0.1,
              .photograph_px_us = 0.0073,
              .photograph_texel_us = 0.17,
              .start_MB = 130,
              .decoded_px_bytes = 5,
              .photograph_texel_bytes = 5,
              .most_MB = 25},
     .runs = Runs::kFromPhotographs,
     .reads = {.photographs = true, .calibration = true},
     .gives = Gives::kViews,
     .imported = true},
    {.name = "fit",
     .summary = "material maps by latent or classic fitting",
     .cost = {.start_s = 0.6,
              .network_s = 2.5,
              .texel_us = 0.5,
              .photograph_texel_us = 0.04,
              .start_MB = 320,
              .texel_bytes = 40,
              .most_MB = 60,
              .network_texel_bytes = 416},
     .reads = {.views = true},
     .is_told = {.method = true, .selected_views = true},
     .gives = Gives::kMaps},
    {.name = "refine",
     .summary = "material maps per texel",
     .cost = {.start_s = 1.6,
              .photograph_pair_s = 0.012,
              .texel_us = 3.6,
              .photograph_texel_us = 0.5,
              .start_MB = 66,
              .texel_bytes = 590,
              .photograph_texel_bytes = 16,
              .most_MB = 1010},
     .runs = Runs::kRefining,
     .reads = {.views = true, .maps = ReadsMaps::kWhole},
     .is_told = {.selected_views = true},
     .gives = Gives::kMaps,
     .by_parts = true},
    {.name = "tile",
     .summary = "seamlessly tiling maps ([tile] section in capture.toml)",
     .cost = {.start_s = 0.2, .texel_us = 3.2, .start_MB = 44, .texel_bytes = 300},
     .runs = Runs::kTiling,
     .reads = {.maps = ReadsMaps::kWhole},
     .is_told = {.maps_from = true},
     .gives = Gives::kMaps},
    {.name = "export",
     .summary = "maps and materials for other programs",
     .cost =
         {.start_s = 0.2, .texel_us = 2.55, .start_MB = 40, .texel_bytes = 190, .most_MB = 3000},
     .reads = {.maps = ReadsMaps::kAny},
     .is_told = {.maps_from = true}},
    {.name = "report",
     .summary = "one HTML page showing the whole result",
     .cost = {.start_s = 0.4,
              .texel_us = 1,
              .photograph_texel_us = 0.1,
              .start_MB = 95,
              .texel_bytes = 130,
              .photograph_texel_bytes = 3,
              .most_MB = 520},
     .reads = {.maps = ReadsMaps::kWhole, .every_stage = true},
     .is_told = {.maps_from = true}},
};
static_assert(std::ranges::count(kStages, true, &StageKind::imported) == 1);

}  // namespace

std::span<const StageKind> Stages() { return kStages; }

const StageKind* FindStage(std::string_view name) {
  const auto found = std::find_if(std::begin(kStages), std::end(kStages),
                                  [&](const StageKind& stage) { return stage.name == name; });
  return found == std::end(kStages) ? nullptr : found;
}

const StageKind* LastGiving(Gives what, std::string_view reader) {
  const StageKind* last = nullptr;
  for (const StageKind& stage : kStages) {
    if (stage.name == reader) break;
    if (stage.gives == what) last = &stage;
  }
  return last;
}

const StageKind& ImportedStage() {
  return *std::find_if(std::begin(kStages), std::end(kStages),
                       [](const StageKind& stage) { return stage.imported; });
}

bool GivesMaps(const StageKind& stage, ReadsMaps which) {
  if (stage.gives != Gives::kMaps || which == ReadsMaps::kNone) return false;
  return which == ReadsMaps::kAny || stage.runs != Runs::kTiling;
}

std::vector<std::string> StagesWithMaps(ReadsMaps which) {
  std::vector<std::string> names;
  for (const StageKind& stage : kStages) {
    if (GivesMaps(stage, which)) names.emplace_back(stage.name);
  }
  return names;
}

std::string ManifestPath(std::string_view stage) {
  return "glint/" + std::string(stage) + "/manifest.json";
}

std::string StageNamesText() {
  std::string text;
  for (const StageKind& stage : kStages) {
    text += (text.empty() ? "" : ", ") + std::string(stage.name);
  }
  return text;
}

}  // namespace glint
