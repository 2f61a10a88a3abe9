#include "fitting/refine/sample_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "base/model/estimate.h"
#include "base/model/initial_maps.h"
#include "base/model/substances.h"
#include "base/parallel/parallel.h"
#include "fitting/refine/sample_blocks.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

using Matrix9 = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;

Eigen::Map<const Matrix9> InverseOf(const SampledTexel& sampled) {
  return Eigen::Map<const Matrix9>(sampled.inverse.data());
}

// −1 … 1 along each axis.
std::array<double, 2> PlaceOf(const SamplePlane& plane, size_t texel) {
  const int column = static_cast<int>(texel) % plane.width;
  const int row = static_cast<int>(texel) / plane.width;
  return {2 * plane.x_mm(column) / plane.width_mm, 2 * plane.y_mm(row) / plane.height_mm};
}

// Errors of the initialisation: what the estimator's are. Where several photographs tell roughness
// and normals themselves, fitting has shown it the same ones already; what it took from them is not
// to count twice, and roughness and normals, which hold its misfit, are not taken from it at all.
InitialisationErrors ErrorsOfInitialisation(const RefineProblem& problem) {
  InitialisationErrors errors;
  if (problem.views.size() < constants::kLeastValidatedViews) return errors;
  errors.Scale(constants::kSeenAlready);
  errors.normal = errors.roughness = std::numeric_limits<double>::infinity();
  return errors;
}

// What each substance is in the mean of some texels, and of what is expected as if of one more.
class MeanBySubstance {
 public:
  explicit MeanBySubstance(const std::vector<SharedValues>& expected)
      : sums_(expected), weights_(expected.size(), 1) {}

  void Add(const float* shares, const TexelValues& values) {
    const SharedValues shared = SharedOf(values);
    for (size_t k = 0; k < sums_.size(); ++k) {
      weights_[k] += shares[k];
      for (size_t p = 0; p < kShared; ++p) sums_[k][p] += shares[k] * shared[p];
    }
  }

  std::vector<SharedValues> means() const {
    std::vector<SharedValues> means(sums_);
    for (size_t k = 0; k < means.size(); ++k) {
      for (double& value : means[k]) value /= weights_[k];
    }
    return means;
  }

 private:
  std::vector<SharedValues> sums_;
  std::vector<double> weights_;
};

std::vector<SharedValues> InitialMeans(const SamplePart& part) {
  SharedValues whole{};
  for (size_t t = 0; t < part.texels(); ++t) {
    const SharedValues shared = SharedOf(ReadTexel(part.initial(), t));
    for (size_t p = 0; p < kShared; ++p) {
      whole[p] += shared[p] / static_cast<double>(part.texels());
    }
  }
  MeanBySubstance mean(
      std::vector<SharedValues>(static_cast<size_t>(part.substances().count()), whole));
  for (size_t t = 0; t < part.texels(); ++t) {
    mean.Add(part.shares(t), ReadTexel(part.initial(), t));
  }
  return mean.means();
}

// Each photograph has a lamp of its own where something is expected of their gradient.
LampsExpected LampsOf(const RefineProblem& problem, const RefineOptions& options) {
  LampsExpected lamps;
  lamps.gradient = options.lamp_gradient;
  lamps.level = options.level_spread;
  if (!(lamps.gradient > 0)) return lamps;
  for (const RefineView& view : problem.views) {
    const Vec3d& light = view.view.light_in_sample_mm;
    const double distance = std::hypot(light[0], light[1], light[2]);
    lamps.directions.push_back({light[0] / distance, light[1] / distance});
  }
  return lamps;
}

}  // namespace

