#include "fitting/relief/height_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <utility>

#include "base/parallel/parallel.h"
#include "fitting/relief/torus_poisson.h"

namespace glint {
namespace {

// ∂h/∂x and ∂h/∂y of a normal.
struct Slope {
  double x, y;
};

Slope SlopeOf(const SvbrdfMaps& maps, size_t texel) {
  const double z = std::max<double>(maps.plane(kNormalZ)[texel], 1e-3);
  const auto bounded = [](double slope) {
    return std::clamp(slope, -kMostReliefSlope, kMostReliefSlope);
  };
  return {bounded(-maps.plane(kNormalX)[texel] / z), bounded(-maps.plane(kNormalY)[texel] / z)};
}

// cv::dct takes even sizes alone; an odd one gets a border texel twice.
int Even(int n) { return n + n % 2; }

}  // namespace

double HeightField::Lookup(double row, double column) const {
  if (repeats) return LookupRepeating(row, column);
  const double r = std::clamp(row, 0.0, static_cast<double>(height - 1));
  const double c = std::clamp(column, 0.0, static_cast<double>(width - 1));
  const int r0 = std::min(static_cast<int>(r), std::max(height - 2, 0));
  const int c0 = std::min(static_cast<int>(c), std::max(width - 2, 0));
  const int r1 = std::min(r0 + 1, height - 1), c1 = std::min(c0 + 1, width - 1);
  const double u = c - c0, v = r - r0;
  return (1 - v) * ((1 - u) * at(r0, c0) + u * at(r0, c1)) +
         v * ((1 - u) * at(r1, c0) + u * at(r1, c1));
}

double HeightField::LookupRepeating(double row, double column) const {
  const double r = std::floor(row), c = std::floor(column);
  const double u = column - c, v = row - r;
  const auto wrapped = [](double i, int size) {
    const int k = static_cast<int>(std::fmod(i, size));
    return k < 0 ? k + size : k;
  };
  const int r0 = wrapped(r, height), r1 = wrapped(r + 1, height);
  const int c0 = wrapped(c, width), c1 = wrapped(c + 1, width);
  return (1 - v) * ((1 - u) * at(r0, c0) + u * at(r0, c1)) +
         v * ((1 - u) * at(r1, c0) + u * at(r1, c1));
}

namespace {

// Values on a grid of even size and weighted differences between its neighbours.
struct Grid {
  int width, height;
  std::vector<double> across, down;  // what differences to the right and downward ought to be …
  std::vector<double> across_trust, down_trust;  // … and their weights; 0 over the border
  double screening;                              // weight of a value's own square

  static constexpr int kRowsAtOnce = 32;
  size_t index(int row, int column) const { return static_cast<size_t>(row) * width + column; }
  size_t size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }

  // −div(w·∇u) + screening·u: half the gradient by u of Σ w·difference² + screening·u².
  std::vector<double> Applied(const std::vector<double>& u, int threads) const {
    return ByRow(threads, [&](int row, int column, size_t i) {
      double sum = screening * u[i];
      if (column > 0) sum += across_trust[i - 1] * (u[i] - u[i - 1]);
      if (column + 1 < width) sum -= across_trust[i] * (u[i + 1] - u[i]);
      if (row > 0) sum += down_trust[Above(i)] * (u[i] - u[Above(i)]);
      if (row + 1 < height) sum -= down_trust[i] * (u[Below(i)] - u[i]);
      return sum;
    });
  }

  // −div(w·target).
  std::vector<double> RightSide(int threads) const {
    return ByRow(threads, [&](int row, int column, size_t i) {
      double sum = 0;
      if (column > 0) sum += across_trust[i - 1] * across[i - 1];
      if (column + 1 < width) sum -= across_trust[i] * across[i];
      if (row > 0) sum += down_trust[Above(i)] * down[Above(i)];
      if (row + 1 < height) sum -= down_trust[i] * down[i];
      return sum;
    });
  }

  // Of all weights 1, exactly, mean 0: cosines are the equation's eigenvectors.
  std::vector<double> SolvedEvenly(std::vector<double> values, int threads) const {
    cv::Mat grid(height, width, CV_64F, values.data());
    cv::Mat spectrum = TransformedRows(TransformedRows(grid, 0, threads).t(), 0, threads);
    const std::vector<double> by_column = Eigenvalues(width), by_row = Eigenvalues(height);
    for (int column = 0; column < width; ++column) {
      for (int row = 0; row < height; ++row) {
        double& value = spectrum.at<double>(column, row);
        const double eigenvalue =
            by_column[static_cast<size_t>(column)] + by_row[static_cast<size_t>(row)];
        value = row + column > 0 ? value / (eigenvalue + screening) : 0.0;
      }
    }
    TransformedRows(TransformedRows(spectrum, cv::DCT_INVERSE, threads).t(), cv::DCT_INVERSE,
                    threads)
        .copyTo(grid);
    return values;
  }

