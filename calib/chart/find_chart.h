// Where a chart of a known kind lies in a photograph.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "base/photos/photo.h"

namespace glint {

// In pixels: the patches' rectangle, from the chart's top left clockwise.
using ChartCorners = std::array<Eigen::Vector2d, 4>;

// OpenCV's mcc module looks for squares in a grid and compares their colours with the kind's. Which
// corner is the top left may be wrong by quarter turns (ChartReader::BestTurn settles it).
// `linear`: stored values are linear, and dark to look at. `longest_px`: the chart is looked for in
// a copy whose longer side has no more pixels. nullopt: no such chart. Precondition: a kind of
// ChartOfKind.
std::optional<ChartCorners> FindChart(const Photo& photo, bool linear, const std::string& kind,
                                      int longest_px = 1600);

}  // namespace glint