SampleModel::SampleModel(const SamplePart& part, const RefineOptions& options)
    : part_(&part),
      options_(options),
      all_views_(part.problem().views.size()),
      initial_errors_(ErrorsOfInitialisation(part.problem())),
      lobes_(part.problem().convention.lobes),
      residuals_(part.problem(), {.expected_sigma = options.residual_sigma}),
      measured_residuals_(residuals_),
      has_sample_priors_(part.problem().views.size() > 1),
      normal_spreads_(static_cast<size_t>(part.substances().count()),
                      has_sample_priors_ ? constants::kNormalSd : kUnknownSpread),
      deviations_(
          static_cast<int>(part.problem().views.size()),
          {options.exposure_spread, options.light_spread, options.light_spread},
          {options.flash_offset, options.flash_offset, options.flash_beam, options.flash_beam,
           options.distance_power, options.toe / kToeUnit, options.shoulder},
          LampsOf(part.problem(), options)) {
  std::iota(all_views_.begin(), all_views_.end(), 0);
  means_.mean = InitialMeans(part);
  means_.kinds = options.kinds;
  if (!has_sample_priors_) means_.roughness_spread = means_.specular_spread = kUnknownSpread;
}

SampleModel SampleModel::On(const SamplePart& part) const {
  SampleModel model(*this);
  model.part_ = &part;
  return model;
}

SampleModel::Sampling SampleModel::Sample(size_t most, const SampleSolver& solver,
                                          int threads) const {
  const size_t texels = part_->texels(), count = std::min(most, texels);
  std::vector<size_t> sampled;
  for (size_t i = 0; i < count; ++i) sampled.push_back((2 * i + 1) * texels / (2 * count));
  return SamplingOf(std::move(sampled), solver, threads);
}

SampleModel::Sampling SampleModel::SamplingOf(std::vector<size_t> texels,
                                              const SampleSolver& solver, int threads) const {
  Sampling sampling;
  sampling.texels = std::move(texels);
  sampling.solver = &solver;
  sampling.threads = threads;
  for (const size_t texel : sampling.texels) {
    sampling.solved.emplace_back().values = ReadTexel(part_->initial(), texel);
  }
  TellHalfVectorsApart(&sampling);
  return sampling;
}

void SampleModel::Solve(const SampleRequest& request, Sampling* sampling) const {
  ForEachSampleBlock(sampling->texels.size(), sampling->threads,
                     [&](size_t first, size_t block, int worker) {
                       std::vector<SampleTask> tasks;
                       for (size_t k = first; k < first + block; ++k) {
                         const size_t texel = sampling->texels[k];
                         tasks.push_back({texel, PriorOf(texel), sampling->solved[k].values});
                       }
                       sampling->solver->solve(tasks, request, sampling->first_worker + worker,
                                               std::span(sampling->solved).subspan(first, block));
                     });
}

void SampleModel::Fit(Sampling* sampling) {
  sampling->solver->weigh(residuals_.variance());
  for (int round = 0; round < options_.estimation_rounds; ++round) {
    Solve({.views = all_views_, .of_views = finds_views_}, sampling);
    UpdateSubstances(*sampling);
    if (finds_views_) UpdateDeviations(*sampling);
    if (learns_normals_) UpdateNormalSpreads(*sampling);
    UpdateResiduals(*sampling);
    sampling->solver->weigh(residuals_.variance());
  }
}

void SampleModel::UpdateSubstances(const Sampling& sampling) {
  std::vector<SubstanceSample> samples;
  // Under the prior weight w a texel's marginal information about its mean is w(P − P·wC·P), and
  // the gradient is wP times its departure.
  const double weight = options_.prior;
  const double variance = weight * residuals_.scale() * residuals_.scale();
  for (size_t i = 0; i < sampling.solved.size(); ++i) {
    const SampledTexel& solved = sampling.solved[i];
    if (solved.views == 0) continue;
    const auto inverse = InverseOf(solved);
    SubstanceSample sample;
    sample.shares = part_->shares(sampling.texels[i]);
    sample.value = SharedOf(solved.values);
    for (size_t p = 0; p < kShared; ++p) {
      for (size_t q = 0; q < kShared; ++q) {
        sample.covariance[kShared * p + q] =
            variance * inverse(kSharedParameters[p], kSharedParameters[q]);
      }
    }
    samples.push_back(sample);
  }
  SampleWorth worth = WorthOf(sampling);
  worth.shared_by_half_vector *= weight;
  worth.shared_by_view *= weight;
  UpdateMeans(samples, worth, &means_);
}

