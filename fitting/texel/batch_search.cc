#include "fitting/texel/batch_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/model/solver.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/texel/texel_albedos.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

using kernel::BatchSolution;
using kernel::LaneBits;
using kernel::Solving;

bool Has(LaneBits lanes, int lane) { return (lanes >> lane & 1u) != 0; }

template <class Visit>
void ForEachLane(LaneBits lanes, const Visit& visit) {
  for (int lane = 0; lane < kBatch; ++lane) {
    if (Has(lanes, lane)) visit(lane);
  }
}

double ObservedAt(const BatchObservations& observations, int lane, int view, int plane) {
  return observations.rows()[view * BatchObservations::kPlanes + plane][lane];
}

// Turns the normal so that it mirrors the light into the camera of the view in which the texel is
// brightest for the light it receives. A normal far from the true one has no slope toward it where
// the lobe is narrow: the highlight is either missed or explained by diffuse light.
bool TurnToBrightest(const BatchObservations& observations, int lane, TexelValues* values) {
  using Obs = BatchObservations;
  const auto at = [&](int view, int plane) { return ObservedAt(observations, lane, view, plane); };
  int brightest = -1;
  double most = 0;
  for (int v = 0; v < observations.views(); ++v) {
    if (!(at(v, Obs::kWeight) > 0)) continue;
    double reflected = 0;
    for (int c = 0; c < 3; ++c) {
      const double irradiance = at(v, Obs::kIrradiance + c);
      const double radiance = 1 / at(v, Obs::kInverseTarget + c) - kLogOffset;
      if (irradiance > 0) reflected += radiance / irradiance;
    }
    if (reflected > most) {
      most = reflected;
      brightest = v;
    }
  }
  if (brightest < 0) return false;
  double half[3];
  for (int i = 0; i < 3; ++i) {
    half[i] = (at(brightest, Obs::kLightX + i) + at(brightest, Obs::kCameraX + i)) *
              at(brightest, Obs::kHalfInverse);
  }
  if (!(half[2] > 1 / kMostSlope)) return false;
  (*values)[kSlopeX] = half[0] / half[2];
  (*values)[kSlopeY] = half[1] / half[2];
  return true;
}

// Turns the normal to the one whose shading the views show, were there diffuse light alone
// (photometric stereo, Woodham 1980), differences weighed as the logarithm weighs them. Where a
// surface is steep a level normal explains shading by a wide specular lobe without diffuse light,
// and stays there.
bool TurnToShading(const BatchObservations& observations, int lane, TexelValues* values) {
  using Obs = BatchObservations;
  const auto at = [&](int view, int plane) { return ObservedAt(observations, lane, view, plane); };
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d seen = Eigen::Vector3d::Zero();
  for (int v = 0; v < observations.views(); ++v) {
    if (!(at(v, Obs::kWeight) > 0)) continue;
    const Eigen::Vector3d light(at(v, Obs::kLightX), at(v, Obs::kLightY), at(v, Obs::kLightZ));
    for (int c = 0; c < 3; ++c) {
      const double weight = at(v, Obs::kIrradiance + c) * at(v, Obs::kInverseTarget + c);
      const double relative = 1 - kLogOffset * at(v, Obs::kInverseTarget + c);
      information += weight * weight * light * light.transpose();
      seen += weight * relative * light;
    }
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(information);
  if (solver.rcond() < constants::kLeastShadingRcond) return false;
  const Eigen::Vector3d normal = solver.solve(seen);
  if (!(normal.z() > normal.norm() / kMostSlope)) return false;
  (*values)[kSlopeX] = normal.x() / normal.z();
  (*values)[kSlopeY] = normal.y() / normal.z();
  return true;
}

}  // namespace

BatchEvaluator::BatchEvaluator(const KernelOptions& options, int most_views)
    : options_(options),
      kernel_(kernel::BatchKernelFor(BestInstructionSet())),
      scratch_(static_cast<size_t>(most_views) * kernel::BatchViews::kScratchRows) {}

void BatchEvaluator::SetLobes(const SpecularLobes& lobes) {
  options_.mix = LobeMixOf<float>(lobes);
}

kernel::BatchViews BatchEvaluator::ViewsOf(const BatchObservations& observations) {
  return {observations.rows(), observations.views(), scratch_.data()};
}

void BatchEvaluator::Gram(const BatchObservations& observations, const BatchValues& values,
                          BatchGram* gram, BatchResiduals* residuals) {
  kernel_.gram(options_, ViewsOf(observations), values, gram,
               residuals != nullptr ? residuals->rows() : nullptr);
}

void BatchEvaluator::Inverse(const BatchGram& photographs, const BatchPrior& prior,
                             const BatchValues& values, double least, BatchInverse* inverse) {
  kernel_.inverse(photographs, prior, values, static_cast<float>(least), inverse);
}

