#include "fitting/rectified_photographs/rectified_photographs.h"

#include <utility>

#include "base/parallel/parallel.h"

namespace glint {

RectifiedPhotographs::RectifiedPhotographs(RectifiedSet set, std::vector<RectifiedView> views,
                                           const Vec3d& light_scale_rgb)
    : set_(std::move(set)), views_(std::move(views)) {
  for (RectifiedView& view : views_) {
    for (size_t c = 0; c < 3; ++c) view.view.light_rgb[c] *= light_scale_rgb[c];
    readers_.emplace_back(set_, view);
  }
}

PhotographSet RectifiedPhotographs::WithoutPixels() const {
  PhotographSet photographs;
  photographs.plane = set_.plane;
  photographs.convention = set_.convention;
  photographs.light_power_known = set_.light_power_known;
  for (const RectifiedView& view : views_) {
    photographs.photographs.push_back(
        {view.view, view.ldr, {}, {}, view.pixels_per_texel.value_or(0), view.blur_px.value_or(0)});
  }
  return photographs;
}

Photograph RectifiedPhotographs::ReadRows(size_t photograph, int first_row, int rows) {
  const RectifiedView& view = views_[photograph];
  RectifiedImage image = readers_[photograph].Read(first_row, rows);
  AdmitClippedTexels(view, &image);
  return {view.view,
          view.ldr,
          std::move(image.rgb),
          std::move(image.mask),
          view.pixels_per_texel.value_or(0),
          view.blur_px.value_or(0)};
}

PhotographSet RectifiedPhotographs::Rows(int first_row, int rows, int threads) {
  PhotographSet photographs = WithoutPixels();
  if (rows < set_.plane.height) photographs.plane = set_.plane.Rows(first_row, rows);
  ForEachPiece(static_cast<int>(views_.size()), threads, [&](int i) {
    const auto k = static_cast<size_t>(i);
    photographs.photographs[k] = ReadRows(k, first_row, rows);
  });
  return photographs;
}

PhotographSet RectifiedPhotographs::Downsampled(int width, int height, int threads) {
  if (width == set_.plane.width && height == set_.plane.height) return Whole(threads);
  PhotographSet photographs = WithoutPixels();
  photographs.plane.width = width;
  photographs.plane.height = height;
  ForEachPiece(static_cast<int>(views_.size()), threads, [&](int i) {
    const auto k = static_cast<size_t>(i);
    photographs.photographs[k] =
        DownsampledByRows([&](int first_row, int rows) { return ReadRows(k, first_row, rows); },
                          set_.plane, width, height, 1);
  });
  return photographs;
}

}  // namespace glint
