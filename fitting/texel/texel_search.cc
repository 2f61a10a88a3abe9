#include "fitting/texel/texel_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

// Roughnesses to look at: steps of 1.4, about the width of the valley in which one solve converges.
constexpr std::array<double, 8> kRoughnesses = {0.07, 0.10, 0.14, 0.20, 0.28, 0.39, 0.55, 0.77};

// Another start is worth a solve when it promises this much less cost; solutions that differ by
// less are the same for every practical purpose.
constexpr double kWorthwhile = 0.98;
// Gain of a step against one residual's noise: narrow valleys (diffuse light against a rough lobe)
// are walked in short steps.
constexpr double kWorthStep = 0.005;
constexpr double kExplained = 1.5;  // squared residuals against noise alone

// Turns the normal so that it mirrors the light into the camera of the view in which the texel is
// brightest for the light it receives. A normal far from the true one has no slope toward it where
// the lobe is narrow: the highlight is either missed or explained by diffuse light.
bool TurnToBrightest(const TexelObservations& observations, TexelValues* values) {
  int brightest = -1;
  double most = 0;
  for (int v = 0; v < observations.views(); ++v) {
    double reflected = 0;
    for (int c = 0; c < 3; ++c) {
      const double irradiance = observations.plane(TexelObservations::kIrradiance + c)[v];
      const double radiance =
          1 / observations.plane(TexelObservations::kInverseTarget + c)[v] - kLogOffset;
      if (irradiance > 0) reflected += radiance / irradiance;
    }
    if (reflected > most) {
      most = reflected;
      brightest = v;
    }
  }
  if (brightest < 0) return false;
  const double z = observations.plane(TexelObservations::kHalfZ)[brightest];
  if (!(z > 1 / kMostSlope)) return false;
  (*values)[kSlopeX] = observations.plane(TexelObservations::kHalfX)[brightest] / z;
  (*values)[kSlopeY] = observations.plane(TexelObservations::kHalfY)[brightest] / z;
  return true;
}

}  // namespace

TexelSearch::TexelSearch(const KernelOptions& options, int most_iterations, int most_views,
                         int starts)
    : options_(options),
      starts_(starts),
      solver_(options, most_iterations, most_views),
      rows_(most_views) {}

void TexelSearch::SetNoise(double residual_sigma) {
  SetExplained(residual_sigma);
  solver_.SetTolerance(std::max(kWorthStep * variance_, 1e-9));
}

bool TexelSearch::Unexplained(int views, double cost) const {
  return 2.0 * cost > kExplained * variance_ * 3.0 * views;
}

bool TexelSearch::TrySolve(const TexelObservations& observations, const TexelPrior& prior,
                           const TexelValues& from, TexelSolution* best) {
  const TexelSolution solution = solver_.Solve(observations, prior, from);
  if (!(solution.cost < best->cost)) return false;
  *best = solution;
  return true;
}

TexelSearch::Candidate TexelSearch::WithFittedAlbedos(const TexelObservations& observations,
                                                      const TexelPrior& prior,
                                                      const TexelValues& values) {
  Candidate candidate{values, {}};
  double holds[kRough];
  for (int i = 0; i < kRough; ++i) holds[i] = prior.weight(i);
  candidate.fit =
      FitAlbedos(options_, observations, holds, prior.mean(), &candidate.values, &rows_);
  // What the hold on normal and roughness costs; that on albedos is in the fit.
  TexelValues rest = values;
  std::copy_n(prior.mean().begin() + kAlbedos, static_cast<int>(kRough), rest.begin() + kAlbedos);
  const double held = prior.SquaredNorm(rest);
  candidate.fit.before += held;
  candidate.fit.after += held;
  return candidate;
}

