// Two views of a real wall with a known homography: one resampled onto the other must look like it.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "rectify/resample/resample.h"
#include "tests/support/data_folder.h"

namespace glint {
namespace {

std::filesystem::path GraffitiFolder() { return test::DataFolder() / "homography/oxford_graf"; }

Eigen::Matrix3d ReadHomography(const std::filesystem::path& file) {
  std::ifstream stream(file);
  Eigen::Matrix3d h;
  for (int i = 0; i < 9; ++i) stream >> h(i / 3, i % 3);
  return h;
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0;
  for (size_t i = 0; i < a.size(); ++i) ma += a[i], mb += b[i];
  ma /= static_cast<double>(a.size());
  mb /= static_cast<double>(a.size());
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST(Homography, OneViewOfAWallBecomesTheOther) {
  const auto folder = GraffitiFolder();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real data here";
  const LinearPhoto first(ReadPhoto(folder / "img1.ppm"), Encoding::kGamma22);
  SamplePlane plane;
  plane.width = first.width();
  plane.height = first.height();
  plane.width_mm = plane.width;  // one "millimetre" a pixel
  plane.height_mm = plane.height;
  // Pixel indices of the first view (centre of the top-left pixel at 0) from plane coordinates.
  Eigen::Matrix3d index_from_plane, half;
  index_from_plane << 1, 0, plane.width / 2.0 - 0.5, 0, -1, plane.height / 2.0 - 0.5, 0, 0, 1;
  half << 1, 0, 0.5, 0, 1, 0.5, 0, 0, 1;
  const ResampledView wanted =
      ResampleToPlane(first, HomographyProjection(half * index_from_plane), plane, {});
  for (const char* name : {"2", "3"}) {
    const LinearPhoto other(ReadPhoto(folder / ("img" + std::string(name) + ".ppm")),
                            Encoding::kGamma22);
    const Eigen::Matrix3d h = ReadHomography(folder / ("H1to" + std::string(name) + "p"));
    const ResampledView view =
        ResampleToPlane(other, HomographyProjection(half * h * index_from_plane), plane, {});
    std::vector<double> a, b;
    for (size_t i = 0; i < view.status.size(); ++i) {
      if (view.status[i] != TexelStatus::kUsable || wanted.status[i] != TexelStatus::kUsable)
        continue;
      a.push_back(std::log(0.02 + view.rgb[i]));
      b.push_back(std::log(0.02 + wanted.rgb[i]));
    }
    EXPECT_GT(a.size(), view.status.size() / 3);
    EXPECT_GT(Correlation(a, b), 0.85) << "view " << name;
  }
}

}  // namespace
}  // namespace glint
