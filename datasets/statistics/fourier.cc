#include "datasets/statistics/fourier.h"

#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

namespace glint {
namespace {

void Transform(std::vector<Complex>* plane, int side, int flags) {
  if (plane->size() != static_cast<size_t>(side) * side) {
    throw std::invalid_argument("Fourier transform of a side of " + std::to_string(side) +
                                "; the plane has " + std::to_string(plane->size()) + " values");
  }
  cv::Mat view(side, side, CV_64FC2, plane->data());
  cv::dft(view, view, flags);
}

}  // namespace

bool IsPowerOfTwo(int n) { return n > 0 && (n & (n - 1)) == 0; }

void Fourier2d(std::vector<Complex>* plane, int side) { Transform(plane, side, 0); }

void InverseFourier2d(std::vector<Complex>* plane, int side) {
  Transform(plane, side, cv::DFT_INVERSE | cv::DFT_SCALE);
}

}  // namespace glint
