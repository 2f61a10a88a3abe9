#include "pipeline/report/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/formats/svbrdf_file.h"
#include "base/resampling/resampling.h"
#include "fitting/render/renderer.h"
#include "pipeline/report/picture.h"

namespace glint {
namespace {

constexpr float kMiddleGrey = 0.18f;  // the median's radiance, of white

// Camera and flash above the middle, the flash an eighth of the width toward the upper left, so
// that relief shows.
View FlashAbove(const SamplePlane& plane) {
  View view;
  view.camera_in_sample_mm = {0, 0, 2 * plane.width_mm};
  view.light_in_sample_mm = {-plane.width_mm / 4, plane.width_mm / 4, 1.5 * plane.width_mm};
  view.light_rgb = {1, 1, 1};
  return view;
}

float Median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::string ThumbnailJpeg(const SvbrdfMaps& maps, const ReflectanceConvention& convention) {
  const auto [width, height] = SizeAtMost(maps.width, maps.height, kThumbnail_px);
  const SvbrdfMaps small = ResampleSvbrdf(maps, width, height);
  const SamplePlane plane{width, height, 1.0, static_cast<double>(height) / width,
                          TexelSampling::kPixelCentres};
  std::vector<float> rgb(3 * small.texels());
  RenderView(small, plane, FlashAbove(plane), convention, rgb.data());
  const float median = Median(rgb);
  return JpegBytes(DisplayImage(rgb, width, height, kMiddleGrey / std::max(median, 1e-6f)), 85);
}

}  // namespace glint