// Of half the length scale over which discrepancy stays alike.
SampleModel::HalfVectorCell SampleModel::CellOf(size_t texel, size_t view) const {
  const double cell =
      constants::kHalfVectorCell * residuals_.options().half_vector_deg * std::numbers::pi / 180;
  const RefineProblem& problem = part_->problem();
  const int row = static_cast<int>(texel) / part_->initial().width;
  const int column = static_cast<int>(texel) % part_->initial().width;
  const TexelGeometry<double> g =
      TexelGeometryInView<double>(problem.views[view].view, problem.convention.falloff,
                                  problem.plane.x_mm(column), problem.plane.y_mm(row));
  return {static_cast<int>(std::floor(g.half[0] / cell)),
          static_cast<int>(std::floor(g.half[1] / cell))};
}

// Texels with like half vectors in one view have like ones in all: they are neighbours.
void SampleModel::TellHalfVectorsApart(Sampling* sampling) const {
  std::map<HalfVectorCell, size_t> places;
  std::set<HalfVectorCell> all;
  for (const size_t texel : sampling->texels) {
    const auto place = places.emplace(CellOf(texel, 0), places.size()).first;
    sampling->places.push_back(place->second);
    for (const int view : all_views_) all.insert(CellOf(texel, static_cast<size_t>(view)));
  }
  sampling->place_count = places.size();
  sampling->half_vectors = all.size();
}

// Discrepancy is a function of the half vector, common to a substance: a mean over n texels and
// views has variance q²/n + d²/cells. What is a view's own (registration, exposure) all its texels
// have in common. The estimate itself does without that, which it would count as unknown where much
// of it is found.
SampleWorth SampleModel::WorthOf(const Sampling& sampling) const {
  const double texels = static_cast<double>(sampling.texels.size());
  const auto mean = [](double d, double alike) { return 1 / ((1 - d) + d * alike); };
  const auto by_half_vector = [&](const ResidualModel& residuals) {
    return std::max(
        1.0, texels * residuals.effective_views() / static_cast<double>(sampling.half_vectors));
  };
  const double smooth = residuals_.options().smooth_share;
  return {mean(residuals_.discrepancy_share(), by_half_vector(residuals_)),
          mean(measured_residuals_.discrepancy_share(),
               smooth * by_half_vector(measured_residuals_) + (1 - smooth) * texels)};
}

// MacKay's fixed point ("Bayesian interpolation", Neural Computation 1992): squares over residuals
// less the values that they determine. The belief beside them keeps maps from absorbing what is
// wrong with views while those are found. Once they are, it counts only as far as texels' values
// explain their residuals: wholly where there is one photograph, hardly where there are twenty.
void SampleModel::UpdateResiduals(const Sampling& sampling) {
  const ResidualModelOptions& model = residuals_.options();
  double squares = 0, free = 0, believed = 0;
  for (const SampledTexel& solved : sampling.solved) {
    if (solved.views == 0) continue;
    const auto inverse = InverseOf(solved);
    double determined = kTexelParameters;  // tr (JᵀJ + prior)⁻¹ JᵀJ
    for (int i = 0; i < kTexelParameters; ++i) {
      determined -= inverse(i, i) * solved.prior_diagonal[static_cast<size_t>(i)];
    }
    determined = std::clamp(determined, 0.0, static_cast<double>(kTexelParameters));
    const double seen = 3.0 * solved.views;
    const double belief =
        model.expected_residuals * (finds_views_ ? 1 : std::min(determined / seen, 1.0));
    squares += solved.squares;
    free += std::max(seen - determined, 0.0);
    believed += belief;
  }
  const auto variance = [&](double residuals_believed) {
    const double square = model.expected_sigma * model.expected_sigma;
    return HyperbolicVariance((squares + residuals_believed * square) / (free + residuals_believed),
                              options_.robust_scale);
  };
  if (free + believed > 0) residuals_.SetVariance(variance(believed));
  measured_residuals_ = residuals_;
  if (free > 0) measured_residuals_.SetVariance(variance(0));
}

