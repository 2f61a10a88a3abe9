// What texels of a sample differ by, by cross-validation over its photographs.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/model/estimate.h"
#include "fitting/refine/neighbours.h"
#include "fitting/refine/sample_blocks.h"
#include "fitting/refine/sample_model.h"
#include "fitting/refine/spread_search.h"

namespace glint {
namespace {

constexpr int kHalves = 2;  // of a checkerboard

}  // namespace

// Blocks on a lattice over the sample, about `most` texels of them.
SampleModel::Sampling SampleModel::SampleBlocks(size_t most, const SampleSolver& solver,
                                                int threads) const {
  const int width = part_->initial().width, height = part_->initial().height;
  const int across = std::min(constants::kBlockSide_texel, width);
  const int down = std::min(constants::kBlockSide_texel, height);
  const double wanted = static_cast<double>(most) / (across * down);
  const auto count = [](double blocks, int of, int side) {
    return std::clamp(static_cast<int>(std::lround(blocks)), 1, of / side);
  };
  const int columns = count(std::sqrt(wanted * width / height), width, across);
  const int rows = count(wanted / columns, height, down);
  // The first of a block's texels, of as many blocks as there can be along that axis.
  const auto begin = [](int block, int blocks, int of, int side) {
    return (2 * block + 1) * (of / side) / (2 * blocks) * side;
  };
  std::vector<size_t> texels;
  for (int block = 0; block < rows * columns; ++block) {
    const int row = begin(block / columns, rows, height, down);
    const int column = begin(block % columns, columns, width, across);
    for (int i = 0; i < across * down; ++i) {
      texels.push_back(static_cast<size_t>(row + i / across) * static_cast<size_t>(width) +
                       static_cast<size_t>(column + i % across));
    }
  }
  Sampling sampling = SamplingOf(std::move(texels), solver, threads);
  FindNeighbours(&sampling);
  return sampling;
}

void SampleModel::FindNeighbours(Sampling* sampling) const {
  std::map<size_t, size_t> sampled;  // its place, by the texel
  for (size_t k = 0; k < sampling->texels.size(); ++k) sampled.emplace(sampling->texels[k], k);
  for (const size_t texel : sampling->texels) {
    std::vector<size_t>& neighbours = sampling->neighbours.emplace_back();
    ForEachNeighbour(texel, part_->initial().width, part_->initial().height, [&](size_t neighbour) {
      const auto found = sampled.find(neighbour);
      if (found != sampled.end()) neighbours.push_back(found->second);
    });
  }
}

// One colour of the checkerboard anew, by those of their neighbours that are sampled too.
void SampleModel::SolveFromNeighbours(const SampleRequest& request, size_t half,
                                      Sampling* sampling) const {
  const size_t across = static_cast<size_t>(part_->initial().width);
  std::vector<size_t> moved;
  for (size_t k = 0; k < sampling->texels.size(); ++k) {
    const size_t texel = sampling->texels[k];
    if ((texel / across + texel % across) % kHalves == half) moved.push_back(k);
  }
  ForEachSampleBlock(moved.size(), sampling->threads, [&](size_t first, size_t block, int worker) {
    std::vector<SampleTask> tasks;
    for (size_t i = first; i < first + block; ++i) {
      const size_t texel = sampling->texels[moved[i]];
      std::vector<Neighbour> neighbours;
      for (const size_t neighbour : sampling->neighbours[moved[i]]) {
        neighbours.push_back({sampling->texels[neighbour], sampling->solved[neighbour].values});
      }
      TexelGaussian gaussian = Knowledge(texel);
      MultiplyNeighbours(texel, neighbours, &gaussian);
      tasks.push_back({texel, Scaled(gaussian, residuals_), sampling->solved[moved[i]].values});
    }
    std::vector<SampledTexel> solved(block);
    sampling->solver->solve(tasks, request, sampling->first_worker + worker, solved);
    for (size_t i = 0; i < block; ++i) {
      sampling->solved[moved[first + i]].values = solved[i].values;
    }
  });
}

// Where exposures deviate, a photograph held out says nothing of its own but how well maps predict
// it after its best factor.
std::vector<double> SampleModel::HeldOutSquares(
    std::span<const ViewDifferences> differences) const {
  return SquaresOf(differences, options_.robust_scale, deviations_.spreads()[kLogExposure] > 0);
}

int SampleModel::Folds() const {
  return std::min(static_cast<int>(all_views_.size()), constants::kMostFolds);
}

std::vector<TexelValues> SampleModel::Search(std::span<const int> views, Sampling* part) const {
  // From what all texels share: solutions of all views remember those held out.
  for (size_t k = 0; k < part->texels.size(); ++k) {
    part->solved[k].values = PriorOf(part->texels[k]).mean();
  }
  Solve({.views = views, .explained_sigma = std::sqrt(residuals_.variance()), .values_alone = true},
        part);
  std::vector<TexelValues> found;
  found.reserve(part->solved.size());
  for (const SampledTexel& solved : part->solved) found.push_back(solved.values);
  return found;
}

std::vector<double> SampleModel::HeldOutSquaresOf(int fold, std::vector<TexelValues>* start,
                                                  Sampling* part) const {
  std::vector<int> fitted, held_out;
  for (const int view : all_views_) {
    (view % Folds() == fold ? held_out : fitted).push_back(view);
  }
  if (start->empty()) *start = Search(fitted, part);
  for (size_t k = 0; k < start->size(); ++k) part->solved[k].values = (*start)[k];
  SampleModel model(*this);
  SampleRequest request = {.views = fitted, .near_minimum = true};
  model.Solve(request, part);
  model.UpdateSubstances(*part);
  request.values_alone = true;
  model.Solve(request, part);
  for (size_t half = 0; half < kHalves; ++half) model.SolveFromNeighbours(request, half, part);
  std::vector<ViewDifferences> differences(part->texels.size());
  ForEachSampleBlock(differences.size(), part->threads,
                     [&](size_t first, size_t count, int worker) {
                       std::vector<TexelValues> values;
                       for (size_t k = first; k < first + count; ++k)
                         values.push_back(part->solved[k].values);
                       part->solver->predict(std::span(part->texels).subspan(first, count), values,
                                             held_out, part->first_worker + worker,
                                             std::span(differences).subspan(first, count));
                     });
  return HeldOutSquares(differences);
}

HeldOutErrors SampleModel::CrossValidate(const Sampling& sampling) const {
  FoldStarts starts;
  return CrossValidate(sampling, {}, &starts);
}

// Every other fold first: views stand in the order of their places, and half of the folds are to be
// of views all around.
int SampleModel::FoldAt(int place) const {
  const int half = HalfOfFolds();
  return place < half ? 2 * place : 2 * (place - half) + 1;
}

// As many folds at a time as there are threads; those left over share the threads.
std::vector<std::vector<double>> SampleModel::HeldOutSquaresOfFolds(const Sampling& sampling,
                                                                    int first_fold, int folds,
                                                                    FoldStarts* starts) const {
  std::vector<std::vector<double>> squares(static_cast<size_t>(folds));
  const auto validate = [&](int first, int count) {
    const int threads_of_fold = std::max(1, sampling.threads / count);
    ForEachPieceByWorker(count, std::min(sampling.threads, count), [&](int piece, int worker) {
      const int place = first + piece, fold = FoldAt(first_fold + place);
      Sampling part = sampling;
      part.threads = threads_of_fold;
      part.first_worker = worker * threads_of_fold;
      squares[static_cast<size_t>(place)] =
          HeldOutSquaresOf(fold, &(*starts)[static_cast<size_t>(fold)], &part);
    });
  };
  const int left_over = folds % sampling.threads;
  if (folds > left_over) validate(0, folds - left_over);
  if (left_over > 0) validate(folds - left_over, left_over);
  return squares;
}

HeldOutErrors SampleModel::CrossValidate(const Sampling& sampling, const GiveUp& give_up,
                                         FoldStarts* starts) const {
  sampling.solver->reflect(lobes_);
  starts->resize(static_cast<size_t>(Folds()));
  HeldOutErrors errors(sampling.place_count);
  const auto add = [&](int first, int folds) {
    for (const auto& of_fold : HeldOutSquaresOfFolds(sampling, first, folds, starts)) {
      errors.BeginFold();
      for (size_t k = 0; k < of_fold.size(); ++k) errors.Add(sampling.places[k], of_fold[k]);
    }
  };
  const int first = give_up ? HalfOfFolds() : Folds();
  add(0, first);
  if (first < Folds() && !give_up(errors)) add(first, Folds() - first);
  return errors;
}

SampleModel SampleModel::ScaledBy(const SpreadFactors& factors) const {
  SampleModel model(*this);
  model.means_.roughness_spread *= factors[kRoughnessSpread];
  model.means_.specular_spread *= factors[kSpecularSpread];
  model.means_.diffuse_spread *= factors[kDiffuseSpread];
  for (double& spread : model.normal_spreads_) spread *= factors[kNormalSpread];
  model.initial_errors_.Scale(factors[kInitialisationError]);
  model.neighbour_spread_ *= factors[kNeighbourSpread];
  return model;
}

SpreadPowers SampleModel::ChooseSpreads(const Sampling& sampling, const SpreadPowers& from) {
  FoldStarts starts;
  const auto tried = SearchSpreads(
      [&](const SpreadPowers& powers, const GiveUp& give_up) {
        SpreadFactors factors;
        for (size_t i = 0; i < kSpreadKinds; ++i) factors[i] = std::exp2(powers[i]);
        return ScaledBy(factors).CrossValidate(sampling, give_up, &starts);
      },
      from);
  *this = ScaledBy(ProbableFactors(tried));
  return tried.front().powers;
}

}  // namespace glint
