// Colour charts: where their patches lie and what colours they have.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct ChartPatch {
  std::string name;
  Eigen::Vector2d centre;  // in the chart's own unit, from the top left of the patches' rectangle
  double half_side;        // of the largest square round the centre that is all patch
  Eigen::Vector3d lab;     // relative to D50
};

// The rectangle that the outer edges of the outermost patches make: x right, y down. A grey card is
// one patch.
struct Chart {
  std::string kind;
  Eigen::Vector2d size;
  std::vector<ChartPatch> patches;

  // From the chart's middle, in half diagonals of the rectangle.
  Eigen::Vector2d FromMiddle(const Eigen::Vector2d& point) const {
    return (point - size / 2) / (size.norm() / 2);
  }
};

inline constexpr std::string_view kGreyCard = "grey";

// Kinds by name: "classic24" (X-Rite ColorChecker Classic), "sg140" (Digital SG), "vinyl18" (DKK),
// with the reference colours that OpenCV's mcc module holds. nullopt: another name.
std::optional<Chart> ChartOfKind(std::string_view kind);

// A neutral card whose `reflectance` (of 1) is the same in R, G and B.
Chart GreyCard(double reflectance);

// Lines of a table with a header: name, x, y and either L, a, b or X, Y, Z (Y of a perfect white is
// 100). x and y are a patch's centre within the rectangle that corners_px tells, from 0 to 1, from
// the left and from the top; `aspect` is the rectangle's width over its height. A patch's side is
// the distance to its nearest neighbour.
// `illuminant`: a name of WhitePoint, to which the colours are relative; adapted to D50 by
// Bradford's method. Throws UserError naming the file and the line.
Chart ReadChartCsv(const std::filesystem::path& file, std::string_view illuminant, double aspect);

}  // namespace glint
