// Renderings of a known material by the authors of DIR 2019 pin the reflectance convention.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "fitting/render/renderer.h"
#include "tests/support/data_folder.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

fs::path GoldenFolder() { return test::DataFolder() / "golden/dir2019/example_data"; }

// The maps strip: normal | diffuse (gamma 2.2) | roughness | specular, 8 bit.
SvbrdfMaps ReadStrip(const fs::path& path) {
  const cv::Mat strip = cv::imread(path.string(), cv::IMREAD_COLOR);
  const int n = strip.rows;
  SvbrdfMaps maps(n, n);
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      const auto value = [&](int tile, int channel) {  // OpenCV's order is B, G, R
        return strip.at<cv::Vec3b>(row, tile * n + column)[2 - channel] / 255.0;
      };
      double normal[3], length = 0;
      for (int c = 0; c < 3; ++c) {
        normal[c] = 2 * value(0, c) - 1;
        length += normal[c] * normal[c];
      }
      for (int c = 0; c < 3; ++c) {
        maps.at(kNormalX + c, row, column) = static_cast<float>(normal[c] / std::sqrt(length));
        maps.at(kDiffuseR + c, row, column) = static_cast<float>(std::pow(value(1, c), 2.2));
        maps.at(kSpecularR + c, row, column) = static_cast<float>(value(3, c));
      }
      maps.at(kRoughness, row, column) = static_cast<float>(value(2, 0));
    }
  }
  return maps;
}

// "lx,ly,lz<TAB>vx,vy,vz" after a line of heading; light and camera are at the same place.
std::vector<View> ReadViews(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<View> views;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double x = 0, y = 0;
    if (numbers >> x >> y) views.push_back(DirView(x, y));
  }
  return views;
}

TEST(GoldenTest, RenderingsOfDir2019AreReproducedAtEveryPixel) {
  const fs::path folder = GoldenFolder();
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is absent";
  const std::string name = "0000066;leather_tilesXPolishedMarbleFloor_01;defaultX4";
  const SvbrdfMaps maps = ReadStrip(folder / "example_svbrdf" / (name + ".png"));
  const std::vector<View> views = ReadViews(folder / "example_wlv" / (name + ".txt"));
  ASSERT_EQ(views.size(), 20u);
  const ReflectanceConvention convention = ReflectanceConvention::Dir2019();
  const SamplePlane plane{maps.width, maps.height, 2.0, 2.0, convention.sampling};

  std::array<int, 6> histogram{};  // of |difference| in steps of 0.2/255
  double worst = 0;
  for (size_t v = 0; v < views.size(); ++v) {
    const cv::Mat image =
        cv::imread((folder / "example_images" / (name + "_" + std::to_string(v) + ".png")).string(),
                   cv::IMREAD_COLOR);
    ASSERT_EQ(image.size(), cv::Size(maps.width, maps.height));
    std::vector<float> rendered(3 * maps.texels());
    RenderView(maps, plane, views[v], convention, rendered.data());
    for (int row = 0; row < image.rows; ++row) {
      for (int column = 0; column < image.cols; ++column) {
        for (int c = 0; c < 3; ++c) {
          const float radiance = rendered[(c * image.rows + row) * image.cols + column];
          const double shown = 255.0 * std::pow(std::clamp(radiance, 0.0f, 1.0f), 1 / 2.2);
          const double difference = std::abs(shown - image.at<cv::Vec3b>(row, column)[2 - c]);
          worst = std::max(worst, difference);
          ++histogram[std::min(5, static_cast<int>(difference / 0.2))];
        }
      }
    }
  }
  std::printf("worst %.4f/255; values within 0.2, 0.4, 0.6, 0.8, 1.0, more: %d %d %d %d %d %d\n",
              worst, histogram[0], histogram[1], histogram[2], histogram[3], histogram[4],
              histogram[5]);
  EXPECT_LE(worst, 0.6);
}

}  // namespace
}  // namespace glint
