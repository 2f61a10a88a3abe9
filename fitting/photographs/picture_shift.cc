#include "fitting/photographs/picture_shift.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glint {
namespace {

// Weights of Catmull and Rom's cubic for the samples at −1, 0, 1, 2, and their derivatives by t.
void CubicWeights(double t, double weights[4], double slopes[4]) {
  weights[0] = 0.5 * t * (-1 + t * (2 - t));
  weights[1] = 0.5 * (2 + t * t * (-5 + 3 * t));
  weights[2] = 0.5 * t * (1 + t * (4 - 3 * t));
  weights[3] = 0.5 * t * t * (t - 1);
  slopes[0] = 0.5 * (-1 + t * (4 - 3 * t));
  slopes[1] = 0.5 * t * (-10 + 9 * t);
  slopes[2] = 0.5 * (1 + t * (8 - 9 * t));
  slopes[3] = 0.5 * t * (3 * t - 2);
}

}  // namespace

void CornerWeights(double u, double v, double weights[4]) {
  weights[0] = (1 - v) * (1 - u);
  weights[1] = (1 - v) * u;
  weights[2] = v * (1 - u);
  weights[3] = v * u;
}

CornerShifts::Shift CornerShifts::At(int at_column, int at_row, int width, int height) const {
  double weights[4];
  CornerWeights((at_column + 0.5) / width, (at_row + 0.5) / height, weights);
  Shift shift{0, 0};
  for (int i = 0; i < 4; ++i) {
    shift.column += weights[i] * column[i];
    shift.row += weights[i] * row[i];
  }
  return shift;
}

double CornerShifts::rms() const {
  double squares = 0;
  for (int k = 0; k < 4; ++k) squares += column[k] * column[k] + row[k] * row[k];
  return std::sqrt(squares / 4);
}

bool CornerShifts::any() const {
  const auto moved = [](double shift) { return shift != 0; };
  return std::any_of(column, column + 4, moved) || std::any_of(row, row + 4, moved);
}

PictureLookUp::PictureLookUp(int width, int height, double column, double row,
                             const PictureRows& rows) {
  const double c0 = std::floor(column), r0 = std::floor(row);
  CubicWeights(column - c0, across_, across_slopes_);
  CubicWeights(row - r0, down_, down_slopes_);
  for (int i = 0; i < 4; ++i) {
    const int r = std::clamp(static_cast<int>(r0) + i - 1 - rows.first, 0, height - 1);
    first_of_row_[i] = static_cast<std::ptrdiff_t>(r) * width;
    columns_[i] = std::clamp(static_cast<int>(c0) + i - 1, 0, width - 1);
  }
}

LookedUp PictureLookUp::In(const float* plane) const {
  LookedUp sum{0, 0, 0};
  for (int j = 0; j < 4; ++j) {
    double line = 0, line_slope = 0;
    for (int i = 0; i < 4; ++i) {
      const double value = plane[first_of_row_[j] + columns_[i]];
      line += across_[i] * value;
      line_slope += across_slopes_[i] * value;
    }
    sum.value += down_[j] * line;
    sum.by_column += down_[j] * line_slope;
    sum.by_row += down_slopes_[j] * line;
  }
  return sum;
}

LookedUp LookUp(const float* plane, int width, int height, double column, double row,
                const PictureRows& rows) {
  return PictureLookUp(width, height, column, row, rows).In(plane);
}

double NoiseLeft(const CornerShifts& shifts) {
  constexpr int kPlaces = 5;  // along a side
  const auto left = [](double at) {
    double weights[4], slopes[4], squares = 0;
    CubicWeights(at - std::floor(at), weights, slopes);
    for (const double weight : weights) squares += weight * weight;
    return squares;
  };
  double sum = 0;
  for (int y = 0; y < kPlaces; ++y) {
    for (int x = 0; x < kPlaces; ++x) {
      const CornerShifts::Shift shift = shifts.At(x, y, kPlaces, kPlaces);
      sum += left(shift.column) * left(shift.row);
    }
  }
  return sum / (kPlaces * kPlaces);
}

void ShiftPicture(const CornerShifts& shifts, int width, int height, std::vector<float>* rgb_planar,
                  const PictureRows& rows) {
  const std::vector<float> source = *rgb_planar;
  const size_t texels = static_cast<size_t>(width) * height;
  const int whole_height = rows.of > 0 ? rows.of : height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const CornerShifts::Shift shift = shifts.At(x, rows.first + y, width, whole_height);
      for (size_t c = 0; c < 3; ++c) {
        const double value = LookUp(source.data() + c * texels, width, height, x + shift.column,
                                    rows.first + y + shift.row, rows)
                                 .value;
        (*rgb_planar)[c * texels + static_cast<size_t>(y) * width + x] =
            static_cast<float>(std::max(value, 0.0));
      }
    }
  }
}

void ShiftMask(const CornerShifts& shifts, int width, int height, std::vector<float>* mask,
               const PictureRows& rows) {
  const std::vector<float> source = *mask;
  const int whole_height = rows.of > 0 ? rows.of : height;
  const auto usable = [&](int c, int r) {
    r -= rows.first;
    return c >= 0 && c < width && r >= 0 && r < height &&
           source[static_cast<size_t>(r) * width + c] >= 0.5f;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const CornerShifts::Shift shift = shifts.At(x, rows.first + y, width, whole_height);
      // A hundredth of a texel outside still counts as the texel.
      const double column = x + shift.column, row = rows.first + y + shift.row;
      const int left = static_cast<int>(std::floor(column + 0.01));
      const int right = static_cast<int>(std::ceil(column - 0.01));
      const int top = static_cast<int>(std::floor(row + 0.01));
      const int bottom = static_cast<int>(std::ceil(row - 0.01));
      if (!usable(left, top) || !usable(right, top) || !usable(left, bottom) ||
          !usable(right, bottom)) {
        (*mask)[static_cast<size_t>(y) * width + x] = 0.0f;
      }
    }
  }
}

int RowsReached(const CornerShifts& shifts) {
  if (!shifts.any()) return 0;
  double most = 0;
  for (const double row : shifts.row) most = std::max(most, std::abs(row));
  return static_cast<int>(std::ceil(most)) + 2;  // of the cubic's four taps
}

}  // namespace glint
