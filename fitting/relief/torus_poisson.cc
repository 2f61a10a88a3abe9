#include "fitting/relief/torus_poisson.h"

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

namespace glint {

std::vector<double> SolveTorusPoisson(int width, int height, const std::vector<double>& across,
                                      const std::vector<double>& down,
                                      const std::vector<double>& data, double screening) {
  // The normal equations: (L + screening)·u = right, L the negative Laplacian.
  cv::Mat right = cv::Mat::zeros(height, width, CV_64F);
  double mean = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const size_t i = static_cast<size_t>(row) * width + column;
      right.at<double>(row, column) -= across[i] + down[i];
      right.at<double>(row, (column + 1) % width) += across[i];
      right.at<double>((row + 1) % height, column) += down[i];
      if (data.empty()) continue;
      right.at<double>(row, column) += screening * data[i];
      mean += data[i];
    }
  }
  cv::Mat spectrum;
  cv::dft(right, spectrum, cv::DFT_COMPLEX_OUTPUT);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      cv::Vec2d& value = spectrum.at<cv::Vec2d>(row, column);
      if (row + column == 0) {
        value = {mean, 0};
        continue;
      }
      const double eigenvalue = 4 - 2 * std::cos(2 * std::numbers::pi * column / width) -
                                2 * std::cos(2 * std::numbers::pi * row / height);
      value /= eigenvalue + screening;
    }
  }
  cv::Mat solved;
  cv::dft(spectrum, solved, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return {solved.begin<double>(), solved.end<double>()};
}

}  // namespace glint
