#include "base/stages/stages.h"

#include <algorithm>

namespace glint {
namespace {

constexpr StageKind kStages[] = {
    {"calib",
     "cameras, poses and lights from the board",
     {1.5, 0, 0, 0.025, 0, 0, 200, 15, 0, 0, 0}},
    {"rectify",
     "rectified top views of the sample in linear radiance",
     {0.4, 0, 0, 0.012, 0, 0.13, 170, 8, 0, 5, 70}},
    {"fit", "material maps by latent or classic fitting", {1, 0, 7, 0, 1, 0, 330, 0, 60, 0, 190}},
    {"refine", "material maps per texel", {0.2, 0.026, 0, 0, 3, 0.15, 140, 0, 300, 16, 1300}, true},
    {"tile",
     "seamlessly tiling maps ([tile] section in capture.toml)",
     {0.2, 0, 0, 0, 3.2, 0, 140, 0, 300, 0, 0}},
    {"export",
     "maps and materials for other programs",
     {0.15, 0, 0, 0, 1.7, 0, 136, 0, 190, 0, 3000}},
    {"report",
     "one HTML page showing the whole result",
     {0.3, 0, 0, 0, 0.55, 0.1, 280, 0, 130, 3, 520}},
};

}  // namespace

std::span<const StageKind> Stages() { return kStages; }

const StageKind* FindStage(std::string_view name) {
  const auto found = std::find_if(std::begin(kStages), std::end(kStages),
                                  [&](const StageKind& stage) { return stage.name == name; });
  return found == std::end(kStages) ? nullptr : found;
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
