#include "fitting/refine/refine_prior.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// How much harder than belief a single view has the start held, and how fast that falls with views.
constexpr double kOneView = 15.0;
constexpr double kFall = 1.4;

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

PriorWeights BelieveStart(double residual_sigma, const StartErrors& errors) {
  return {residual_sigma, errors};
}

PriorWeights HoldToStart(double factor, double residual_sigma, double distinct_views,
                         const StartErrors& errors) {
  const double views = std::max(distinct_views, 1.0);
  const double harder = std::sqrt(factor * kOneView * std::pow(views, -kFall));
  return BelieveStart(residual_sigma * harder, errors);
}

}  // namespace glint
