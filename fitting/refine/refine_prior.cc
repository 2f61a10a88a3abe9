#include "fitting/refine/refine_prior.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Weight of the start against one view, in units of sigma²/error². Far above 1, since a photograph's
// three numbers are exact but nine unknowns explain them in many wrong ways.
constexpr double kOneView = 15.0;

}  // namespace

double DistinctViews(const RefineProblem& problem) {
  constexpr double kSpread = 8.0 * 3.14159265358979 / 180.0;
  std::vector<TexelGeometry<double>> geometry;
  for (const RefineView& view : problem.views) {
    geometry.push_back(TexelGeometryInView<double>(view.view, problem.convention.falloff, 0, 0));
  }
  double alike = 0.0;
  for (const auto& a : geometry) {
    for (const auto& b : geometry) {
      const double angle = std::acos(std::clamp(Dot(a.half, b.half), -1.0, 1.0));
      alike += std::exp(-angle * angle / (2.0 * kSpread * kSpread));
    }
  }
  const double n = static_cast<double>(geometry.size());
  return alike > 0.0 ? n * n / alike : 0.0;
}

PriorWeights HoldToStart(double factor, double residual_sigma, double distinct_views,
                         const StartErrors& errors) {
  const double scale =
      residual_sigma * std::sqrt(kOneView * factor) / std::max(distinct_views, 1.0);
  PriorWeights weights;
  weights.normal = scale / errors.normal;
  weights.roughness = scale / errors.roughness;
  weights.diffuse = scale / errors.diffuse;
  weights.specular = scale / errors.specular;
  return weights;
}

}  // namespace glint
