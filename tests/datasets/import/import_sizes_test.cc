// What the estimator is shown of a capture must not depend on the size at which its photographs
// were rectified: larger ones are averaged, and the average of a clipped highlight is a clipped
// highlight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/images/image.h"
#include "datasets/import/import_set.h"
#include "fitting/estimator/estimator.h"
#include "fitting/rectified_photographs/rectified_photographs.h"
#include "fitting/weights/find_model.h"
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

// Means of kBlock × kBlock texels, NaN where none counts: rectification's filter is sharper than an
// average, which shows at printed edges and not in means.
constexpr int kBlock = 8, kBlocks = kShownSide / kBlock;

template <class Counts>
std::vector<double> BlockMeans(std::span<const float> plane, const Counts& counts) {
  std::vector<double> sums(kBlocks * kBlocks, 0.0), numbers(kBlocks * kBlocks, 0.0);
  for (size_t i = 0; i < plane.size(); ++i) {
    if (!counts(i)) continue;
    const size_t block = i / kShownSide / kBlock * kBlocks + i % kShownSide / kBlock;
    sums[block] += plane[i];
    numbers[block] += 1;
  }
  for (size_t k = 0; k < sums.size(); ++k) sums[k] /= numbers[k];
  return sums;
}

template <class Difference>
double MeanOverBlocks(const std::vector<double>& a, const std::vector<double>& b,
                      const Difference& difference) {
  double sum = 0, number = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    if (!std::isfinite(a[k]) || !std::isfinite(b[k])) continue;
    sum += std::abs(difference(a[k]) - difference(b[k]));
    number += 1;
  }
  return sum / number;
}

// Share of the texels at the limit in `photograph` that have none in `other` within `reach` texels.
double AloneAtLimit(const Photograph& photograph, const Photograph& other, int reach) {
  const auto near = [&](int row, int column) {
    for (int r = std::max(0, row - reach); r <= std::min(kShownSide - 1, row + reach); ++r) {
      for (int c = std::max(0, column - reach); c <= std::min(kShownSide - 1, column + reach);
           ++c) {
        if (ReachesLimit(other, static_cast<size_t>(r * kShownSide + c))) return true;
      }
    }
    return false;
  };
  double all = 0, alone = 0;
  for (int i = 0; i < kShownSide * kShownSide; ++i) {
    if (!ReachesLimit(photograph, static_cast<size_t>(i))) continue;
    all += 1;
    alone += !near(i / kShownSide, i % kShownSide);
  }
  return all > 0 ? alone / all : 0;
}

// A pixel that clips masks every texel whose filter reaches it: three texels in rectification, one
// in an average.
constexpr int kFilterReach = 3;
constexpr double kMostAlone = 0.01, kMostDifference = 0.02;

void ExpectAlike(const PhotographSet& imported, const PhotographSet& averaged,
                 const std::string& what) {
  ASSERT_EQ(imported.photographs.size(), averaged.photographs.size()) << what;
  for (size_t v = 0; v < imported.photographs.size(); ++v) {
    const Photograph &p = imported.photographs[v], &q = averaged.photographs[v];
    EXPECT_LE(AloneAtLimit(p, q, kFilterReach), kMostAlone) << what << ", photograph " << v;
    EXPECT_LE(AloneAtLimit(q, p, kFilterReach), kMostAlone) << what << ", photograph " << v;
    const auto usable = [&](size_t i) { return p.mask[i] >= 0.5f && q.mask[i] >= 0.5f; };
    const auto green = [](const Photograph& photo) {
      return std::span(photo.rgb).subspan(photo.mask.size(), photo.mask.size());
    };
    EXPECT_LT(MeanOverBlocks(BlockMeans(green(p), usable), BlockMeans(green(q), usable),
                             [](double radiance) { return std::log(radiance + 0.01); }),
              kMostDifference)
        << what << ", photograph " << v;
  }
}

// Maps differ by less than the estimator states that it does not know of them.
void ExpectMapsAlike(const PhotographSet& a, const PhotographSet& b, const std::string& what) {
  const Estimator estimator = Estimator::Load(FindModel(kEstimatorModel));
  const SvbrdfEstimate p = estimator.Estimate(a, {true, false}, 2);
  const SvbrdfEstimate q = estimator.Estimate(b, {true, false}, 2);
  for (const auto& [plane, deviation] : {std::pair{kDiffuseG, kSigmaDiffuseG},
                                         {kSpecularG, kSigmaSpecularG},
                                         {kRoughness, kSigmaRoughness},
                                         {kNormalX, kSigmaNormalX}}) {
    double sum = 0;
    for (size_t i = 0; i < p.maps.texels(); ++i) {
      sum += std::abs(p.maps.plane(plane)[i] - q.maps.plane(plane)[i]) /
             p.deviations.plane(deviation)[i];
    }
    EXPECT_LT(sum / static_cast<double>(p.maps.texels()), 1) << what << ", plane " << plane;
  }
}

// A matte chequered sheet under a flash that clips a third of the picture, with grain as fine as
// pixels: a texel of the highlight has clipped pixels and others.
void WriteClippedSet(const fs::path& folder, int side) {
  fs::create_directories(folder);
  Image image(side, side, {"R", "G", "B"});
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double x = (column + 0.5) / side - 0.5, y = (row + 0.5) / side - 0.5;
      const bool light = ((8 * row / side) + (8 * column / side)) % 2 == 0;
      const double grain = (row + column) % 2 == 0 ? 1.4 : 0.6;
      const double radiance =
          grain * ((light ? 0.4 : 0.2) + 0.9 * std::exp(-(x * x + y * y) / 0.05));
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
    ExpectAlike(imported, averaged, std::to_string(size));
    ExpectMapsAlike(imported, averaged, std::to_string(size));
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
        ExpectAlike(imported, averaged, what);
        ExpectMapsAlike(imported, averaged, what);
      }
    }
  }
}

}  // namespace
}  // namespace glint
