#include "pipeline/report/shown_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/parallel/parallel.h"
#include "pipeline/report/picture.h"

namespace glint {
namespace {

constexpr float kDifferenceGain = 4;

// 0 where the photograph says nothing.
std::vector<float> Difference(const RectifiedImage& photograph, std::span<const float> rendered,
                              bool ldr) {
  const float high = ldr ? 1.0f : std::numeric_limits<float>::infinity();
  const size_t texels = photograph.mask.size();
  std::vector<float> difference(rendered.size());
  for (size_t i = 0; i < rendered.size(); ++i) {
    if (photograph.mask[i % texels] < 0.5f) continue;
    difference[i] =
        std::abs(std::clamp(photograph.rgb[i], 0.0f, high) - std::clamp(rendered[i], 0.0f, high));
  }
  return difference;
}

// Radiance is averaged, not what is displayed of it.
std::string PictureUri(std::span<const float> rgb, const RectifiedImage& photograph, int side_px,
                       float gain = 1) {
  const Image small = ShrunkPlanes(rgb, photograph.width, photograph.height, side_px);
  return JpegUri(DisplayImage(small.samples, small.width, small.height, gain));
}

ShownView Show(const ReportInput& input, const ReportOptions& options, const RectifiedView& view) {
  const SamplePlane& plane = input.shown.plane;
  const RectifiedImage photograph =
      PhotographOfFit(input.fit, input.set, view, plane.width, plane.height);
  const std::vector<float> rendered = RenderFit(input.fit, input.shown, view, 1);
  const int cell_px = options.picture_px / 2;
  const auto cell = [&](std::span<const float> rgb, const std::string& what, float gain) {
    return "<td>" + ImageHtml(PictureUri(rgb, photograph, cell_px, gain), what + " " + view.name) +
           "</td>";
  };
  return {CompareView(rendered, photograph, view.ldr), CompareLooks(rendered, photograph, view.ldr),
          PictureUri(photograph.rgb, photograph, options.picture_px),
          cell(photograph.rgb, "photograph", 1) + cell(rendered, "rendering", 1) +
              cell(Difference(photograph, rendered, view.ldr), "difference", kDifferenceGain)};
}

}  // namespace

std::vector<ShownView> ShowViews(const ReportInput& input, const ReportOptions& options,
                                 int threads) {
  std::vector<ShownView> views(input.set.views.size());
  const int at_once = threads == 1 ? 1 : kViewsAtOnce;
  ForEachPiece(static_cast<int>(views.size()), at_once, [&](int i) {
    const auto view = static_cast<size_t>(i);
    views[view] = Show(input, options, input.set.views[view]);
  });
  return views;
}

}  // namespace glint
