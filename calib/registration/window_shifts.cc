#include "calib/registration/window_shifts.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "base/parallel/parallel.h"

namespace glint {
namespace {

struct Peak {
  double dx = 0, dy = 0, response = 0;
};

// Of phase correlation: `surface` is the inverse transform, unscaled, of unit amplitudes.
Peak PeakOf(const cv::Mat& surface) {
  cv::Point top;
  cv::minMaxLoc(surface, nullptr, nullptr, nullptr, &top);
  double sum = 0, x = 0, y = 0;
  for (int j = -constants::kPeakReach_px; j <= constants::kPeakReach_px; ++j) {
    for (int i = -constants::kPeakReach_px; i <= constants::kPeakReach_px; ++i) {
      const float value = surface.at<float>((top.y + j + surface.rows) % surface.rows,
                                            (top.x + i + surface.cols) % surface.cols);
      sum += value;
      x += i * value;
      y += j * value;
    }
  }
  if (!(sum > 0)) return {};
  const auto centred = [](double at, int side) { return at > side / 2.0 ? at - side : at; };
  return {centred(top.x + x / sum, surface.cols), centred(top.y + y / sum, surface.rows),
          sum / static_cast<double>(surface.total())};
}

Peak Correlate(const cv::Mat& first, const cv::Mat& second) {
  cv::Mat product;
  cv::mulSpectrums(second, first, product, 0, true);
  const auto values = product.total();
  auto* at = product.ptr<cv::Vec2f>();
  for (size_t i = 0; i < values; ++i) {
    const float amplitude = std::sqrt(at[i][0] * at[i][0] + at[i][1] * at[i][1]);
    const float scale = amplitude > 0 ? 1 / amplitude : 0;
    at[i][0] *= scale;
    at[i][1] *= scale;
  }
  cv::Mat surface;
  cv::dft(product, surface, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  return PeakOf(surface);
}

struct Window {
  cv::Rect place;
  std::vector<WindowShift> shifts;
};

std::vector<Window> WindowsOf(const cv::Size& size, int width) {
  std::vector<Window> windows;
  for (int y = 0; y + width <= size.height; y += width / 2) {
    for (int x = 0; x + width <= size.width; x += width / 2) {
      windows.push_back({cv::Rect(x, y, width, width), {}});
    }
  }
  return windows;
}

}  // namespace

std::vector<std::pair<int, int>> PairsOf(int pictures) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < pictures; ++i) {
    if (pictures <= constants::kAllPairsUpTo) {
      for (int j = i + 1; j < pictures; ++j) pairs.emplace_back(i, j);
    } else {
      for (const int further : constants::kPairPartners) {
        pairs.emplace_back(i, (i + further) % pictures);
      }
    }
  }
  return pairs;
}

std::vector<WindowShift> WindowShifts(const std::vector<cv::Mat>& pictures,
                                      const std::vector<std::pair<int, int>>& pairs, int width,
                                      double longest_px, int threads, int* windows_compared) {
  std::vector<Window> windows = WindowsOf(pictures[0].size(), width);
  cv::Mat taper;
  cv::createHanningWindow(taper, {width, width}, CV_32F);
  ForEachPiece(static_cast<int>(windows.size()), threads, [&](int piece) {
    Window& window = windows[static_cast<size_t>(piece)];
    std::vector<cv::Mat> spectra(pictures.size());
    for (size_t k = 0; k < pictures.size(); ++k) {
      cv::dft(pictures[k](window.place).mul(taper), spectra[k], cv::DFT_COMPLEX_OUTPUT);
    }
    for (const auto& [first, second] : pairs) {
      const Peak peak =
          Correlate(spectra[static_cast<size_t>(first)], spectra[static_cast<size_t>(second)]);
      if (peak.response < constants::kLeastResponse) continue;
      if (std::hypot(peak.dx, peak.dy) > longest_px) continue;
      window.shifts.push_back({first, second, window.place.x + width / 2.0,
                               window.place.y + width / 2.0, peak.dx, peak.dy, peak.response});
    }
  });
  if (windows_compared != nullptr) {
    *windows_compared = static_cast<int>(windows.size() * pairs.size());
  }
  std::vector<WindowShift> shifts;
  for (const Window& window : windows) {
    shifts.insert(shifts.end(), window.shifts.begin(), window.shifts.end());
  }
  return shifts;
}

}  // namespace glint