 private:
  size_t Above(size_t i) const { return i - static_cast<size_t>(width); }
  size_t Below(size_t i) const { return i + static_cast<size_t>(width); }

  template <class Value>
  std::vector<double> ByRow(int threads, const Value& value) const {
    std::vector<double> values(size());
    ForEachBlock(height, kRowsAtOnce, threads, [&](int begin, int end) {
      for (int row = begin; row < end; ++row) {
        for (int column = 0; column < width; ++column) {
          values[index(row, column)] = value(row, column, index(row, column));
        }
      }
    });
    return values;
  }

  // Each row's cosine transform, or its inverse.
  static cv::Mat TransformedRows(const cv::Mat& grid, int direction, int threads) {
    cv::Mat transformed(grid.size(), grid.type());
    ForEachBlock(grid.rows, kRowsAtOnce, threads, [&](int begin, int end) {
      cv::Mat rows = transformed.rowRange(begin, end);
      cv::dct(grid.rowRange(begin, end), rows, direction | cv::DCT_ROWS);
    });
    return transformed;
  }

  // Of the second difference with free ends.
  static std::vector<double> Eigenvalues(int count) {
    std::vector<double> values(static_cast<size_t>(count));
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] = 2 - 2 * std::cos(std::numbers::pi * static_cast<double>(i) / count);
    }
    return values;
  }
};

double Dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Preconditioned conjugate gradients (Saad, "Iterative methods for sparse linear systems", 9.2).
std::vector<double> SolvedWithTrust(const Grid& grid, int threads) {
  constexpr int kMostSteps = 100;
  constexpr double kResidualLeft = 1e-3;
  std::vector<double> residual = grid.RightSide(threads);
  std::vector<double> heights(grid.size(), 0.0);
  std::vector<double> even = grid.SolvedEvenly(residual, threads), direction = even;
  double square = Dot(residual, even);
  const double enough = kResidualLeft * kResidualLeft * square;
  for (int step = 0; step < kMostSteps && square > enough; ++step) {
    const std::vector<double> applied = grid.Applied(direction, threads);
    const double length = square / Dot(direction, applied);
    for (size_t i = 0; i < heights.size(); ++i) {
      heights[i] += length * direction[i];
      residual[i] -= length * applied[i];
    }
    even = grid.SolvedEvenly(residual, threads);
    const double before = std::exchange(square, Dot(residual, even));
    for (size_t i = 0; i < heights.size(); ++i) {
      direction[i] = even[i] + square / before * direction[i];
    }
  }
  return heights;
}

}  // namespace

HeightField IntegrateNormals(const SvbrdfMaps& maps, const SamplePlane& plane, double longest_mm,
                             std::span<const float> trust, int threads) {
  if (!trust.empty() && trust.size() != maps.texels()) {
    throw std::invalid_argument("IntegrateNormals: not as many weights as texels");
  }
  HeightField field;
  field.width = maps.width;
  field.height = maps.height;
  const int gaps_x = std::max(1, maps.width - 1), gaps_y = std::max(1, maps.height - 1);
  field.texel_x_mm = (plane.x_mm(maps.width - 1) - plane.x_mm(0)) / gaps_x;
  field.texel_y_mm = (plane.y_mm(0) - plane.y_mm(maps.height - 1)) / gaps_y;
  // Texels are as good as square (glint-rectify, glint-import).
  const double texel_mm = std::sqrt(field.texel_x_mm * field.texel_y_mm);

  Grid grid{Even(maps.width), Even(maps.height), {}, {}, {}, {}, 0};
  if (longest_mm > 0) grid.screening = std::pow(2 * std::numbers::pi * texel_mm / longest_mm, 2);
  const auto texel = [&](int row, int column) {
    return static_cast<size_t>(std::min(row, maps.height - 1)) * maps.width +
           static_cast<size_t>(std::min(column, maps.width - 1));
  };
  // Between two texels: the mean of their slopes, and of their variances.
  const auto between = [&](size_t a, size_t b) {
    return trust.empty() ? 1.0 : 2 / (1.0 / trust[a] + 1.0 / trust[b]);
  };
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const size_t here = texel(row, column), right = texel(row, column + 1),
                   below = texel(row + 1, column);
      const Slope slope = SlopeOf(maps, here);
      grid.across.push_back(0.5 * (slope.x + SlopeOf(maps, right).x) * field.texel_x_mm);
      grid.down.push_back(-0.5 * (slope.y + SlopeOf(maps, below).y) * field.texel_y_mm);
      grid.across_trust.push_back(between(here, right));
      grid.down_trust.push_back(between(here, below));
    }
  }
  const std::vector<double> solved = trust.empty()
                                         ? grid.SolvedEvenly(grid.RightSide(threads), threads)
                                         : SolvedWithTrust(grid, threads);
  double mean = 0;
  for (int row = 0; row < maps.height; ++row) {
    for (int column = 0; column < maps.width; ++column) mean += solved[grid.index(row, column)];
  }
  mean /= static_cast<double>(maps.texels());
  field.height_mm.reserve(maps.texels());
  for (int row = 0; row < maps.height; ++row) {
    for (int column = 0; column < maps.width; ++column) {
      field.height_mm.push_back(static_cast<float>(solved[grid.index(row, column)] - mean));
    }
  }
  return field;
}

