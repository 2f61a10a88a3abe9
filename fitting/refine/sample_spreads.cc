// What texels of a sample differ by, by cross-validation over its photographs.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/parallel/parallel.h"
#include "fitting/refine/neighbours.h"
#include "fitting/refine/sample_model.h"

namespace glint {
namespace {

constexpr int kMostFolds = 7, kFoldRounds = 2;
constexpr size_t kCross = 5;  // a texel and its neighbours

// By which spreads are tried.
constexpr std::array<double, 4> kSpreadFactors = {0.25, 0.5, 1.0, 2.0};
using SpreadErrors = std::array<double, kSpreadFactors.size()>;

// How likely each factor is after cross-validation, sum 1: one that predicts nearly as well as the
// best is nearly as likely. `independent`: residuals in each mean square.
SpreadErrors Likelihoods(const SpreadErrors& error, double independent) {
  const double least = *std::min_element(error.begin(), error.end());
  SpreadErrors likelihoods;
  double sum = 0;
  for (size_t i = 0; i < error.size(); ++i) {
    // Gauss's likelihood of as many residuals, their variance the least that is found.
    sum += likelihoods[i] = std::exp(-0.5 * independent * (error[i] / least - 1));
  }
  for (double& likelihood : likelihoods) likelihood /= sum;
  return likelihoods;
}

// For a spread of texels: to take the likeliest alone would state deviations that are too small.
double FactorOfMeanVariance(const SpreadErrors& likelihoods) {
  double sum = 0;
  for (size_t i = 0; i < likelihoods.size(); ++i) {
    sum += likelihoods[i] * kSpreadFactors[i] * kSpreadFactors[i];
  }
  return std::sqrt(sum);
}

// For what neighbours tell: it is information beside all else that is known of a texel, and
// information is taken at its mean.
double FactorOfMeanPrecision(const SpreadErrors& likelihoods) {
  double sum = 0;
  for (size_t i = 0; i < likelihoods.size(); ++i) {
    sum += likelihoods[i] / (kSpreadFactors[i] * kSpreadFactors[i]);
  }
  return 1 / std::sqrt(sum);
}

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
    model.Fit(fitted, kFoldRounds, false, &part);
    visit(model, part, fitted, held_out);
  }
}

double SampleModel::CrossValidate(const Sampling& sampling) const {
  Prediction sum;
  ForEachFold(sampling, [&](const SampleModel&, const Sampling& part, const std::vector<int>&,
                            const std::vector<int>& held_out) {
    std::vector<Prediction> predictions(part.texels.size());
    ForEachPieceByWorker(
        static_cast<int>(predictions.size()), part.threads, [&](int i, int worker) {
          const size_t k = static_cast<size_t>(i);
          predictions[k] =
              part.solver->predict(part.texels[k], part.solved[k].values, held_out, worker);
        });
    for (const Prediction& p : predictions) sum += p;
  });
  return sum.MeanSquare();
}

void SampleModel::ChooseSpreads(const Sampling& sampling) {
  const double independent = CrossValidatedResiduals(sampling.texels);
  const auto choose = [&](const auto& scale) {
    SpreadErrors error{};
    for (size_t i = 0; i < kSpreadFactors.size(); ++i) {
      SampleModel tried(*this);
      scale(kSpreadFactors[i], &tried);
      error[i] = tried.CrossValidate(sampling);
    }
    scale(FactorOfMeanVariance(Likelihoods(error, independent)), this);
  };
  choose([](double factor, SampleModel* model) {
    model->means_.roughness_spread *= factor;
    model->means_.specular_spread *= factor;
  });
  choose([](double factor, SampleModel* model) {
    for (double& spread : model->normal_spreads_) spread *= factor;
  });
  // Specular albedo once more alone: roughness varies within a substance, and the specular albedo
  // of dielectrics hardly does.
  choose([](double factor, SampleModel* model) { model->means_.specular_spread *= factor; });
}

// Texels are solved once without their neighbours, and the one in the middle of each cross by them
// once more.
void SampleModel::ChooseNeighbourSpread(size_t most, const SampleSolver& solver, int threads) {
  Sampling crosses{{}, {}, &solver, threads};
  std::vector<size_t> centres;  // in crosses.texels, each followed by its neighbours
  for (const size_t texel : Sample(most / kCross, solver, threads).texels) {
    centres.push_back(crosses.texels.size());
    crosses.texels.push_back(texel);
    ForEachNeighbour(texel, part_->initial().width, part_->initial().height,
                     [&](size_t neighbour) { crosses.texels.push_back(neighbour); });
  }
  centres.push_back(crosses.texels.size());
  crosses.solved.resize(crosses.texels.size());
  std::array<Prediction, kSpreadFactors.size()> sums{};
  ForEachFold(crosses, [&](const SampleModel& model, const Sampling& part,
                           const std::vector<int>& fitted, const std::vector<int>& held_out) {
    std::vector<SampleModel> tried(kSpreadFactors.size(), model);
    for (size_t f = 0; f < tried.size(); ++f) tried[f].neighbour_spread_ *= kSpreadFactors[f];
    std::vector<std::array<Prediction, kSpreadFactors.size()>> predictions(centres.size() - 1);
    ForEachPieceByWorker(static_cast<int>(predictions.size()), threads, [&](int i, int worker) {
      const size_t k = static_cast<size_t>(i), texel = part.texels[centres[k]];
      std::vector<Neighbour> neighbours;
      for (size_t n = centres[k] + 1; n < centres[k + 1]; ++n) {
        neighbours.push_back({part.texels[n], part.solved[n].values});
      }
      for (size_t f = 0; f < kSpreadFactors.size(); ++f) {
        TexelGaussian gaussian = tried[f].Knowledge(texel);
        tried[f].MultiplyNeighbours(texel, neighbours, &gaussian);
        const SampledTexel solved = solver.solve(texel, tried[f].Scaled(gaussian),
                                                 part.solved[centres[k]].values, fitted, worker);
        predictions[k][f] = solver.predict(texel, solved.values, held_out, worker);
      }
    });
    for (const auto& p : predictions) {
      for (size_t f = 0; f < kSpreadFactors.size(); ++f) sums[f] += p[f];
    }
  });
  SpreadErrors error;
  for (size_t f = 0; f < kSpreadFactors.size(); ++f) error[f] = sums[f].MeanSquare();
  centres.pop_back();
  for (size_t& centre : centres) centre = crosses.texels[centre];
  neighbour_spread_ *= FactorOfMeanPrecision(Likelihoods(error, CrossValidatedResiduals(centres)));
}

// Residuals that are worth something of their own: those that are not discrepancy, and of
// discrepancy as many as there are half vectors to be told apart, each once and not by channel.
double SampleModel::CrossValidatedResiduals(const std::vector<size_t>& texels) const {
  const double views = static_cast<double>(all_views_.size());
  const double channels =
      3 / (1 + 2 * residuals_.options().channel_correlation * residuals_.discrepancy_share());
  return SampleWorth(texels) * static_cast<double>(texels.size()) * views * channels;
}

}  // namespace glint
