#include "datasets/evaluation/tiling_error.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/evaluation/map_error.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

constexpr double kFarAway = 1e5;  // times a novel view's distance: directions agree to 1e-5
// Of 8 bits: what differs by less is not seen, however dark or even the picture is.
constexpr double kStep = 1.0 / 255;

struct Statistics {
  std::array<double, 3> mean{}, spread{};
};

Statistics StatisticsOf(const SvbrdfMaps& maps, const View& view, int threads) {
  const ReflectanceConvention convention = ReflectanceConvention::Dir2019();
  const SamplePlane plane{maps.width, maps.height, 2, 2.0 * maps.height / maps.width,
                          convention.sampling};
  std::vector<float> rgb(3 * maps.texels());
  RenderView(maps, plane, view, convention, rgb.data(), threads);
  Statistics statistics;
  const auto count = static_cast<double>(maps.texels());
  for (size_t c = 0; c < 3; ++c) {
    float* channel = rgb.data() + c * maps.texels();
    double sum = 0, squares = 0;
    for (size_t i = 0; i < maps.texels(); ++i) {
      channel[i] = std::clamp(channel[i], 0.0f, 1.0f);
      sum += channel[i];
    }
    const double mean = sum / count;
    for (size_t i = 0; i < maps.texels(); ++i) squares += std::pow(channel[i] - mean, 2);
    statistics.mean[c] = mean;
    statistics.spread[c] = std::sqrt(squares / count);
  }
  return statistics;
}

double LargestDifference(const std::array<double, 3>& tile, const std::array<double, 3>& sample) {
  double largest = 0;
  for (size_t c = 0; c < 3; ++c) {
    largest = std::max(largest, std::abs(tile[c] - sample[c]) / std::max(sample[c], kStep));
  }
  return largest;
}

void MoveAway(Vec3d* position) {
  for (double& x : *position) x *= kFarAway;
}

}  // namespace

TilingErrors CompareTile(const SvbrdfMaps& tile, const SvbrdfMaps& sample, int threads) {
  TilingErrors errors;
  for (View view : NovelViews(kNovelViews, kNovelSeed)) {
    MoveAway(&view.camera_in_sample_mm);
    MoveAway(&view.light_in_sample_mm);
    const Statistics of_tile = StatisticsOf(tile, view, threads);
    const Statistics of_sample = StatisticsOf(sample, view, threads);
    const double mean = LargestDifference(of_tile.mean, of_sample.mean);
    const double spread = LargestDifference(of_tile.spread, of_sample.spread);
    errors.mean += mean / kNovelViews;
    errors.spread += spread / kNovelViews;
    errors.largest_mean = std::max(errors.largest_mean, mean);
    errors.largest_spread = std::max(errors.largest_spread, spread);
  }
  return errors;
}

}  // namespace glint