// Expectation maximisation: the mean square of what is found of normals and of what is left open.
void SampleModel::UpdateNormalSpreads(const Sampling& sampling) {
  const double variance = residuals_.scale() * residuals_.scale();
  const size_t count = normal_spreads_.size();
  std::vector<double> squares(
      count, constants::kNormalSd * constants::kNormalSd * constants::kNormalSdTexels);
  std::vector<double> weights(count, constants::kNormalSdTexels);
  for (size_t i = 0; i < sampling.solved.size(); ++i) {
    const SampledTexel& solved = sampling.solved[i];
    if (solved.views == 0) continue;
    const auto inverse = InverseOf(solved);
    double normal[2];
    NormalOfSlopes(solved.values[kSlopeX], solved.values[kSlopeY], normal);
    double square = 0;
    for (int axis = 0; axis < 2; ++axis) {
      square +=
          0.5 * (normal[axis] * normal[axis] + variance * inverse(kSlopeX + axis, kSlopeX + axis));
    }
    for (size_t k = 0; k < count; ++k) {
      const double share = part_->shares(sampling.texels[i])[k];
      squares[k] += share * square;
      weights[k] += share;
    }
  }
  for (size_t k = 0; k < count; ++k) normal_spreads_[k] = std::sqrt(squares[k] / weights[k]);
}

void SampleModel::UpdateDeviations(const Sampling& sampling) {
  if (!deviations_.any()) return;
  std::vector<TexelOfViews> texels;
  for (size_t i = 0; i < sampling.solved.size(); ++i) {
    const SampledTexel& solved = sampling.solved[i];
    if (solved.views == 0) continue;
    TexelOfViews& texel = texels.emplace_back();
    texel.place = PlaceOf(part_->problem().plane, sampling.texels[i]);
    texel.slope = {solved.values[kSlopeX], solved.values[kSlopeY]};
    texel.inverse = solved.inverse.data();
    texel.products = &solved.of_views;
  }
  const double scale = residuals_.scale();
  deviations_.Update(texels, WorthOf(sampling).shared_by_half_vector / (scale * scale),
                     sampling.threads);
  sampling.solver->deviate(deviations_);
}

void SampleModel::Estimate(const SamplePart* other, const SampleSolver& solver, int threads) {
  Sampling sampling = Sample(constants::kSampledTexels, solver, threads);
  const SampleModel pristine(*this);
  FitNormalsToo(&sampling);
  if (all_views_.size() < constants::kLeastValidatedViews) return;
  const Sampling blocks = SampleBlocks(constants::kSampledTexels, solver, threads);
  ChooseShape(pristine, other, blocks, &sampling);
  FitAsChosen(&sampling);
  MeasureFacets(blocks);
}

void SampleModel::FitNormalsToo(Sampling* sampling) {
  sampling->solver->reflect(lobes_);
  learns_normals_ = has_sample_priors_ && !means_.holds_roughness;
  // The curve moves once all else is near its place: what is wrong at first looks like one.
  HoldCurve(true, *sampling);
  Fit(sampling);
  HoldCurve(false, *sampling);
  if (deviations_.finds_curve()) Fit(sampling);
  learns_normals_ = false;
}

void SampleModel::HoldCurve(bool hold, const Sampling& sampling) {
  deviations_.HoldCurve(hold);
  sampling.solver->deviate(deviations_);
}

