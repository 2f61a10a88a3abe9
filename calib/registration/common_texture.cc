#include "calib/registration/common_texture.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "base/model/registration.h"

namespace glint {
namespace {

// Shifts to the left and up lie at the far ends.
float At(const cv::Mat& surface, const cv::Point& shift) {
  return surface.at<float>((shift.y + surface.rows) % surface.rows,
                           (shift.x + surface.cols) % surface.cols);
}

// The highest place within `reach` of a centre, and within `most` of no shift.
cv::Point Highest(const cv::Mat& surface, const cv::Point& centre, int reach, int most) {
  cv::Point top = centre;
  for (int y = std::max(-most, centre.y - reach); y <= std::min(most, centre.y + reach); ++y) {
    for (int x = std::max(-most, centre.x - reach); x <= std::min(most, centre.x + reach); ++x) {
      if (At(surface, {x, y}) > At(surface, top)) top = {x, y};
    }
  }
  return top;
}

cv::Point Climb(const cv::Mat& surface, int most) {
  cv::Point at{0, 0};
  for (;;) {
    const cv::Point next = Highest(surface, at, 1, most);
    if (next == at) return at;
    at = next;
  }
}

// Of the parabola through three values, from the middle one on; the middle one may lie at the edge.
double PeakBetween(double before, double here, double after) {
  const double bend = before - 2 * here + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

}  // namespace

CommonTexture::CommonTexture(const std::vector<cv::Mat>& pictures, int reach_px)
    : reach_px_(reach_px),
      padded_(cv::getOptimalDFTSize(pictures[0].cols + reach_px),
              cv::getOptimalDFTSize(pictures[0].rows + reach_px)) {
  const auto n = static_cast<int>(pictures.size());
  Eigen::MatrixXd products(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      products(i, j) = products(j, i) =
          pictures[static_cast<size_t>(i)].dot(pictures[static_cast<size_t>(j)]);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(products);
  for (int factor = 0; factor < std::min(n, constants::kMostFactors); ++factor) {
    const int at = n - 1 - factor;
    const double value = eigen.eigenvalues()[at];
    if (factor > 0 && value < 1) break;  // less than one picture has of its own
    cv::Mat component = cv::Mat::zeros(pictures[0].size(), CV_32F);
    for (int i = 0; i < n; ++i) {
      component +=
          eigen.eigenvectors()(i, at) / std::sqrt(value) * pictures[static_cast<size_t>(i)];
    }
    spectra_.push_back(Spectrum(component));
  }
}

cv::Mat CommonTexture::Spectrum(const cv::Mat& picture) const {
  cv::Mat padded = cv::Mat::zeros(padded_, CV_32F), spectrum;
  picture.copyTo(padded(cv::Rect({0, 0}, picture.size())));
  cv::dft(padded, spectrum, cv::DFT_COMPLEX_OUTPUT, picture.rows);
  return spectrum;
}

cv::Mat CommonTexture::ExplainedByShift(const cv::Mat& picture) const {
  const cv::Mat spectrum = Spectrum(picture);
  cv::Mat explained = cv::Mat::zeros(padded_, CV_32F);
  for (const cv::Mat& factor : spectra_) {
    cv::Mat product, correlation;
    cv::mulSpectrums(spectrum, factor, product, 0, true);
    cv::dft(product, correlation, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT | cv::DFT_SCALE);
    cv::accumulateSquare(correlation, explained);
  }
  return explained;
}

double CommonTexture::Explained(const cv::Mat& picture) const {
  return At(ExplainedByShift(picture), {0, 0});
}

TextureShift CommonTexture::Compare(const cv::Mat& picture) const {
  const cv::Mat explained = ExplainedByShift(picture);
  const cv::Point near = Climb(explained, reach_px_);
  const cv::Point far = Highest(explained, {0, 0}, reach_px_, reach_px_);
  const bool moved = 1 - At(explained, far) < constants::kMoveExplains * (1 - At(explained, near));
  const cv::Point top = moved ? far : near;
  const double here = At(explained, top);
  const auto beside = [&](int x, int y) { return At(explained, top + cv::Point(x, y)); };
  return {{top.x + PeakBetween(beside(-1, 0), here, beside(1, 0)),
           top.y + PeakBetween(beside(0, -1), here, beside(0, 1))},
          here};
}

}  // namespace glint