std::vector<float> TrustOfNormals(std::span<const float> sigma_x, std::span<const float> sigma_y) {
  std::vector<float> variances(sigma_x.size());
  for (size_t i = 0; i < variances.size(); ++i) {
    variances[i] = 0.5f * (sigma_x[i] * sigma_x[i] + sigma_y[i] * sigma_y[i]);
  }
  std::vector<float> trust = variances;
  const auto middle = trust.begin() + static_cast<std::ptrdiff_t>(trust.size() / 2);
  std::nth_element(trust.begin(), middle, trust.end());
  const float median = std::max(*middle, std::numeric_limits<float>::min());
  for (size_t i = 0; i < trust.size(); ++i) trust[i] = 2 * median / (variances[i] + median);
  return trust;
}

HeightField IntegrateRepeatingNormals(const SvbrdfMaps& maps, const SamplePlane& plane,
                                      double longest_mm) {
  HeightField field;
  field.width = maps.width;
  field.height = maps.height;
  field.repeats = true;
  field.texel_x_mm = plane.width_mm / maps.width;
  field.texel_y_mm = plane.height_mm / maps.height;
  const auto slope = [&](int row, int column) {
    return SlopeOf(maps, static_cast<size_t>(row % maps.height) * maps.width + column % maps.width);
  };
  std::vector<double> across, down;
  for (int row = 0; row < maps.height; ++row) {
    for (int column = 0; column < maps.width; ++column) {
      const Slope here = slope(row, column);
      across.push_back(0.5 * (here.x + slope(row, column + 1).x) * field.texel_x_mm);
      down.push_back(-0.5 * (here.y + slope(row + 1, column).y) * field.texel_y_mm);
    }
  }
  // What rises all the way round cannot repeat: SolveTorusPoisson leaves the mean slope out by
  // itself, since its sums over the torus vanish.
  const double screening =
      longest_mm > 0 ? std::pow(2 * std::numbers::pi *
                                    std::sqrt(field.texel_x_mm * field.texel_y_mm) / longest_mm,
                                2)
                     : 0;
  const std::vector<double> heights =
      SolveTorusPoisson(maps.width, maps.height, across, down, {}, screening);
  field.height_mm.assign(heights.begin(), heights.end());
  return field;
}

std::vector<float> NormalsOf(const HeightField& field) {
  const size_t texels = field.height_mm.size();
  std::vector<float> normals(3 * texels);
  for (int row = 0; row < field.height; ++row) {
    for (int column = 0; column < field.width; ++column) {
      const int left = std::max(column - 1, 0), right = std::min(column + 1, field.width - 1);
      const int above = std::max(row - 1, 0), below = std::min(row + 1, field.height - 1);
      const double x = right > left ? (field.at(row, right) - field.at(row, left)) /
                                          ((right - left) * field.texel_x_mm)
                                    : 0;
      const double y = below > above ? (field.at(above, column) - field.at(below, column)) /
                                           ((below - above) * field.texel_y_mm)
                                     : 0;
      const double length = std::sqrt(1 + x * x + y * y);
      const size_t i = static_cast<size_t>(row) * field.width + column;
      normals[i] = static_cast<float>(-x / length);
      normals[texels + i] = static_cast<float>(-y / length);
      normals[2 * texels + i] = static_cast<float>(1 / length);
    }
  }
  return normals;
}

}  // namespace glint
