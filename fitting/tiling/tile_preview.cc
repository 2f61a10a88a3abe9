#include "fitting/tiling/tile_preview.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "fitting/render/renderer.h"
#include "fitting/tiling/tile_maps.h"

namespace glint {
namespace {

constexpr int kPreviewSize = 900;  // pixels along the longer side
constexpr int kCopies = 3;
// So bright that this share of the preview is darker than white.
constexpr double kBelowWhite = 0.98;

// Seen from above, from 2.5 times the longer side; a lamp as far away to the upper left.
View PreviewView(double longer_mm) {
  View view;
  view.camera_in_sample_mm = {0, 0, 2.5 * longer_mm};
  view.light_in_sample_mm = {-1.2 * longer_mm, 1.2 * longer_mm, 1.8 * longer_mm};
  const double power = 6 * longer_mm * longer_mm;
  view.light_rgb = {power, power, power};
  return view;
}

}  // namespace

void WriteTilePreview(const std::filesystem::path& file, const SvbrdfMaps& tile, double width_mm,
                      double height_mm, ReflectanceConvention convention, int threads) {
  const double scale = std::min(
      1.0, static_cast<double>(kPreviewSize) / (kCopies * std::max(tile.width, tile.height)));
  const SvbrdfMaps small =
      ResampleSvbrdf(tile, std::max(1, static_cast<int>(std::lround(tile.width * scale))),
                     std::max(1, static_cast<int>(std::lround(tile.height * scale))));
  const SvbrdfMaps maps = Repeated(small, kCopies, kCopies);
  convention.falloff = LightFalloff::kInverseSquare;
  const SamplePlane plane{maps.width, maps.height, kCopies * width_mm, kCopies * height_mm,
                          convention.sampling};
  Image image(maps.width, maps.height, {"R", "G", "B"});
  RenderView(maps, plane, PreviewView(std::max(plane.width_mm, plane.height_mm)), convention,
             image.samples.data(), threads);
  std::vector<float> sorted = image.samples;
  const auto white = sorted.begin() + static_cast<std::ptrdiff_t>(
                                          kBelowWhite * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), white, sorted.end());
  const float exposure = *white > 0 ? 1 / *white : 1;
  for (float& value : image.samples) {
    value = std::pow(std::clamp(exposure * value, 0.0f, 1.0f), 1 / 2.2f);
  }
  WritePng(file, image);
}

}  // namespace glint
