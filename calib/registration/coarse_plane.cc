#include "calib/registration/coarse_plane.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "calib/registration/place_fit.h"
#include "calib/registration/window_heights.h"
#include "calib/registration/window_textures.h"

namespace glint {
namespace {

std::vector<cv::Rect> SomeWindows(const DetailPictures& pictures, const cv::Size& size) {
  const int width =
      static_cast<int>(std::lround(constants::kTextureWindow * std::max(size.width, size.height)));
  std::vector<cv::Rect> some;
  for (const cv::Rect& window : WindowsOf(pictures, size, width, width)) {
    const bool inside = window.x / width % constants::kCoarseEveryOther == 0 &&
                        window.y / width % constants::kCoarseEveryOther == 0;
    if (inside) some.push_back(window);
  }
  return some;
}

}  // namespace

PlaneValues CoarsePlane(const RegistrationProblem& problem, const DetailPictures& pictures,
                        int threads) {
  const PlaneValues expected = {problem.height_mm, 0, 0};
  const cv::Size size = pictures.SizeOf(constants::kCoarseSide_px);
  const std::vector<cv::Rect> windows = SomeWindows(pictures, size);
  const double parallax = LargestParallax(pictures);
  if (problem.height_sd_mm <= 0 || windows.empty() || !(parallax > 0)) return expected;
  const double step_mm = pictures.PixelSide_mm(size) / parallax;
  const int each_way =
      std::min(constants::kCoarseMostEachWay,
               static_cast<int>(constants::kCoarseReach_sd * problem.height_sd_mm / step_mm));
  std::vector<double> heights;
  for (int i = -each_way; i <= each_way; ++i) heights.push_back(i * step_mm);
  SamplePlaces places;
  places.plane = expected;
  places.homographies.resize(static_cast<size_t>(pictures.views()));
  const double samples = windows[0].area() / constants::kPixelsPerSample;
  const Eigen::MatrixXd misfits =
      samples * HeightMisfits(pictures, places, size, windows, heights, threads);
  Eigen::VectorXd together = misfits.rowwise().sum();
  for (size_t i = 0; i < heights.size(); ++i) {
    together[static_cast<Eigen::Index>(i)] += std::pow(heights[i] / problem.height_sd_mm, 2);
  }
  Eigen::Index best = 0;
  together.minCoeff(&best);
  places.plane[0] += heights[static_cast<size_t>(best)];
  // A tilted sample's windows are each best at a height of their own, near that.
  std::vector<WindowHeight> found;
  for (size_t w = 0; w < windows.size(); ++w) {
    const cv::Rect& window = windows[w];
    const Eigen::Vector2d centre =
        pictures.SamplePoint(size, window.x + 0.5 * window.width, window.y + 0.5 * window.height);
    const auto reach = static_cast<Eigen::Index>(1 + constants::kCoarseReach_sd * problem.slope_sd *
                                                         centre.norm() / step_mm);
    const Eigen::Index from = std::max<Eigen::Index>(best - reach, 0);
    const Eigen::Index count = std::min(best + reach + 1, misfits.rows()) - from;
    const auto near = misfits.col(static_cast<Eigen::Index>(w)).segment(from, count);
    Eigen::Index at = 0;
    const double least = near.minCoeff(&at);
    if (0.5 * (near.maxCoeff() - least) < constants::kTellingLogLikelihood) continue;
    found.push_back({centre, static_cast<double>(from + at - best) * step_mm});
  }
  if (std::ssize(found) < constants::kLeastHeights) return places.plane;
  return FitPlane(problem, places, {}, found).places.plane;
}

}  // namespace glint
