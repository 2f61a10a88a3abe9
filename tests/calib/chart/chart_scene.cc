#include "tests/calib/chart/chart_scene.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/chart/cielab.h"
#include "calib/chart/plane_map.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint::testing {
namespace {

Eigen::Matrix3d MatrixOf(const std::array<double, 9>& v) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
}

constexpr double kCard = 0.03, kTable = 0.25, kCardMargin = 0.06;

// Linear Rec.709 reflectance of what lies at a point of the chart's plane.
Eigen::Vector3d ReflectanceAt(const Chart& chart, const std::vector<Eigen::Vector3d>& colours,
                              const Eigen::Vector2d& at) {
  for (size_t i = 0; i < chart.patches.size(); ++i) {
    const ChartPatch& patch = chart.patches[i];
    if ((at - patch.centre).lpNorm<Eigen::Infinity>() <= patch.half_side) return colours[i];
  }
  const Eigen::Array2d margin = Eigen::Array2d::Constant(kCardMargin * chart.size.x());
  const bool on_card =
      (at.array() > -margin).all() && (at.array() < chart.size.array() + margin).all();
  return Eigen::Vector3d::Constant(on_card ? kCard : kTable);
}

}  // namespace

std::vector<NamedMatrix> CameraMatrices() {
  return {{"reflex A",
           MatrixOf({0.4716, 0.0603, -0.0830, -0.7798, 1.5474, 0.2480, -0.1496, 0.1937, 0.6651})},
          {"reflex B",
           MatrixOf({0.8139, -0.2171, -0.0663, -0.8747, 1.6541, 0.2295, -0.1925, 0.2008, 0.8093})},
          {"mirrorless",
           MatrixOf({0.7374, -0.2389, -0.0551, -0.5435, 1.3162, 0.2519, -0.1006, 0.1795, 0.6552})}};
}

std::vector<NamedWhite> FlashWhites() {
  return {{"daylight", *WhitePoint("D65")},
          {"LED of 4000 K", {1.00962, 1, 0.64350}},  // CIE F-series' F11, which has its colour
          {"tungsten", *WhitePoint("A")}};
}

Eigen::Matrix3d CameraFromRec709(const Eigen::Matrix3d& camera_from_xyz,
                                 const Eigen::Vector3d& flash_white) {
  const Eigen::Vector3d d50 = *WhitePoint("D50");
  Eigen::Matrix3d camera;
  for (int c = 0; c < 3; ++c) {
    camera.col(c) = camera_from_xyz * AdaptedXyz(XyzD50FromRec709().col(c), d50, flash_white);
  }
  const Eigen::Vector3d white = camera.rowwise().sum();
  camera = white.array().pow(-0.8).matrix().asDiagonal() * camera;
  return camera / camera.rowwise().sum().maxCoeff();
}

double FlashAt(const ChartShot& shot, const Eigen::Vector2d& from_middle) {
  const Eigen::Vector3d& flash = shot.flash;
  const double squared = (from_middle - flash.head<2>()).squaredNorm() + flash.z() * flash.z();
  return std::pow(squared / flash.squaredNorm(), -1.5);
}

Photo PhotographOf(const Chart& chart, const ChartShot& shot) {
  std::vector<Eigen::Vector3d> colours;
  for (const ChartPatch& patch : chart.patches) colours.push_back(Rec709FromLab(patch.lab));
  const Eigen::Matrix3d chart_from_image =
      MapOfFourPoints(shot.corners_px, CornersOf(Eigen::Vector2d(0, 0), chart.size));
  Random random(shot.seed);
  Photo photo;
  photo.bits = shot.bits;
  photo.format = shot.bits == 32 ? "openexr" : "png";
  Image image(shot.width, shot.height, kRgbChannels);
  for (int y = 0; y < shot.height; ++y) {
    for (int x = 0; x < shot.width; ++x) {
      const Eigen::Vector2d at = Mapped(chart_from_image, Eigen::Vector2d(x + 0.5, y + 0.5));
      const Eigen::Vector3d seen = shot.white * FlashAt(shot, chart.FromMiddle(at)) * shot.camera *
                                   ReflectanceAt(chart, colours, at);
      for (int c = 0; c < 3; ++c) {
        const double linear = std::max(
            0.0, seen[c] + shot.noise * std::sqrt(std::max(0.0, seen[c])) * random.Normal());
        const double stored =
            shot.bits == 32 ? linear
                            : std::round(255 * std::pow(std::min(linear, 1.0), 1 / 2.2)) / 255;
        image.channel(c)[static_cast<size_t>(y) * shot.width + x] = static_cast<float>(stored);
      }
    }
  }
  photo.image = Stored(image, shot.bits);
  return photo;
}

}  // namespace glint::testing
