#include "fitting/relief/ambient_occlusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel/parallel.h"

namespace glint {
namespace {

struct Step {
  double column = 0, row = 0, distance_mm = 0;
};

// Along one azimuth, from the nearest.
std::vector<Step> StepsAlong(double azimuth, const HeightField& field, double reach_mm,
                             double growth) {
  const double x = std::cos(azimuth), y = std::sin(azimuth);
  const double texel_mm = std::min(field.texel_x_mm, field.texel_y_mm);
  std::vector<Step> steps;
  double step_mm = texel_mm;
  for (double distance = texel_mm; distance <= reach_mm; distance += step_mm) {
    steps.push_back({x * distance / field.texel_x_mm, -y * distance / field.texel_y_mm, distance});
    step_mm *= growth;
  }
  return steps;
}

}  // namespace

std::vector<float> AmbientOcclusion(const HeightField& field, const OcclusionOptions& options,
                                    int threads) {
  const double shorter_mm =
      std::min(field.width * field.texel_x_mm, field.height * field.texel_y_mm);
  const double reach_mm = options.reach_mm > 0 ? options.reach_mm : shorter_mm / 8;
  std::vector<std::vector<Step>> azimuths;
  for (int i = 0; i < options.directions; ++i) {
    const double azimuth = 2 * std::numbers::pi * (i + 0.5) / options.directions;
    azimuths.push_back(StepsAlong(azimuth, field, reach_mm, options.step_growth));
  }
  std::vector<float> open(static_cast<size_t>(field.width) * static_cast<size_t>(field.height));
  ForEachPieceByWorker(field.height, threads, [&](int row, int) {
    for (int column = 0; column < field.width; ++column) {
      const double here = field.at(row, column);
      double sum = 0;
      for (const auto& steps : azimuths) {
        double steepest = 0;  // tangent of the horizon's elevation
        for (const Step& step : steps) {
          const double rise = field.Lookup(row + step.row, column + step.column) - here;
          steepest = std::max(steepest, rise / step.distance_mm);
        }
        sum += 1 / (1 + steepest * steepest);
      }
      open[static_cast<size_t>(row) * static_cast<size_t>(field.width) +
           static_cast<size_t>(column)] = static_cast<float>(sum / options.directions);
    }
  });
  return open;
}

}  // namespace glint
