#include "fitting/relief/height_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

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

HeightField IntegrateNormals(const SvbrdfMaps& maps, const SamplePlane& plane, double longest_mm) {
  HeightField field;
  field.width = maps.width;
  field.height = maps.height;
  const int width = Even(maps.width), height = Even(maps.height);
  const int gaps_x = std::max(1, maps.width - 1), gaps_y = std::max(1, maps.height - 1);
  field.texel_x_mm = (plane.x_mm(maps.width - 1) - plane.x_mm(0)) / gaps_x;
  field.texel_y_mm = (plane.y_mm(0) - plane.y_mm(maps.height - 1)) / gaps_y;

  // Differences to the right and downward; between two texels the mean of their slopes.
  const auto slope = [&](int row, int column) {
    const int r = std::min(row, maps.height - 1), c = std::min(column, maps.width - 1);
    return SlopeOf(maps, static_cast<size_t>(r) * maps.width + c);
  };
  cv::Mat divergence = cv::Mat::zeros(height, width, CV_64F);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Slope here = slope(row, column);
      if (column + 1 < width) {
        const double right = 0.5 * (here.x + slope(row, column + 1).x) * field.texel_x_mm;
        divergence.at<double>(row, column) += right;
        divergence.at<double>(row, column + 1) -= right;
      }
      if (row + 1 < height) {  // rows run against y
        const double down = -0.5 * (here.y + slope(row + 1, column).y) * field.texel_y_mm;
        divergence.at<double>(row, column) += down;
        divergence.at<double>(row + 1, column) -= down;
      }
    }
  }
  // Texels are as good as square (glint-rectify, glint-import).
  const double texel_mm = std::sqrt(field.texel_x_mm * field.texel_y_mm);
  const double screening =
      longest_mm > 0 ? std::pow(2 * std::numbers::pi * texel_mm / longest_mm, 2) : 0;
  cv::Mat spectrum;
  cv::dct(divergence, spectrum);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double eigenvalue = 2 * std::cos(std::numbers::pi * column / width) +
                                2 * std::cos(std::numbers::pi * row / height) - 4;
      double& value = spectrum.at<double>(row, column);
      value = row + column > 0 ? value / (eigenvalue - screening) : 0.0;
    }
  }
  cv::Mat solved;
  cv::idct(spectrum, solved);
  const double mean = cv::mean(solved(cv::Rect(0, 0, maps.width, maps.height)))[0];
  field.height_mm.reserve(maps.texels());
  for (int row = 0; row < maps.height; ++row) {
    for (int column = 0; column < maps.width; ++column) {
      field.height_mm.push_back(static_cast<float>(solved.at<double>(row, column) - mean));
    }
  }
  return field;
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
