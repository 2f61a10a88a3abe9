#include "rectify/views/frame_mask.h"

namespace glint {
namespace {

class Frame {
 public:
  Frame(BoardRectangle opening, double height_mm, double margin_mm)
      : opening_(opening), height_mm_(height_mm), margin_mm_(margin_mm) {}

  // Whether the ray from the texel at (x, y) to `to` meets the frame.
  bool Stops(double x_mm, double y_mm, const Vec3d& to_mm) const {
    if (height_mm_ <= 0) return false;
    const double t = height_mm_ / to_mm[2];
    if (t >= 1) return true;  // light or camera lower than the frame's top
    return Covers(x_mm + (to_mm[0] - x_mm) * t, y_mm + (to_mm[1] - y_mm) * t);
  }

  bool Covers(double x_mm, double y_mm) const {
    return x_mm < opening_.left_mm + margin_mm_ || x_mm > opening_.right_mm - margin_mm_ ||
           y_mm < opening_.bottom_mm + margin_mm_ || y_mm > opening_.top_mm - margin_mm_;
  }

 private:
  BoardRectangle opening_;
  double height_mm_, margin_mm_;
};

}  // namespace

std::vector<TexelStatus> MaskFrame(const SamplePlane& plane, const BoardRectangle& opening,
                                   double height_mm, double margin_mm, const View& view) {
  const Frame frame(opening, height_mm, margin_mm);
  std::vector<TexelStatus> status(static_cast<size_t>(plane.width) * plane.height,
                                  TexelStatus::kOutside);
  for (int row = 0; row < plane.height; ++row) {
    for (int column = 0; column < plane.width; ++column) {
      const double x_mm = plane.x_mm(column), y_mm = plane.y_mm(row);
      if (frame.Covers(x_mm, y_mm) || frame.Stops(x_mm, y_mm, view.light_in_sample_mm) ||
          frame.Stops(x_mm, y_mm, view.camera_in_sample_mm)) {
        status[static_cast<size_t>(row) * plane.width + column] = TexelStatus::kMasked;
      }
    }
  }
  return status;
}

}  // namespace glint
