#include "fitting/relief/ambient_occlusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/cpu/vector_clones.h"
#include "base/parallel/parallel.h"

namespace glint {
namespace {

// One step along an azimuth. It is the same for every texel, so that a row's texels are looked up
// together: each between the same two rows and as far from their columns.
struct Step {
  int rows = 0, columns = 0;   // whole ones, rounded down …
  float down = 0, across = 0;  // … and what is left of one, 0 to 1
  float per_mm = 0;            // 1/distance
};

Step StepTo(double x_mm, double y_mm, const HeightField& field) {
  const double column = x_mm / field.texel_x_mm, row = -y_mm / field.texel_y_mm;
  return {static_cast<int>(std::floor(row)), static_cast<int>(std::floor(column)),
          static_cast<float>(row - std::floor(row)),
          static_cast<float>(column - std::floor(column)),
          static_cast<float>(1 / std::hypot(x_mm, y_mm))};
}

// Along one azimuth, from the nearest.
std::vector<Step> StepsAlong(double azimuth, const HeightField& field, double reach_mm,
                             double growth) {
  const double x = std::cos(azimuth), y = std::sin(azimuth);
  const double texel_mm = std::min(field.texel_x_mm, field.texel_y_mm);
  std::vector<Step> steps;
  if (!(texel_mm > 0)) return steps;  // one texel has no neighbours
  double step_mm = texel_mm, distance_mm = texel_mm;
  while (distance_mm <= reach_mm) {
    steps.push_back(StepTo(x * distance_mm, y * distance_mm, field));
    step_mm *= growth;
    distance_mm += step_mm;
  }
  return steps;
}

// Rows of a height field that go on beyond its borders.
class EndlessRows {
 public:
  // `beyond`: columns on either side.
  EndlessRows(const HeightField& field, int beyond)
      : field_(field),
        beyond_(beyond),
        stride_(static_cast<size_t>(field.width) + 2 * static_cast<size_t>(beyond)),
        heights_(stride_ * static_cast<size_t>(field.height)) {
    for (int row = 0; row < field.height; ++row) {
      float* to = heights_.data() + static_cast<size_t>(row) * stride_;
      for (int column = -beyond; column < field.width + beyond; ++column) {
        *to++ = field.at(row, Inside(column, field.width));
      }
    }
  }
  // From column 0 of any row.
  const float* Row(int row) const {
    return heights_.data() + static_cast<size_t>(Inside(row, field_.height)) * stride_ + beyond_;
  }

 private:
  int Inside(int i, int size) const {
    if (!field_.repeats) return std::clamp(i, 0, size - 1);
    return (i % size + size) % size;
  }
  const HeightField& field_;
  int beyond_;
  size_t stride_;
  std::vector<float> heights_;
};

// Raises each column's steepest slope to that of the step's end. `upper`, `lower`: the rows between
// which that end is, from the column left of column 0's.
GLINT_VECTOR_CLONES
void Raise(const float* upper, const float* lower, const Step& step, const float* here, int width,
           float* steepest) {
  const float across = step.across, down = step.down, per_mm = step.per_mm;
  for (int c = 0; c < width; ++c) {
    const float above = upper[c] + across * (upper[c + 1] - upper[c]);
    const float below = lower[c] + across * (lower[c + 1] - lower[c]);
    const float slope = (above + down * (below - above) - here[c]) * per_mm;
    steepest[c] = slope > steepest[c] ? slope : steepest[c];
  }
}

// Adds the share of an azimuth's sky above a horizon of that slope.
GLINT_VECTOR_CLONES
void AddOpenShare(const float* steepest, int width, float* open) {
  for (int c = 0; c < width; ++c) open[c] += 1 / (1 + steepest[c] * steepest[c]);
}

int FarthestColumn(const std::vector<std::vector<Step>>& azimuths) {
  int farthest = 0;
  for (const auto& steps : azimuths) {
    for (const Step& step : steps) farthest = std::max(farthest, std::abs(step.columns));
  }
  return farthest;
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
  const EndlessRows rows(field, FarthestColumn(azimuths) + 1);
  const auto width = static_cast<size_t>(field.width);
  std::vector<float> open(width * static_cast<size_t>(field.height));
  ForEachPiece(field.height, threads, [&](int row) {
    const float* here = rows.Row(row);
    std::vector<float> steepest(width);
    for (const auto& steps : azimuths) {
      std::fill(steepest.begin(), steepest.end(), 0.0f);
      for (const Step& step : steps) {
        Raise(rows.Row(row + step.rows) + step.columns,
              rows.Row(row + step.rows + 1) + step.columns, step, here, field.width,
              steepest.data());
      }
      AddOpenShare(steepest.data(), field.width, open.data() + static_cast<size_t>(row) * width);
    }
  });
  for (float& share : open) share /= static_cast<float>(options.directions);
  return open;
}

}  // namespace glint