void TexelSearch::TryRoughnesses(const TexelObservations& observations, const TexelPrior& prior,
                                 const TexelValues& from, Found* best) {
  const auto fit = [&](double roughness) {
    TexelValues values = from;
    values[kRough] = roughness;
    return WithFittedAlbedos(observations, prior, values);
  };
  // The profile over roughness, with the one it comes from in its place.
  constexpr int kProfile = static_cast<int>(kRoughnesses.size()) + 1;
  std::array<double, kProfile> roughnesses;
  std::copy(kRoughnesses.begin(), kRoughnesses.end(), roughnesses.begin());
  roughnesses.back() = from[kRough];
  std::sort(roughnesses.begin(), roughnesses.end());
  std::array<Candidate, kProfile> profile;
  std::transform(roughnesses.begin(), roughnesses.end(), profile.begin(), fit);

  // Its valleys that promise less than the solution has.
  const double own_squares =
      WithFittedAlbedos(observations, prior, best->solution.values).fit.before;
  std::array<int, kProfile> valleys;
  int count = 0;
  for (int i = 0; i < kProfile; ++i) {
    const double here = profile[i].fit.after;
    const bool valley = (i == 0 || here <= profile[i - 1].fit.after) &&
                        (i + 1 == kProfile || here < profile[i + 1].fit.after);
    if (valley && here < kWorthwhile * own_squares) valleys[count++] = i;
  }
  std::stable_sort(valleys.begin(), valleys.begin() + count,
                   [&](int a, int b) { return profile[a].fit.after < profile[b].fit.after; });
  for (int i = 0; i < std::min(count, starts_ - 1); ++i) {
    if (TrySolve(observations, prior, profile[valleys[i]].values, &best->solution)) {
      best->other_start = true;
    }
  }
}

TexelSearch::Found TexelSearch::FromStart(const TexelObservations& observations,
                                          const TexelPrior& prior, const TexelValues& start) {
  Found best;
  best.solution = solver_.Solve(observations, prior, start);
  best.start_cost = best.solution.start_cost;
  if (!(best.solution.cost < best.start_cost)) {
    best.solution.values = start;
    best.solution.cost = best.start_cost;
  }
  if (starts_ == 1 || !Unexplained(observations.views(), best.solution.cost)) return best;
  TryRoughnesses(observations, prior, best.solution.values, &best);
  if (!Unexplained(observations.views(), best.solution.cost)) return best;
  TexelValues mirror = best.solution.values;
  if (TurnToBrightest(observations, &mirror)) TryRoughnesses(observations, prior, mirror, &best);
  return best;
}

TexelSolution TexelSearch::Improved(const TexelObservations& observations, const TexelPrior& prior,
                                    const TexelValues& values, bool converged) {
  TexelSolution best = solver_.Solve(observations, prior, values, TexelSolver::kNearMinimum);
  if (!(best.cost < best.start_cost)) {
    best.values = values;
    best.cost = best.start_cost;
    best.converged = converged;
  }
  return best;
}

TexelSearch::Found TexelSearch::FromNeighbours(const TexelObservations& observations,
                                               const TexelPrior& prior,
                                               const TexelSolution& current,
                                               std::span<const TexelValues> neighbours) {
  Found best{current, current.cost, false};
  if (!Unexplained(observations.views(), current.cost)) return best;
  double least = kWorthwhile * WithFittedAlbedos(observations, prior, current.values).fit.before;
  Candidate promising;
  bool any = false;
  const auto consider = [&](const TexelValues& values) {
    const Candidate candidate = WithFittedAlbedos(observations, prior, values);
    if (!(candidate.fit.after < least)) return;
    least = candidate.fit.after;
    promising = candidate;
    any = true;
  };
  for (const TexelValues& neighbour : neighbours) {
    TexelValues values = current.values;
    values[kRough] = neighbour[kRough];
    // A roughness as its own would only find the texel's own minimum again.
    if (std::abs(std::log(neighbour[kRough] / current.values[kRough])) > 0.1) consider(values);
    values[kSlopeX] = neighbour[kSlopeX];
    values[kSlopeY] = neighbour[kSlopeY];
    consider(values);
  }
  if (any) best.other_start = TrySolve(observations, prior, promising.values, &best.solution);
  return best;
}

}  // namespace glint
