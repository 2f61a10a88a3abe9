#include "calib/registration/window_heights.h"

#include <algorithm>
#include <cmath>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "base/parallel/parallel.h"
#include "calib/registration/factor_analysis.h"
#include "calib/registration/window_textures.h"

namespace glint {
namespace {

std::vector<double> Steps(double centre, double step, int each_way) {
  std::vector<double> heights;
  for (int i = -each_way; i <= each_way; ++i) heights.push_back(centre + i * step);
  return heights;
}

}  // namespace

Eigen::MatrixXd HeightMisfits(const DetailPictures& pictures, const SamplePlaces& places,
                              const cv::Size& size, const std::vector<cv::Rect>& windows,
                              const std::vector<double>& heights, int threads) {
  const int least = FactorsOf(pictures.views()) == 0 ? 1 : 0;
  Eigen::MatrixXd misfits = Eigen::MatrixXd::Zero(heights.size(), windows.size());
  ForEachPiece(static_cast<int>(windows.size()), threads, [&](int window) {
    SamplePlaces at = places;
    int factors = 0;
    for (size_t i = 0; i < heights.size(); ++i) {
      at.plane[0] = places.plane[0] + heights[i];
      const Eigen::MatrixXd covariance =
          TexturesOf(pictures, at, size, windows[static_cast<size_t>(window)]).Covariance();
      if (i == 0) factors = std::max(least, FactorsOf(covariance));
      if (factors == 0) return;
      misfits(static_cast<Eigen::Index>(i), window) = FitFactors(covariance, factors).misfit;
    }
  });
  return misfits;
}

double LargestParallax(const DetailPictures& pictures) {
  double largest = 0;
  for (int i = 0; i < pictures.views(); ++i) {
    const Eigen::Vector3d& a = pictures.camera_mm(i);
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d& b = pictures.camera_mm(j);
      largest = std::max(largest, (a.head<2>() / a.z() - b.head<2>() / b.z()).norm());
    }
  }
  return largest;
}

std::vector<WindowHeight> WindowHeights(const DetailPictures& pictures, const SamplePlaces& places,
                                        const cv::Size& size, bool near, int threads) {
  const double parallax = LargestParallax(pictures);
  if (FactorsOf(pictures.views()) == 0 || !(parallax > 0)) return {};
  const int width =
      static_cast<int>(std::lround(constants::kTextureWindow * std::max(size.width, size.height)));
  std::vector<cv::Rect> windows;
  for (const cv::Rect& window : WindowsOf(pictures, size, width, width)) {
    // Every other one, like a chessboard's white squares.
    if ((window.x / width + window.y / width) % 2 == 0) windows.push_back(window);
  }
  if (windows.empty()) return {};
  const double step_mm = pictures.PixelSide_mm(size) / parallax;
  double best_mm = 0;
  if (!near) {
    const std::vector<double> far = Steps(0, step_mm, constants::kFarHeights);
    Eigen::Index best = 0;
    HeightMisfits(pictures, places, size, windows, far, threads).rowwise().sum().minCoeff(&best);
    best_mm = far[static_cast<size_t>(best)];
  }
  const std::vector<double> heights =
      Steps(best_mm, constants::kFineHeightStep_px * step_mm, constants::kFineHeights);
  const Eigen::MatrixXd misfits = HeightMisfits(pictures, places, size, windows, heights, threads);
  const double samples = windows[0].area() / constants::kPixelsPerSample;
  std::vector<WindowHeight> found;
  for (size_t w = 0; w < windows.size(); ++w) {
    const auto column = misfits.col(static_cast<Eigen::Index>(w));
    Eigen::Index at = 0;
    column.minCoeff(&at);
    if (at == 0 || at + 1 == misfits.rows()) continue;  // it tells no height near here
    const double before = column[at - 1], here = column[at], after = column[at + 1];
    const double bend = before - 2 * here + after;
    if (!(bend > 0)) continue;
    if (0.5 * samples * (column.maxCoeff() - here) < constants::kTellingLogLikelihood) continue;
    const cv::Rect& window = windows[w];
    found.push_back({pictures.SamplePoint(size, window.x + 0.5 * width, window.y + 0.5 * width),
                     heights[static_cast<size_t>(at)] +
                         0.5 * constants::kFineHeightStep_px * step_mm * (before - after) / bend});
  }
  return found;
}

}  // namespace glint
