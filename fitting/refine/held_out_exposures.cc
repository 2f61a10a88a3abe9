#include "fitting/refine/held_out_exposures.h"

#include <algorithm>
#include <cmath>

#include "base/model/photographs.h"
#include "base/model/uncalibrated_light.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"
#include "base/reflectance/log_radiance.h"
#include "base/reflectance/texel_at.h"
#include "base/statistics/median.h"

namespace glint {
namespace {

double ExposureOf(const RefineProblem& problem, const SvbrdfMaps& maps, const RefineView& view) {
  const SamplePlane& plane = problem.plane;
  const size_t texels = maps.texels();
  std::vector<double> ratios;
  for (size_t i = 0; i < texels; ++i) {
    if (view.mask[i] < 0.5f) continue;
    const TexelGeometry<double> geometry = TexelGeometryInView(
        view.view, problem.convention.falloff, plane.x_mm(static_cast<int>(i) % plane.width),
        plane.y_mm(static_cast<int>(i) / plane.width));
    double radiance[3];
    ShadeRadiance(TexelAt(maps, i), geometry, problem.convention, radiance);
    for (size_t c = 0; c < 3; ++c) {
      const double seen = view.rgb[c * texels + i];
      if (view.ldr && seen >= constants::kClippedRadiance) continue;
      // Below it rounding decides, and the loss does not look.
      if (!(seen > kLogOffset) || !(radiance[c] > 0)) continue;
      ratios.push_back(seen / radiance[c]);
    }
  }
  return ratios.empty() ? 1 : Median(ratios);
}

}  // namespace

std::vector<double> HeldOutExposures(SampleSource* source, int threads) {
  const SamplePlane& plane = source->plane();
  int stride = 1;
  while (std::max(plane.width, plane.height) > stride * constants::kHeldOutSide_texel) stride += 2;
  const SampleSource::Part part = source->Every(stride, threads);
  const RefineProblem problem = part.Problem();
  std::vector<double> exposures(problem.views.size(), 1.0);
  ForEachPiece(static_cast<int>(exposures.size()), threads, [&](int view) {
    const auto v = static_cast<size_t>(view);
    exposures[v] = ExposureOf(problem, part.start, problem.views[v]);
  });
  return exposures;
}

}  // namespace glint
