// What the estimator is shown of a capture must not depend on the size at which its photographs
// were rectified: larger ones are averaged, and the average of a clipped highlight is a clipped
// highlight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/import/import_set.h"
#include "fitting/estimator/estimator.h"
#include "fitting/rectified_photographs/rectified_photographs.h"
#include "fitting/weights/find_model.h"
#include "pipeline/files/json.h"
#include "pipeline/images/image.h"
#include "tests/support/data_folder.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kShownSide = 128;  // texels of what is compared

// The first `count` photographs of a set imported at `size`, averaged to kShownSide².
PhotographSet ShownOf(const fs::path& source, int size, size_t count) {
  const test::TemporaryFolder folder;
  const ForeignSet foreign = ReadForeignSet(source);
  ImportOptions options;
  options.size = size;
  CommonOptions common;
  common.threads = 2;
  Stage stage(folder.path() / "glint" / "rectify", {"rectify", 1}, OptionSet(), common,
              ImportInputs(foreign), true);
  const RectifiedSet set = ImportSet(foreign, options, common, &stage).set;
  std::vector<RectifiedView> views = set.views;
  views.resize(std::min(count, views.size()));
  return RectifiedPhotographs(set, views).Downsampled(kShownSide, kShownSide, 2);
}

// How much may differ: rectification's filter is sharper than an average, and reaches further,
// which shows at printed edges and about highlights.
struct Tolerances {
  double limits = 0.03;          // share of texels that are at the limit in one set alone
  double log_difference = 0.03;  // of radiance, in the mean
  double maps = 0.02;            // in the mean
};

void ExpectAlike(const PhotographSet& a, const PhotographSet& b, const Tolerances& most,
                 const std::string& what) {
  ASSERT_EQ(a.photographs.size(), b.photographs.size()) << what;
  for (size_t v = 0; v < a.photographs.size(); ++v) {
    const Photograph &p = a.photographs[v], &q = b.photographs[v];
    const size_t texels = p.mask.size();
    size_t limits = 0, compared = 0;
    double difference = 0;
    for (size_t i = 0; i < texels; ++i) {
      limits += ReachesLimit(p, i) != ReachesLimit(q, i);
      if (p.mask[i] < 0.5f || q.mask[i] < 0.5f) continue;
      difference +=
          std::abs(std::log(p.rgb[texels + i] + 0.01) - std::log(q.rgb[texels + i] + 0.01));
      ++compared;
    }
    EXPECT_LT(static_cast<double>(limits), most.limits * static_cast<double>(texels))
        << what << ", " << v;
    EXPECT_LT(difference, most.log_difference * static_cast<double>(compared))
        << what << ", photograph " << v;
  }
}

void ExpectMapsAlike(const PhotographSet& a, const PhotographSet& b, const Tolerances& most,
                     const std::string& what) {
  const Estimator estimator = Estimator::Load(FindModel(kEstimatorModel));
  const SvbrdfMaps p = estimator.Estimate(a, {true, false}, 2).maps;
  const SvbrdfMaps q = estimator.Estimate(b, {true, false}, 2).maps;
  for (const int plane : {kDiffuseG, kSpecularG, kRoughness, kNormalX}) {
    double difference = 0;
    for (size_t i = 0; i < p.texels(); ++i) {
      difference += std::abs(p.plane(plane)[i] - q.plane(plane)[i]);
    }
    EXPECT_LT(difference / static_cast<double>(p.texels()), most.maps)
        << what << ", plane " << plane;
  }
}

// A matte chequered sheet under a flash that clips a third of the picture.
void WriteClippedSet(const fs::path& folder, int side) {
  fs::create_directories(folder);
  Image image(side, side, {"R", "G", "B"});
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double x = (column + 0.5) / side - 0.5, y = (row + 0.5) / side - 0.5;
      const bool light = ((8 * row / side) + (8 * column / side)) % 2 == 0;
      const double radiance = (light ? 0.4 : 0.2) + 1.5 * std::exp(-(x * x + y * y) / 0.05);
      for (int c = 0; c < 3; ++c) {
        image.channel(
            c)[static_cast<size_t>(row) * static_cast<size_t>(side) + static_cast<size_t>(column)] =
            static_cast<float>(std::pow(std::min(radiance, 1.0), 1 / 2.2));
      }
    }
  }
  WritePng(folder / "00.png", image, 8);
  const Json json = {
      {"glint_views", 1},
      {"size_mm", {100.0, 100.0}},
      {"encoding", "gamma2.2"},
      {"convention", "photograph"},
      {"light_power", 5e4},
      {"views", {{{"image", "00.png"}, {"camera_in_sample_mm", {0.0, 0.0, 200.0}}}}}};
  test::WriteAll(folder / "views.json", json.dump(1));
}

TEST(ImportSizes, AClippedHighlightIsOneAtEverySize) {
  const test::TemporaryFolder folder;
  WriteClippedSet(folder.path() / "set", 8 * kShownSide);
  const PhotographSet imported = ShownOf(folder.path() / "set", kShownSide, 1);
  size_t limits = 0;
  for (size_t i = 0; i < imported.photographs[0].mask.size(); ++i) {
    limits += ReachesLimit(imported.photographs[0], i);
  }
  EXPECT_GT(limits, imported.photographs[0].mask.size() / 20);
  for (const int size : {2 * kShownSide, 4 * kShownSide, 8 * kShownSide}) {
    const PhotographSet averaged = ShownOf(folder.path() / "set", size, 1);
    ExpectAlike(imported, averaged, {}, std::to_string(size));
    ExpectMapsAlike(imported, averaged, {}, std::to_string(size));
  }
}

TEST(ImportSizes, RealSetsShowTheSameAtEverySize) {
  const fs::path captures = test::DataFolder() / "captures";
  if (!fs::exists(captures)) GTEST_SKIP() << "no real data here";
  for (const fs::path& set :
       {captures / "cards-blue", captures / "nine_photographs_512" / "book1"}) {
    for (const size_t count : {1u, 7u}) {
      const PhotographSet imported = ShownOf(set, kShownSide, count);
      for (const int size : {2 * kShownSide, 4 * kShownSide}) {
        const std::string what = set.filename().string() + " at " + std::to_string(size);
        const PhotographSet averaged = ShownOf(set, size, count);
        ExpectAlike(imported, averaged, {0.08, 0.08, 0.06}, what);
        ExpectMapsAlike(imported, averaged, {0.08, 0.08, 0.06}, what);
      }
    }
  }
}

}  // namespace
}  // namespace glint
