// What texels of a sample differ by, by cross-validation over its photographs.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "fitting/refine/neighbours.h"
#include "fitting/refine/sample_blocks.h"
#include "fitting/refine/sample_model.h"
#include "fitting/refine/spread_search.h"

namespace glint {
namespace {

constexpr int kMostFolds = 7;
constexpr size_t kCross = 5;  // a texel and its neighbours

// By which what neighbours differ by is tried.
constexpr std::array<double, 4> kNeighbourFactors = {0.25, 0.5, 1.0, 2.0};

}  // namespace

template <class Visit>
void SampleModel::ForEachFold(const Sampling& sampling, const Visit& visit) const {
  const int views = static_cast<int>(all_views_.size()), folds = std::min(views, kMostFolds);
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<int> fitted, held_out;
    for (int v = 0; v < views; ++v) (v % folds == fold ? held_out : fitted).push_back(v);
    SampleModel model(*this);
    Sampling part = sampling;
    // From what all texels share: solutions of all views remember those held out.
    for (size_t k = 0; k < part.texels.size(); ++k) {
      part.solved[k].values = PriorOf(part.texels[k]).mean();
    }
    const double explained = std::sqrt(residuals_.variance());
    model.Solve({.views = fitted, .explained_sigma = explained}, &part);
    model.UpdateSubstances(part);
    model.Solve(
        {.views = fitted, .near_minimum = true, .explained_sigma = explained, .values_alone = true},
        &part);
    visit(model, part, fitted, held_out);
  }
}

// Where exposures deviate, a photograph held out says nothing of its own but how well maps predict
// it after its best factor.
std::vector<double> SampleModel::HeldOutSquares(
    std::span<const ViewDifferences> differences) const {
  return SquaresOf(differences, options_.robust_scale, deviations_.spreads()[kLogExposure] > 0);
}

HeldOutErrors SampleModel::CrossValidate(const Sampling& sampling) const {
  HeldOutErrors errors(sampling.place_count);
  std::vector<ViewDifferences> differences(sampling.texels.size());
  ForEachFold(sampling, [&](const SampleModel&, const Sampling& part, const std::vector<int>&,
                            const std::vector<int>& held_out) {
    ForEachSampleBlock(differences.size(), part.threads, [&](size_t first, size_t count, int worker) {
      std::vector<TexelValues> values;
      for (size_t k = first; k < first + count; ++k) values.push_back(part.solved[k].values);
      part.solver->predict(std::span(part.texels).subspan(first, count), values, held_out, worker,
                           std::span(differences).subspan(first, count));
    });
    errors.BeginFold();
    const std::vector<double> squares = HeldOutSquares(differences);
    for (size_t k = 0; k < squares.size(); ++k) errors.Add(part.places[k], squares[k]);
  });
  return errors;
}

SampleModel SampleModel::ScaledBy(const SpreadFactors& factors) const {
  SampleModel model(*this);
  model.means_.roughness_spread *= factors[kRoughnessSpread];
  model.means_.specular_spread *= factors[kSpecularSpread];
  model.means_.diffuse_spread *= factors[kDiffuseSpread];
  for (double& spread : model.normal_spreads_) spread *= factors[kNormalSpread];
  model.initial_errors_.Scale(factors[kInitialisationError]);
  return model;
}

void SampleModel::ChooseSpreads(const Sampling& sampling) {
  const auto tried = SearchSpreads([&](const SpreadPowers& powers) {
    SpreadFactors factors;
    for (size_t i = 0; i < kSpreadKinds; ++i) factors[i] = std::exp2(powers[i]);
    return ScaledBy(factors).CrossValidate(sampling);
  });
  *this = ScaledBy(ProbableFactors(tried));
}

// Texels are solved once without their neighbours, and the one in the middle of each cross by them
// once more.
void SampleModel::ChooseNeighbourSpread(size_t most, const SampleSolver& solver, int threads) {
  const Sampling middles = Sample(most / kCross, solver, threads);
  std::vector<size_t> texels, centres;  // of texels, each followed by its neighbours
  for (const size_t texel : middles.texels) {
    centres.push_back(texels.size());
    texels.push_back(texel);
    ForEachNeighbour(texel, part_->initial().width, part_->initial().height,
                     [&](size_t neighbour) { texels.push_back(neighbour); });
  }
  centres.push_back(texels.size());
  const Sampling crosses = SamplingOf(std::move(texels), solver, threads);
  const size_t count = kNeighbourFactors.size();
  std::vector<HeldOutErrors> errors(count, HeldOutErrors(crosses.place_count));
  ForEachFold(crosses, [&](const SampleModel& model, const Sampling& part,
                           const std::vector<int>& fitted, const std::vector<int>& held_out) {
    std::vector<SampleModel> tried(count, model);
    for (size_t f = 0; f < count; ++f) tried[f].neighbour_spread_ *= kNeighbourFactors[f];
    const size_t crosses_count = centres.size() - 1;
    std::vector<std::vector<ViewDifferences>> differences(
        count, std::vector<ViewDifferences>(crosses_count));
    ForEachSampleBlock(crosses_count, threads, [&](size_t first, size_t block, int worker) {
      for (size_t f = 0; f < count; ++f) {
        const SampleModel& one = tried[f];
        std::vector<SampleTask> tasks;
        std::vector<size_t> middles_texels;
        for (size_t k = first; k < first + block; ++k) {
          const size_t texel = part.texels[centres[k]];
          std::vector<Neighbour> neighbours;
          for (size_t n = centres[k] + 1; n < centres[k + 1]; ++n) {
            neighbours.push_back({part.texels[n], part.solved[n].values});
          }
          TexelGaussian gaussian = one.Knowledge(texel);
          one.MultiplyNeighbours(texel, neighbours, &gaussian);
          tasks.push_back(
              {texel, one.Scaled(gaussian, residuals_), part.solved[centres[k]].values});
          middles_texels.push_back(texel);
        }
        std::vector<SampledTexel> solved(block);
        solver.solve(tasks, {.views = fitted, .near_minimum = true}, worker, solved);
        std::vector<TexelValues> values;
        values.reserve(block);
        for (const SampledTexel& texel : solved) values.push_back(texel.values);
        solver.predict(middles_texels, values, held_out, worker,
                       std::span(differences[f]).subspan(first, block));
      }
    });
    for (size_t f = 0; f < count; ++f) {
      errors[f].BeginFold();
      const std::vector<double> squares = HeldOutSquares(differences[f]);
      for (size_t k = 0; k < crosses_count; ++k) {
        errors[f].Add(part.places[centres[k]], squares[k]);
      }
    }
  });
  // Information beside all else that is known of a texel is taken at its mean.
  neighbour_spread_ *= FactorOfMeanPrecision(kNeighbourFactors, errors);
}

}  // namespace glint
