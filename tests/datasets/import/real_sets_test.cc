// Published sets: what their numbers mean must agree with what their pictures show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/images/image.h"
#include "base/reflectance/texel_at.h"
#include "datasets/import/import_set.h"
#include "datasets/map_formats/read_maps.h"
#include "tests/support/data_folder.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

RectifiedSet Import(const fs::path& source, const fs::path& capture, const ImportOptions& options) {
  const ForeignSet foreign = ReadForeignSet(source);
  CommonOptions common;
  common.threads = 2;
  Stage stage(capture / "glint" / "rectify", {"rectify", 1}, OptionSet(), common,
              ImportInputs(foreign), true);
  return ImportSet(foreign, options, common, &stage).set;
}

// Centre of mass of the brightest twentieth of a view, millimetres.
std::pair<double, double> Highlight(const RectifiedImage& image, const SamplePlane& plane) {
  const size_t texels = image.mask.size();
  std::vector<float> sum(texels);
  for (size_t i = 0; i < texels; ++i) {
    sum[i] = image.rgb[i] + image.rgb[texels + i] + image.rgb[2 * texels + i];
  }
  std::vector<float> sorted = sum;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(texels * 19 / 20),
                   sorted.end());
  const float threshold = sorted[texels * 19 / 20];
  double x = 0, y = 0, count = 0;
  for (size_t i = 0; i < texels; ++i) {
    if (sum[i] < threshold) continue;
    x += plane.x_mm(static_cast<int>(i) % plane.width);
    y += plane.y_mm(static_cast<int>(i) / plane.width);
    ++count;
  }
  return {x / count, y / count};
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.size(); ++i) ma += a[i] / n, mb += b[i] / n;
  for (size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

// With the flash at the lens, a flat sample mirrors the light where it is seen straight on: the
// highlight lies below the camera. So the images' x grows to the right and y upward, and views and
// positions are paired rightly.
TEST(RealSets, CardsShowTheirHighlightBelowTheCamera) {
  const fs::path source = test::DataFolder() / "captures" / "cards-blue";
  if (!fs::exists(source)) GTEST_SKIP() << "no real data here";
  const test::TemporaryFolder folder;
  ImportOptions options;
  options.size = 128;
  const RectifiedSet set = Import(source, folder.path(), options);
  ASSERT_EQ(set.views.size(), 9u);
  EXPECT_NEAR(set.plane.width_mm, 68.48, 1e-9);
  std::vector<double> x, y, camera_x, camera_y;
  for (const RectifiedView& view : set.views) {
    const auto [hx, hy] = Highlight(ReadRectifiedImage(set, view), set.plane);
    x.push_back(hx);
    y.push_back(hy);
    camera_x.push_back(view.view.camera_in_sample_mm[0]);
    camera_y.push_back(view.view.camera_in_sample_mm[1]);
    EXPECT_LT(std::hypot(hx - camera_x.back(), hy - camera_y.back()), 16) << view.photo;
  }
  EXPECT_GT(Correlation(x, camera_x), 0.9);
  EXPECT_GT(Correlation(y, camera_y), 0.9);
}

TEST(RealSets, BathTileFramesAreCroppedToTheSample) {
  const fs::path source = test::DataFolder() / "captures" / "bath-tile";
  if (!fs::exists(source)) GTEST_SKIP() << "no real data here";
  const ForeignSet foreign = ReadForeignSet(source);
  EXPECT_EQ(foreign.views.size(), 9u);  // as in parameters.json
  EXPECT_EQ(foreign.crop_px, 1024);
  const SamplePlane plane = ImportedPlane(foreign, {});
  EXPECT_EQ(plane.width, 1024);
  EXPECT_NEAR(plane.width_mm, 97.28, 1e-9);
  EXPECT_NEAR(foreign.views[1].view.camera_in_sample_mm[0], 38.826, 1e-3);
}

// DIR's own renderings from DIR's own maps: the strip's layout and encodings, the positions, the
// plane's orientation and the images' encoding all have to be right at once.
TEST(RealSets, DirRenderingsFollowFromDirMaps) {
  const fs::path source = test::DataFolder() / "golden" / "dir2019" / "example_data";
  if (!fs::exists(source)) GTEST_SKIP() << "no real data here";
  const test::TemporaryFolder folder;
  const RectifiedSet set = Import(source, folder.path(), {});
  ASSERT_EQ(set.views.size(), 20u);
  const std::string strip = fs::path(set.views[0].photo).stem().string();
  const SvbrdfMaps maps =
      ReadMaps(source / "example_svbrdf" / (strip.substr(0, strip.rfind('_')) + ".png"));
  ASSERT_EQ(maps.width, set.plane.width);
  double worst = 0;
  for (const size_t v : {0, 1, 7, 19}) {
    const RectifiedImage image = ReadRectifiedImage(set, set.views[v]);
    for (size_t i = 0; i < maps.texels(); i += 7) {
      const int row = static_cast<int>(i) / maps.width, column = static_cast<int>(i) % maps.width;
      const auto geometry = TexelGeometryInView<double>(
          set.views[v].view, set.convention.falloff, set.plane.x_mm(column), set.plane.y_mm(row));
      double radiance[3];
      ShadeRadiance(TexelAt(maps, i), geometry, set.convention, radiance);
      for (size_t c = 0; c < 3; ++c) {
        const double stored = std::pow(image.rgb[c * maps.texels() + i], 1 / 2.2);
        const double rendered = std::pow(std::clamp(radiance[c], 0.0, 1.0), 1 / 2.2);
        worst = std::max(worst, std::abs(stored - rendered));
      }
    }
  }
  EXPECT_LT(worst * 255, 0.6);
}

}  // namespace
}  // namespace glint
