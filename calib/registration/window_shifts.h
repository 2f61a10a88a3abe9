// By how much texture is displaced between pairs of pictures, window by window.
#pragma once

#include <opencv2/core.hpp>
#include <utility>
#include <vector>

namespace glint {

// What lies at (x, y) − ½ (dx, dy) in picture `first` lies at (x, y) + ½ (dx, dy) in `second`,
// pixels; (x, y) is the window's centre.
struct WindowShift {
  int first = 0, second = 0;
  double x_px = 0, y_px = 0;
  double dx_px = 0, dy_px = 0;
  double response = 0;  // share of the phase correlation's energy about its peak, 0 … 1
};

// Pairs of pictures to compare: all pairs of few, a number of partners each of many, so that the
// work grows with their number and not its square.
std::vector<std::pair<int, int>> PairsOf(int pictures);

// Windows of `width` pixels a side that overlap by half, of pictures of one size (CV_32F). Phase
// correlation (Kuglin & Hines 1975), its peak's centre of mass between the pixels. Only shifts with
// a response of constants::kLeastResponse and up to `longest_px` long, in the order of the windows.
// `windows` (may be null) returns how many were compared. The same for any number of threads.
std::vector<WindowShift> WindowShifts(const std::vector<cv::Mat>& pictures,
                                      const std::vector<std::pair<int, int>>& pairs, int width,
                                      double longest_px, int threads, int* windows);

}  // namespace glint
