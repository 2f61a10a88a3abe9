#include "datasets/evaluation/held_out_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"
#include "datasets/looks/view_error.h"

namespace glint {
namespace {

constexpr int kThumb = 160;  // pixels a side
constexpr int kGap = 4, kTextHeight = 22;
constexpr float kDifferenceGain = 4;

cv::Mat Thumb(std::span<const float> rgb, int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  const size_t texels = picture.total();
  for (size_t i = 0; i < texels; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float value = std::pow(std::clamp(rgb[c * texels + i], 0.0f, 1.0f), 1 / 2.2f);
      picture.ptr<cv::Vec3b>()[i][static_cast<int>(c)] =
          static_cast<unsigned char>(std::lround(255 * value));
    }
  }
  cv::resize(picture, picture, {kThumb, kThumb}, 0, 0,
             width > kThumb ? cv::INTER_AREA : cv::INTER_NEAREST);
  return picture;
}

// Photograph, rendering, difference.
cv::Mat Triple(const FittedMaps& fit, const RectifiedSet& set, const RectifiedView& view,
               int threads) {
  const RectifiedImage photograph = PhotographOfFit(fit, set, view);
  const std::vector<float> rendered = RenderFit(fit, set, view, threads);
  std::vector<float> difference(rendered.size());
  for (size_t k = 0; k < rendered.size(); ++k) {
    const float seen = std::clamp(photograph.rgb[k], 0.0f, 1.0f);
    difference[k] = kDifferenceGain * std::abs(seen - std::clamp(rendered[k], 0.0f, 1.0f));
  }
  cv::Mat triple(kThumb, 3 * kThumb + 2 * kGap, CV_8UC3, cv::Scalar(255, 255, 255));
  int left = 0;
  for (const std::span<const float> rgb :
       {std::span<const float>(photograph.rgb), std::span<const float>(rendered),
        std::span<const float>(difference)}) {
    Thumb(rgb, set.plane.width, set.plane.height).copyTo(triple(cv::Rect(left, 0, kThumb, kThumb)));
    left += kThumb + kGap;
  }
  return triple;
}

}  // namespace

Image DrawHeldOutSheet(const HoldoutResult& result, const std::string& split,
                       const std::string& method, int threads) {
  std::vector<const HoldoutEntry*> rows;
  int columns = 0;
  for (const HoldoutEntry& entry : result.entries) {
    if (entry.split != split || entry.method != method) continue;
    rows.push_back(&entry);
    columns = std::max(columns, entry.held_out_views);
  }
  const int block_width = 3 * (kThumb + kGap) + kGap, block_height = kThumb + kTextHeight + kGap;
  cv::Mat canvas(std::max(1, static_cast<int>(rows.size()) * block_height),
                 std::max(1, columns * block_width), CV_8UC3, cv::Scalar(255, 255, 255));
  for (int row = 0; row < std::ssize(rows); ++row) {
    const HoldoutEntry& entry = *rows[static_cast<size_t>(row)];
    const FittedMaps fit = ReadFittedMaps(entry.manifest);
    const RectifiedSet set = ReadRectifiedSet(entry.views);
    const int top = row * block_height;
    cv::putText(canvas,
                fmt::format("{}, {}: photograph, {}, 4 x difference; log-L1 {:.3f}", entry.set,
                            split, method, entry.held_out.log_l1),
                {kGap, top + kTextHeight - 7}, cv::FONT_HERSHEY_SIMPLEX, 0.42,
                cv::Scalar(30, 30, 30), 1, cv::LINE_AA);
    for (int column = 0; column < std::ssize(entry.held_out_names); ++column) {
      const std::string& name = entry.held_out_names[static_cast<size_t>(column)];
      const cv::Mat triple = Triple(fit, set, SelectViews(set, {name}, {}).front(), threads);
      triple.copyTo(canvas(
          cv::Rect(kGap + column * block_width, top + kTextHeight, triple.cols, triple.rows)));
    }
  }
  return ImageOf(canvas);
}

}  // namespace glint
