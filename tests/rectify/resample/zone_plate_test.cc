// Fine rings that the texels cannot hold must become their mean, not coarser rings.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rectify/resample/resample.h"
#include "tests/rectify/plane_photo.h"

namespace glint {
namespace {

constexpr int kTexels = 96;
constexpr double kSize_mm = 48;
constexpr double kTexel_mm = kSize_mm / kTexels;

// Frequency in cycles per texel grows linearly from the centre, to `kEdge` at the middle of a side.
constexpr double kEdge = 1.3;

double Rings(double x_mm, double y_mm) {
  const double r2 = (x_mm * x_mm + y_mm * y_mm) / (kTexel_mm * kTexel_mm);
  return 0.5 + 0.4 * std::cos(std::numbers::pi * kEdge / (kTexels / 2.0) * r2);
}

double Frequency(double x_mm, double y_mm) {
  return kEdge * std::hypot(x_mm, y_mm) / (kSize_mm / 2);
}

// Mean of the rings over a texel, by 8×8 midpoints.
double TexelMean(double x_mm, double y_mm) {
  double sum = 0;
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 8; ++i) {
      sum +=
          Rings(x_mm + ((i + 0.5) / 8 - 0.5) * kTexel_mm, y_mm + ((j + 0.5) / 8 - 0.5) * kTexel_mm);
    }
  }
  return sum / 64;
}

struct Errors {
  double held_rms = 0;        // against the texel means, where texels hold the rings well
  double fine_rms = 0;        // against the rings' mean, beyond what texels hold
  double fine_point_rms = 0;  // the same for the photo looked up at points
};

Errors Measure(double tilt_deg, double roll_deg, FilterKind filter) {
  // About 5 pixels a texel, 3.5 along the foreshortened direction at 45°.
  const Camera camera = TestCamera(640, 1000, -0.08, 0.02);
  const Rigid3 pose = LookAtSample(100, tilt_deg, roll_deg);
  const CameraProjection projection(camera, pose);
  const Photo taken = PhotographPlane(camera, pose, Rings, 1);
  const LinearPhoto photo(taken, Encoding::kLinear);
  SamplePlane plane;
  plane.width = plane.height = kTexels;
  plane.width_mm = plane.height_mm = kSize_mm;
  ResampleOptions options;
  options.filter = filter;
  const ResampledView view = ResampleToPlane(photo, projection, plane, options);
  double held = 0, fine = 0, point = 0;
  int held_count = 0, fine_count = 0;
  for (int row = 0; row < kTexels; ++row) {
    for (int column = 0; column < kTexels; ++column) {
      const size_t texel = static_cast<size_t>(row) * kTexels + column;
      if (view.status[texel] != TexelStatus::kUsable) continue;
      const double x = plane.x_mm(column), y = plane.y_mm(row);
      const double value = view.rgb[texel];
      if (Frequency(x, y) < 0.2) {
        held += std::pow(value - TexelMean(x, y), 2);
        ++held_count;
      } else if (Frequency(x, y) > 0.85) {
        const Eigen::Vector2d at = *projection.ImageFromPlane(x, y);
        const size_t pixel =
            static_cast<size_t>(at.y()) * camera.width_px + static_cast<size_t>(at.x());
        fine += std::pow(value - 0.5, 2);
        point += std::pow(taken.image.at(pixel, 0) - 0.5, 2);
        ++fine_count;
      }
    }
  }
  EXPECT_GT(held_count, 100);
  EXPECT_GT(fine_count, 3000);
  return {std::sqrt(held / held_count), std::sqrt(fine / fine_count),
          std::sqrt(point / fine_count)};
}

TEST(ZonePlate, DoesNotAliasStraightDown) {
  const Errors errors = Measure(0, 12, FilterKind::kSharp);
  EXPECT_LT(errors.held_rms, 0.015);
  EXPECT_LT(errors.fine_rms, 0.004);
  EXPECT_GT(errors.fine_point_rms, 0.2);  // the rings are there to be aliased
}

TEST(ZonePlate, DoesNotAliasAt45Degrees) {
  for (const double tilt : {45.0, -45.0}) {
    const Errors errors = Measure(tilt, 30, FilterKind::kSharp);
    EXPECT_LT(errors.held_rms, 0.015);
    EXPECT_LT(errors.fine_rms, 0.006);
    EXPECT_GT(errors.fine_point_rms, 0.2);
  }
}

TEST(ZonePlate, OtherKernelsDoNotAliasEither) {
  EXPECT_LT(Measure(45, 30, FilterKind::kSoft).fine_rms, 0.006);
  EXPECT_LT(Measure(45, 30, FilterKind::kLanczos).fine_rms, 0.006);
}

}  // namespace
}  // namespace glint
