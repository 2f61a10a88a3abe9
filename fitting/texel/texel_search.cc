#include "fitting/texel/texel_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

// Roughnesses to look at: steps of 1.4, about the width of the valley in which one solve converges.
constexpr std::array<double, 8> kRoughnesses = {0.07, 0.10, 0.14, 0.20, 0.28, 0.39, 0.55, 0.77};

// Another start is worth a solve when it promises this much less cost; solutions that differ by
// less are the same for every practical purpose.
constexpr double kWorthwhile = 0.98;
constexpr double kWorthStep = 0.05;  // gain of a step against one residual's noise
constexpr double kExplained = 1.5;   // squared residuals against noise alone

}  // namespace

TexelSearch::TexelSearch(const KernelOptions& options, int most_iterations, int most_views,
                         int starts)
    : options_(options),
      starts_(starts),
      solver_(options, most_iterations, most_views),
      rows_(most_views) {}

void TexelSearch::SetNoise(double residual_sigma) {
  variance_ = residual_sigma * residual_sigma;
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
                                 Found* best) {
  const auto fit = [&](double roughness) {
    TexelValues values = best->solution.values;
    values[kRough] = roughness;
    return WithFittedAlbedos(observations, prior, values);
  };
  // The profile over roughness, with the solution's own in its place.
  constexpr int kProfile = static_cast<int>(kRoughnesses.size()) + 1;
  std::array<Candidate, kProfile> profile;
  const double own = best->solution.values[kRough];
  double own_squares = 0.0;
  int filled = 0;
  for (size_t i = 0; i <= kRoughnesses.size(); ++i) {
    const bool own_is_next =
        filled == static_cast<int>(i) && (i == kRoughnesses.size() || own <= kRoughnesses[i]);
    if (own_is_next) {
      profile[filled++] = fit(own);
      own_squares = profile[filled - 1].fit.before;
    }
    if (i < kRoughnesses.size()) profile[filled++] = fit(kRoughnesses[i]);
  }

  // Its valleys that promise less than the solution has.
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
  if (starts_ > 1 && Unexplained(observations.views(), best.solution.cost)) {
    TryRoughnesses(observations, prior, &best);
  }
  return best;
}

TexelSolution TexelSearch::Improved(const TexelObservations& observations, const TexelPrior& prior,
                                    const TexelSolution& current) {
  TexelSolution best = current;
  TrySolve(observations, prior, current.values, &best);
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