void BatchEvaluator::Solve(const kernel::SolveOptions& solve, const BatchObservations& observations,
                           const BatchPrior& prior, LaneBits active, Solving how,
                           BatchSolution* solution) {
  kernel_.solve(options_, solve, ViewsOf(observations), prior, active, how, solution);
}

void BatchEvaluator::AlbedoSums(const BatchObservations& observations, const BatchValues& values,
                                BatchAlbedoSums* sums) {
  kernel_.albedo_sums(options_, ViewsOf(observations), values, sums);
}

BatchSearch::BatchSearch(const KernelOptions& options, int most_iterations, int most_views,
                         int starts)
    : evaluator_(options, most_views),
      starts_(starts),
      first_(most_views),
      slow_(most_views),
      second_(most_views) {
  solve_.most_iterations = most_iterations;
}

void BatchSearch::SetNoise(double residual_sigma) {
  SetExplained(residual_sigma);
  solve_.squares_tolerance =
      std::max(static_cast<float>(constants::kWorthStep * variance_), constants::kSquaresTolerance);
}

int BatchSearch::Batch::FreeLane() const { return std::countr_one(taken); }

void BatchSearch::Batch::Take(const Batch& from, int lane) {
  if (taken == 0) buffer.Clear(from.observations().views());
  const int to = FreeLane();
  buffer.CopyLane(from.observations(), lane, to);
  prior.CopyLane(from.prior, lane, to);
  solution.CopyLane(from.solution, lane, to);
  tasks[static_cast<size_t>(to)] = from.tasks[static_cast<size_t>(lane)];
  found[static_cast<size_t>(to)] = from.found[static_cast<size_t>(lane)];
  taken |= 1u << to;
}

void BatchSearch::Begin(From from, Gather gather, Done done) {
  from_ = from;
  solve_.damping = from == From::kStart ? constants::kFarDamping : constants::kNearDamping;
  gather_ = std::move(gather);
  done_ = std::move(done);
  first_.taken = slow_.taken = second_.taken = 0;
}

void BatchSearch::Add(const Task& task) {
  const int lane = first_.FreeLane();
  first_.tasks[static_cast<size_t>(lane)] = task;
  first_.taken |= 1u << lane;
  if (first_.full()) RunFirst();
}

void BatchSearch::Finish() {
  RunFirst();
  RunSlow(Solving::kFinish);
  RunSecond();
}

bool BatchSearch::Unexplained(const Batch& batch, int lane) const {
  const double cost = batch.found[static_cast<size_t>(lane)].solution.cost;
  return 2.0 * cost > constants::kExplained * variance_ * 3.0 * batch.observations().seen(lane);
}

void BatchSearch::RunFirst() {
  if (first_.taken == 0) return;
  std::array<size_t, kBatch> ids;
  size_t count = 0;
  ForEachLane(first_.taken, [&](int lane) {
    const Task& task = first_.tasks[static_cast<size_t>(lane)];
    ids[count++] = task.id;
    first_.prior.SetLane(lane, task.prior);
    SetLane(lane, task.start, &first_.solution.values);
  });
  first_.seen = gather_(std::span(ids).first(count), &first_.buffer);
  evaluator_.Solve(solve_, first_.observations(), first_.prior, first_.taken, Solving::kBegin,
                   &first_.solution);
  ForEachLane(first_.taken, [&](int lane) {
    if (Has(first_.solution.finished, lane)) {
      Conclude(&first_, lane);
    } else {
      slow_.Take(first_, lane);
      if (slow_.full()) RunSlow(Solving::kContinue);
    }
  });
  first_.taken = 0;
}

void BatchSearch::RunSlow(Solving how) {
  if (slow_.taken == 0) return;
  evaluator_.Solve(solve_, slow_.observations(), slow_.prior, slow_.taken, how, &slow_.solution);
  ForEachLane(slow_.taken & slow_.solution.finished, [&](int lane) {
    Conclude(&slow_, lane);
    slow_.taken &= ~(1u << lane);
  });
}

void BatchSearch::Conclude(Batch* batch, int lane) {
  const Task& task = batch->tasks[static_cast<size_t>(lane)];
  const BatchSolution& solved = batch->solution;
  Found& found = batch->found[static_cast<size_t>(lane)];
  found.views = batch->observations().seen(lane);
  found.other_start = false;
  TexelSolution& solution = found.solution;
  solution = {ValuesOfLane(lane, solved.values), solved.start_cost[lane], solved.cost[lane],
              Has(solved.converged, lane)};
  if (found.views == 0 || !(solution.cost < solution.start_cost)) {
    solution.values = task.start;
    solution.cost = solution.start_cost;
    if (from_ != From::kStart) solution.converged = task.converged;
  }
  const bool others = from_ == From::kStart ? starts_ > 1 : from_ == From::kNeighbours;
  if (!others || found.views == 0 || !Unexplained(*batch, lane)) {
    done_(task, found);
    return;
  }
  second_.Take(*batch, lane);
  if (second_.full()) RunSecond();
}