// All else once more by what cross-validation chose.
void SampleModel::FitAsChosen(Sampling* sampling) {
  if (deviations_.any()) {
    // Views are found while nothing is known of how far diffuse albedo departs from its substances:
    // its departures are alike in neighbouring texels, and views would be moved to make them even.
    const double chosen = std::exchange(means_.diffuse_spread, kUnknownSpread);
    finds_views_ = true;
    HoldCurve(false, *sampling);
    Fit(sampling);
    FreezeViews(chosen, *sampling);
  }
  Fit(sampling);
}

void SampleModel::ChooseSubstances(const SamplePart* other, const Sampling& sampling,
                                   const Sampling& blocks) {
  if (other == nullptr) return;
  SampleModel model(*this);
  model.part_ = other;
  model.BeginSubstances(sampling);
  Sampling solved = sampling;
  for (int round = 0; round < constants::kOtherSubstanceRounds; ++round) {
    model.Solve({.views = all_views_, .near_minimum = true}, &solved);
    model.UpdateSubstances(solved);
  }
  const double energy = model.CrossValidate(blocks).EnergyAgainst(CrossValidate(blocks));
  if (energy < -constants::kGlossLogOdds) *this = model;
}

void SampleModel::BeginSubstances(const Sampling& sampling) {
  MeanBySubstance mean(InitialMeans(*part_));
  for (size_t k = 0; k < sampling.texels.size(); ++k) {
    if (sampling.solved[k].views == 0) continue;
    mean.Add(part_->shares(sampling.texels[k]), sampling.solved[k].values);
  }
  const double roughness = means_.mean.front()[kSharedRoughness];
  means_.mean = mean.means();
  means_.covariance.clear();
  if (means_.holds_roughness) {
    HoldRoughness(roughness);
    return;
  }
  normal_spreads_.assign(means_.mean.size(), constants::kNormalSd);
  UpdateNormalSpreads(sampling);
}

void SampleModel::FreezeViews(double diffuse_spread, const Sampling& sampling) {
  finds_views_ = false;
  UpdateResiduals(sampling);
  MeanBySubstance mean(InitialMeans(*part_));
  for (size_t k = 0; k < sampling.texels.size(); ++k) {
    if (sampling.solved[k].views == 0) continue;
    mean.Add(part_->shares(sampling.texels[k]), sampling.solved[k].values);
  }
  const std::vector<SharedValues> means = mean.means();
  for (size_t k = 0; k < means.size(); ++k) {
    for (size_t p = kAlikeNearby; p < kShared; ++p) means_.mean[k][p] = means[k][p];
  }
  means_.diffuse_spread = diffuse_spread;
}

void SampleModel::Describe(RefineSummary* summary) const {
  summary->residual_sigma = std::sqrt(residuals_.variance());
  summary->residual_deviation =
      std::sqrt(HyperbolicMeanSquare(residuals_.variance(), options_.robust_scale));
  summary->discrepancy = residuals_.discrepancy();
  summary->effective_views = residuals_.effective_views();
  summary->substances = part_->substances().count();
  summary->lobes = lobes_;
  if (means_.holds_roughness) summary->one_roughness = means_.mean.front()[kSharedRoughness];
  summary->roughness_spread = means_.roughness_spread;
  summary->specular_spread = means_.specular_spread;
  summary->diffuse_spread = means_.diffuse_spread;
  summary->initialisation_error = initial_errors_.diffuse / InitialisationErrors().diffuse;
  summary->neighbour_spread = neighbour_spread_;
  summary->facet_spread = std::sqrt(facet_variance_);
  summary->light_power = has_sample_priors_ ? means_.LightPower() : 1;
  summary->exposure_spread = deviations_.spreads()[kLogExposure];
  summary->light_spread = deviations_.spreads()[kLightAcrossX];
  double squares = 0;
  for (size_t t = 0; t < part_->texels(); ++t) squares += 1 / NormalPrecision(t);
  summary->normal_spread = std::sqrt(squares / static_cast<double>(part_->texels()));
}

}  // namespace glint
