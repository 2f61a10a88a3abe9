#include "fitting/view_correction/view_priors.h"

#include <algorithm>
#include <cmath>

#include "base/model/view_correction.h"

namespace glint {
namespace {

using Derivatives = std::vector<std::pair<int, double>>;

double AddOne(double residual, const Derivatives& derivatives, NormalEquations* equations) {
  if (equations != nullptr) equations->Add(residual, derivatives);
  return 0.5 * residual * residual;
}

double AddSimple(const Eigen::VectorXd& x, int at, double sigma, NormalEquations* equations) {
  return AddOne(x[at] / sigma, {{at, 1 / sigma}}, equations);
}

// What a light's offset has of its own.
Eigen::Vector3d OwnOffset(const ViewUnknowns& unknowns, int view, const Eigen::VectorXd& x) {
  return x.segment<3>(unknowns.light(view)) -
         unknowns.LightFrame(view) * x.segment<3>(unknowns.shared_light());
}

}  // namespace

ViewPriors::ViewPriors(const ViewUnknowns& unknowns, const ViewExpectations& expected,
                       const std::vector<bool>& usable)
    : unknowns_(unknowns), expected_(expected), usable_(usable) {}

// Across the light's direction and along it.
double ViewPriors::AddLight(int view, const Eigen::VectorXd& x, NormalEquations* equations) const {
  const Vec3d d = unknowns_.LightDirection(view);
  const Eigen::Vector3d direction(d[0], d[1], d[2]);
  const Eigen::Matrix3d along = direction * direction.transpose();
  const Eigen::Matrix3d by_own =
      (Eigen::Matrix3d::Identity() - along) / expected_.light + along / expected_.distance;
  const Eigen::Matrix3d by_shared = -by_own * unknowns_.LightFrame(view);
  const Eigen::Vector3d residuals = by_own * OwnOffset(unknowns_, view, x);
  double cost = 0;
  for (int i = 0; i < 3; ++i) {
    Derivatives row;
    for (int j = 0; j < 3; ++j) {
      row.emplace_back(unknowns_.light(view) + j, by_own(i, j));
      row.emplace_back(unknowns_.shared_light() + j, by_shared(i, j));
    }
    cost += AddOne(residuals[i], row, equations);
  }
  return cost;
}

double ViewPriors::Add(const Eigen::VectorXd& x, NormalEquations* equations) const {
  double cost = 0;
  const int views = unknowns_.views();
  const UnknownKinds& kinds = unknowns_.kinds();
  for (int v = 0; v < views; ++v) {
    if (!usable_[static_cast<size_t>(v)]) continue;
    if (kinds.light) cost += AddLight(v, x, equations);
    if (kinds.exposure) {
      cost += AddSimple(x, unknowns_.exposure(v), expected_.exposure, equations);
    }
    for (int i = 0; kinds.registration && i < 8; ++i) {
      cost += AddSimple(x, unknowns_.shift(v) + i, expected_.registration_texel, equations);
    }
  }
  for (int i = 0; kinds.registration && i < 8; ++i) {
    Derivatives row;
    double sum = 0;
    for (int v = 0; v < views; ++v) {
      sum += x[unknowns_.shift(v) + i];
      row.emplace_back(unknowns_.shift(v) + i, 1 / (constants::kSharedShiftSd_texel * views));
    }
    cost += AddOne(sum / (constants::kSharedShiftSd_texel * views), row, equations);
  }
  for (int i = 0; kinds.light && i < 3; ++i) {
    cost += AddSimple(x, unknowns_.shared_light() + i,
                      i < 2 ? expected_.shared_light : expected_.distance, equations);
  }
  // The same whatever the number of views: they share it.
  for (int i = 0; i < 3 * kinds.environment_terms; ++i) {
    const bool even = i % kinds.environment_terms == 0;
    cost += AddSimple(x, unknowns_.environment(0) + i,
                      even ? expected_.ambient : expected_.ambient_direction, equations);
  }
  return cost;
}

ViewExpectations ViewPriors::Learned(const Eigen::VectorXd& x,
                                     const ViewExpectations& least) const {
  if (!unknowns_.kinds().light) return least;
  double across = 0, along = 0, count = 0;
  for (int v = 0; v < unknowns_.views(); ++v) {
    if (!usable_[static_cast<size_t>(v)]) continue;
    const Vec3d d = unknowns_.LightDirection(v);
    const Eigen::Vector3d own = OwnOffset(unknowns_, v, x);
    const double toward = own.dot(Eigen::Vector3d(d[0], d[1], d[2]));
    along += toward * toward;
    across += 0.5 * (own.squaredNorm() - toward * toward);
    ++count;
  }
  ViewExpectations learned = least;
  if (count > 0) {
    learned.light = std::max(least.light, std::sqrt(across / count));
    learned.distance = std::max(least.distance, std::sqrt(along / count));
  }
  return learned;
}

}  // namespace glint