void BatchSearch::RunSecond() {
  if (second_.taken == 0) return;
  if (from_ == From::kStart) {
    TryOtherStarts();
  } else {
    TryNeighbours();
  }
  ForEachLane(second_.taken, [&](int lane) {
    done_(second_.tasks[static_cast<size_t>(lane)], second_.found[static_cast<size_t>(lane)]);
  });
  second_.taken = 0;
}

LaneBits BatchSearch::UnexplainedOf(LaneBits lanes) const {
  LaneBits unexplained = 0;
  ForEachLane(lanes, [&](int lane) {
    if (Unexplained(second_, lane)) unexplained |= 1u << lane;
  });
  return unexplained;
}

void BatchSearch::FitAlbedosOf(LaneBits lanes, Candidates* candidates) {
  BatchValues values;
  ForEachLane(lanes, [&](int lane) {
    SetLane(lane, (*candidates)[static_cast<size_t>(lane)].values, &values);
  });
  BatchAlbedoSums sums;
  evaluator_.AlbedoSums(second_.observations(), values, &sums);
  ForEachLane(lanes, [&](int lane) {
    Candidate& candidate = (*candidates)[static_cast<size_t>(lane)];
    const TexelPrior& prior = second_.tasks[static_cast<size_t>(lane)].prior;
    // What the prior says of normal and roughness; of albedos, it is in the fit.
    TexelValues rest = candidate.values;
    std::copy_n(prior.mean().begin() + kAlbedos, static_cast<int>(kRough), rest.begin() + kAlbedos);
    const double prior_squares = prior.SquaredNorm(rest);
    double prior_weights[kRough];
    for (int i = 0; i < kRough; ++i) prior_weights[i] = prior.weight(i);
    AlbedoSums of_lane[3];
    for (int c = 0; c < 3; ++c) of_lane[c] = sums.Of(c, lane);
    const AlbedoFit fit = FitAlbedos(of_lane, evaluator_.options().diffuse_weight, prior_weights,
                                     prior.mean(), &candidate.values);
    candidate.before = fit.before + prior_squares;
    candidate.after = fit.after + prior_squares;
  });
}

void BatchSearch::TrySolve(LaneBits lanes, const Candidates& from) {
  if (lanes == 0) return;
  BatchSolution solution;
  ForEachLane(lanes, [&](int lane) {
    SetLane(lane, from[static_cast<size_t>(lane)].values, &solution.values);
  });
  kernel::SolveOptions solve = solve_;
  solve.damping = constants::kFarDamping;
  evaluator_.Solve(solve, second_.observations(), second_.prior, lanes, Solving::kBegin, &solution);
  evaluator_.Solve(solve, second_.observations(), second_.prior, lanes & ~solution.finished,
                   Solving::kFinish, &solution);
  ForEachLane(lanes, [&](int lane) {
    Found& best = second_.found[static_cast<size_t>(lane)];
    if (!(solution.cost[lane] < best.solution.cost)) return;
    best.other_start = true;
    best.solution.values = ValuesOfLane(lane, solution.values);
    best.solution.cost = solution.cost[lane];
    best.solution.converged = Has(solution.converged, lane);
  });
}

