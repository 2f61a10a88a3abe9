#include "calib/chart/chart_kinds.h"

#include <algorithm>
#include <array>
#include <string>

#include "calib/chart/chart.h"
#include "calib/chart/cielab.h"

namespace glint {
namespace {

constexpr std::array<ChartKind, 3> kKinds = {
    {{"classic24", cv::mcc::MCC24, cv::ccm::COLORCHECKER_Macbeth, 6, 4, false, 2.5, 0.25, 2.5,
      0.25},
     {"sg140", cv::mcc::SG140, cv::ccm::COLORCHECKER_DigitalSG, 14, 10, true, 1.0, 0.1, 1.0, 0.1},
     {"vinyl18", cv::mcc::VINYL18, cv::ccm::COLORCHECKER_Vinyl, 6, 3, false, 2.5, 0.217, 5.45,
      0.221}}};

// Linear Rec.709 of the kind's patches. OpenCV hands out its tables only with a solved correction:
// it is given some colours to correct, in general position, and its solution is not looked at.
cv::Mat ReferenceColours(const ChartKind& kind) {
  const int patches = kind.columns * kind.rows;
  cv::Mat any(patches, 1, CV_64FC3);
  cv::RNG(1).fill(any, cv::RNG::UNIFORM, 0.1, 0.9);
  cv::ccm::ColorCorrectionModel model(any, kind.colours);
  model.setColorSpace(cv::ccm::COLOR_SPACE_sRGB);
  model.setLinear(cv::ccm::LINEARIZATION_IDENTITY);
  model.setDistance(cv::ccm::DISTANCE_RGBL);
  model.setMaxCount(1);
  model.run();
  return model.get_dst_rgbl();
}

double CentreAlong(const ChartKind& kind, int index) {
  return kind.patch / 2 + index * (kind.patch + kind.gap);
}

ChartPatch PatchOf(const ChartKind& kind, const cv::Mat& colours, int column, int row) {
  const int index = kind.by_column ? column * kind.rows + row : row * kind.columns + column;
  const double taller = kind.first_height - kind.patch;
  const cv::Vec3d& rgb = colours.at<cv::Vec3d>(index);
  ChartPatch patch;
  // As their makers do: letters run along the longer side of the SG, along the shorter of others.
  patch.name = kind.by_column
                   ? std::string(1, static_cast<char>('A' + column)) + std::to_string(row + 1)
                   : std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1);
  patch.centre = {CentreAlong(kind, column),
                  CentreAlong(kind, row) + (row == 0 ? taller / 2 : taller)};
  patch.half_side = kind.patch / 2;
  patch.lab = LabFromRec709(Eigen::Vector3d(rgb[0], rgb[1], rgb[2]));
  return patch;
}

}  // namespace

std::span<const ChartKind> ChartKinds() { return kKinds; }

std::optional<Chart> ChartOfKind(std::string_view name) {
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [&](const ChartKind& known) { return known.name == name; });
  if (kind == kKinds.end()) return std::nullopt;
  Chart chart;
  chart.kind = name;
  chart.size = {
      kind->columns * (kind->patch + kind->gap) - kind->gap,
      kind->rows * (kind->patch + kind->gap) - kind->gap + kind->first_height - kind->patch};
  const cv::Mat colours = ReferenceColours(*kind);
  for (int row = 0; row < kind->rows; ++row) {
    for (int column = 0; column < kind->columns; ++column) {
      chart.patches.push_back(PatchOf(*kind, colours, column, row));
    }
  }
  return chart;
}

Chart GreyCard(double reflectance) {
  const Eigen::Vector3d white = *WhitePoint(kLabIlluminant);
  const Eigen::Vector3d lab = LabFromXyz(reflectance * white, white);
  return {std::string(kGreyCard), {1, 1}, {{"grey", {0.5, 0.5}, 0.5, lab}}};
}

}  // namespace glint