// From `from` with other roughnesses: the valleys of the profile over them, with the one each comes
// from in its place, that promise less than the solution has.
void BatchSearch::TryRoughnesses(LaneBits lanes, const std::array<TexelValues, kBatch>& from) {
  constexpr size_t kProfile = constants::kTriedRoughnesses.size() + 1;
  std::array<Candidates, kProfile> profile;
  ForEachLane(lanes, [&](int lane) {
    const size_t i = static_cast<size_t>(lane);
    std::array<double, kProfile> roughnesses;
    std::copy(constants::kTriedRoughnesses.begin(), constants::kTriedRoughnesses.end(),
              roughnesses.begin());
    roughnesses.back() = from[i][kRough];
    std::sort(roughnesses.begin(), roughnesses.end());
    for (size_t p = 0; p < kProfile; ++p) {
      profile[p][i].values = from[i];
      profile[p][i].values[kRough] = roughnesses[p];
    }
  });
  for (Candidates& candidates : profile) FitAlbedosOf(lanes, &candidates);
  Candidates own;
  for (size_t i = 0; i < own.size(); ++i) own[i].values = second_.found[i].solution.values;
  FitAlbedosOf(lanes, &own);

  std::array<std::array<size_t, kProfile>, kBatch> valleys;
  std::array<int, kBatch> counts{};
  ForEachLane(lanes, [&](int lane) {
    const size_t i = static_cast<size_t>(lane);
    for (size_t p = 0; p < kProfile; ++p) {
      const double here = profile[p][i].after;
      const bool valley = (p == 0 || here <= profile[p - 1][i].after) &&
                          (p + 1 == kProfile || here < profile[p + 1][i].after);
      if (valley && here < constants::kWorthwhile * own[i].before) {
        valleys[i][static_cast<size_t>(counts[i]++)] = p;
      }
    }
    std::stable_sort(valleys[i].begin(), valleys[i].begin() + counts[i],
                     [&](size_t a, size_t b) { return profile[a][i].after < profile[b][i].after; });
  });
  for (int k = 0; k < starts_ - 1; ++k) {
    Candidates starts;
    LaneBits having = 0;
    ForEachLane(lanes, [&](int lane) {
      const size_t i = static_cast<size_t>(lane);
      if (counts[i] <= k) return;
      having |= 1u << lane;
      starts[i] = profile[valleys[i][static_cast<size_t>(k)]][i];
    });
    TrySolve(having, starts);
  }
}

// From what is known of the texel beforehand: a start may lie far from where all other texels of
// its substance do.
void BatchSearch::TryPriorMeans() {
  Candidates means;
  LaneBits others = 0;
  ForEachLane(second_.taken, [&](int lane) {
    const size_t i = static_cast<size_t>(lane);
    const Task& task = second_.tasks[i];
    TexelValues& mean = means[i].values = task.start;
    for (int p = 0; p < kTexelParameters; ++p) {
      if (task.prior.weight(p) > 0) mean[p] = task.prior.mean()[p];
    }
    if (mean != task.start) others |= 1u << lane;
  });
  TrySolve(others, means);
}

void BatchSearch::TryOtherStarts() {
  TryPriorMeans();
  const LaneBits all = UnexplainedOf(second_.taken);
  std::array<TexelValues, kBatch> from;
  for (size_t i = 0; i < from.size(); ++i) from[i] = second_.found[i].solution.values;
  if (all != 0) TryRoughnesses(all, from);
  for (const auto& turn : {TurnToBrightest, TurnToShading}) {
    LaneBits turned = 0;
    ForEachLane(UnexplainedOf(all), [&](int lane) {
      const size_t i = static_cast<size_t>(lane);
      from[i] = second_.found[i].solution.values;
      if (turn(second_.observations(), lane, &from[i])) turned |= 1u << lane;
    });
    if (turned != 0) TryRoughnesses(turned, from);
  }
}

void BatchSearch::TryNeighbours() {
  const LaneBits all = second_.taken;
  Candidates own, promising;
  for (size_t i = 0; i < own.size(); ++i) own[i].values = second_.found[i].solution.values;
  FitAlbedosOf(all, &own);
  LaneBits any = 0;
  const auto consider = [&](LaneBits lanes, Candidates* candidates) {
    FitAlbedosOf(lanes, candidates);
    ForEachLane(lanes, [&](int lane) {
      const size_t i = static_cast<size_t>(lane);
      const double least =
          Has(any, lane) ? promising[i].after : constants::kWorthwhile * own[i].before;
      if (!((*candidates)[i].after < least)) return;
      promising[i] = (*candidates)[i];
      any |= 1u << lane;
    });
  };
  for (int n = 0; n < 4; ++n) {
    LaneBits lanes = 0, rougher = 0;
    Candidates roughness, normal_too;
    ForEachLane(all, [&](int lane) {
      const size_t i = static_cast<size_t>(lane);
      const Task& task = second_.tasks[i];
      if (n >= task.neighbour_count) return;
      const TexelValues& neighbour = task.neighbours[static_cast<size_t>(n)];
      const TexelValues& current = second_.found[i].solution.values;
      lanes |= 1u << lane;
      // A roughness as its own would only find the texel's own minimum again.
      const double ratio = neighbour[kRough] / current[kRough];
      if (std::abs(std::log(ratio)) > constants::kOtherRoughness) rougher |= 1u << lane;
      roughness[i].values = current;
      roughness[i].values[kRough] = neighbour[kRough];
      normal_too[i].values = roughness[i].values;
      normal_too[i].values[kSlopeX] = neighbour[kSlopeX];
      normal_too[i].values[kSlopeY] = neighbour[kSlopeY];
    });
    if (rougher != 0) consider(rougher, &roughness);
    if (lanes != 0) consider(lanes, &normal_too);
  }
  TrySolve(any, promising);
}

}  // namespace glint
