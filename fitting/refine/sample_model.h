// What is estimated of a sample as a whole before its texels are solved, and the priors that follow
// for each of them: docs/model.md.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/model/estimate.h"
#include "base/model/substances.h"
#include "fitting/refine/confidence.h"
#include "fitting/refine/held_out_errors.h"
#include "fitting/refine/refine.h"
#include "fitting/refine/residual_model.h"
#include "fitting/refine/sample_part.h"
#include "fitting/refine/spread_search.h"
#include "fitting/refine/substances.h"
#include "fitting/refine/view_deviations.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

// A texel at its most probable values under the model as it is.
struct SampledTexel {
  int views = 0;  // 0: nothing is seen of it
  TexelValues values{};
  double squares = 0;  // squared residuals g² of the photographs alone
  // (JᵀJ + prior)⁻¹ by the physical values, row-major, in units of the residuals' scale⁻² …
  std::array<double, kTexelParameters * kTexelParameters> inverse{};
  std::array<double, kTexelParameters> prior_diagonal{};  // … and the prior's part before inversion
  std::vector<DeviationProducts> of_views;  // where deviations of views are looked for
};

// A texel to be solved.
struct SampleTask {
  size_t texel = 0;
  TexelPrior prior;
  TexelValues from{};
};

using ReliefSlope = std::array<float, 2>;  // n_x/n_z, n_y/n_z

// How sampled texels are to be solved.
struct SampleRequest {
  std::span<const int> views;  // those to take
  bool near_minimum = false;   // `from` is next to one: no other starts
  double explained_sigma = 0;  // other starts where residuals are larger
  bool values_alone = false;   // nothing else of SampledTexel is wanted
  bool of_views = false;       // SampledTexel::of_views are wanted
};

// What SampleModel asks of the texels' solver; called from several threads, `worker` below their
// number.
struct SampleSolver {
  std::function<void(std::span<const SampleTask> tasks, const SampleRequest& request, int worker,
                     std::span<SampledTexel> solved)>
      solve;
  // By what each texel's rendering differs from its photographs in those views.
  std::function<void(std::span<const size_t> texels, std::span<const TexelValues> values,
                     std::span<const int> views, int worker,
                     std::span<ViewDifferences> differences)>
      predict;
  // From now on views deviate so from what is said of them.
  std::function<void(const ViewDeviations& deviations)> deviate;
  // From now on residuals have this variance, beside what views hide.
  std::function<void(double variance)> weigh;
  // From now on the sample has these specular lobes.
  std::function<void(const SpecularLobes& lobes)> reflect;
};

class SampleModel {
 public:
  // `part` must outlive this, or what On() gave.
  SampleModel(const SamplePart& part, const RefineOptions& options);
  // What has been estimated, for other texels of the sample.
  SampleModel On(const SamplePart& part) const;

  // From sampled texels: substances' means and the residuals' variance by type-II maximum
  // likelihood; spreads by cross-validation over the photographs, from three on, and of `other`
  // substances (may be null; must outlive this) and those of the part the ones that predict better.
  // The same for any number of threads.
  void Estimate(const SamplePart* other, const SampleSolver& solver, int threads);

  const SamplePart& part() const { return *part_; }
  const ResidualModel& residuals() const { return residuals_; }
  // The same as they were measured, without the belief beside them: what deviations are stated by.
  const ResidualModel& measured_residuals() const { return measured_residuals_; }
  const ViewDeviations& deviations() const { return deviations_; }
  const SpecularLobes& lobes() const { return lobes_; }
  // Whether photographs tell both slopes of a texel, so that what has no curl can be told from
  // errors.
  bool finds_relief() const { return all_views_.size() >= constants::kLeastValidatedViews; }
  double facet_variance() const { return facet_variance_; }

  // The texel's prior: without what its neighbours know, and with their values in `maps`. Of a
  // relief (may be null) of all that was found by texels themselves, its slope there says all that
  // is known of the normal.
  TexelPrior PriorOf(size_t texel) const;
  TexelPrior PriorOf(size_t texel, const SvbrdfMaps& maps, const ReliefSlope* relief) const;
  // The first of them, to be added to residuals that are judged as they were measured.
  TexelPrior StatedPriorOf(size_t texel) const;

  // What the texel's substances' means leave open: those are uncertain themselves, and all their
  // texels share what they are wrong by. `inverse`: of the normal equations with
  // StatedPriorOf(texel) and LeastInformation().
  TexelCovariance CommonCovariance(size_t texel, const BatchInverse& inverse, int lane) const;

  // What is added because two sources of the prior err together: the initialisation is an estimate
  // that expects level surfaces and texels like their substance, and is off where these are not.
  TexelCovariance CorrelatedPriorCovariance(size_t texel, const TexelValues& values,
                                            const BatchInverse& inverse, int lane) const;

  void Describe(RefineSummary* summary) const;

 private:
  struct Sampling {  // sampled texels and what solves them
    std::vector<size_t> texels;
    std::vector<SampledTexel> solved;
    // Of blocks: which of these are each one's neighbours.
    std::vector<std::vector<size_t>> neighbours;
    std::vector<size_t> places;  // of texels: those of a place have like half vectors
    size_t place_count = 0;
    size_t half_vectors = 0;  // that can be told apart, of all views
    const SampleSolver* solver = nullptr;
    int threads = 1;
    int first_worker = 0;  // of those threads
  };
  Sampling Sample(size_t most, const SampleSolver& solver, int threads) const;
  Sampling SampleBlocks(size_t most, const SampleSolver& solver, int threads) const;
  Sampling SamplingOf(std::vector<size_t> texels, const SampleSolver& solver, int threads) const;
  using HalfVectorCell = std::pair<int, int>;
  HalfVectorCell CellOf(size_t texel, size_t view) const;
  void TellHalfVectorsApart(Sampling* sampling) const;
  void Solve(const SampleRequest& request, Sampling* sampling) const;
  void FindNeighbours(Sampling* sampling) const;
  void SolveFromNeighbours(const SampleRequest& request, size_t half, Sampling* sampling) const;
  // Rounds of solving the sampled texels by all views and of updating what is being learned:
  // substances and the residuals' variance, and scatter of normals and views' deviations.
  void Fit(Sampling* sampling);
  void UpdateSubstances(const Sampling& sampling);
  void UpdateResiduals(const Sampling& sampling);
  void UpdateNormalSpreads(const Sampling& sampling);
  double NormalPrecision(size_t texel) const;
  void MeasureFacets(Sampling blocks);
  void UpdateDeviations(const Sampling& sampling);
  // Takes other substances where photographs held out are predicted far better by them.
  void ChooseSubstances(const SamplePart* other, const Sampling& sampling, const Sampling& blocks);
  // What is believed of the part's substances, from texels solved.
  void BeginSubstances(const Sampling& sampling);
  // From now on views stay as they are, the residuals' variance is measured rather than believed,
  // and diffuse albedo is shared too, from what was found of it without.
  void FreezeViews(double diffuse_spread, const Sampling& sampling);
  SampleWorth WorthOf(const Sampling& sampling) const;
  // Fit with normals' scatter too, unless roughness is held, from what is believed before any
  // round.
  void FitNormalsToo(Sampling* sampling);
  void FitAsChosen(Sampling* sampling);
  void HoldCurve(bool hold, const Sampling& sampling);
  // By cross-validation, sample_spreads.cc.
  int Folds() const;
  int HalfOfFolds() const { return (Folds() + 1) / 2; }
  int FoldAt(int place) const;  // in the order in which they are predicted
  // The texels' values by these views, from the prior's means and other starts on.
  std::vector<TexelValues> Search(std::span<const int> views, Sampling* part) const;
  // How wrong what is found of the sampled texels without the views of that fold predicts those: g²
  // by texel. Changes `part`, which begins as what is sampled. `start`: see FoldStarts.
  std::vector<double> HeldOutSquaresOf(int fold, std::vector<TexelValues>* start,
                                       Sampling* part) const;
  std::vector<double> HeldOutSquares(std::span<const ViewDifferences> differences) const;
  // Where the texels of spreads that are compared begin in each fold: at what Search() finds with
  // the first of them, which those of the others are near to; with other lobes they need not be.
  // Empty to begin with.
  using FoldStarts = std::vector<std::vector<TexelValues>>;
  // HeldOutSquaresOf() each of some folds.
  std::vector<std::vector<double>> HeldOutSquaresOfFolds(const Sampling& sampling, int first_fold,
                                                         int folds, FoldStarts* starts) const;
  // `give_up`, where there is one, is asked when half of the folds are known; only once `starts`
  // has those of all folds.
  HeldOutErrors CrossValidate(const Sampling& sampling, const GiveUp& give_up,
                              FoldStarts* starts) const;
  HeldOutErrors CrossValidate(const Sampling& sampling) const;
  SampleModel ScaledBy(const SpreadFactors& factors) const;
  // From factors of these powers on; returns those that predict best, and takes their mean.
  SpreadPowers ChooseSpreads(const Sampling& sampling, const SpreadPowers& from);
  std::vector<SpecularLobes> LobesToTry(const Sampling& sampling) const;
  void SetLobes(SpecularLobes lobes);  // with their shape as it is
  // With one shape of lobes, from the spreads that others had; returns those of one lobe.
  SpreadPowers ChooseLobesAndSpreads(const Sampling& sampling, const SpreadPowers& from);
  // What is chosen by cross-validation over `blocks` with one shape of lobes.
  SpreadPowers Choose(const SamplePart* other, const Sampling& sampling, const Sampling& blocks,
                      const SpreadPowers& from);
  // Whether photographs are enough to tell one shape, roughness or number of lobes from another.
  bool TellsLobesApart() const;
  Anisotropy AnisotropyToTry(const Sampling& sampling) const;
  bool MayHaveOneRoughness() const;  // not of what is mostly metals
  // With one lobe, if better than as found.
  std::optional<double> RoughnessToTry(const Sampling& sampling, const Sampling& blocks) const;
  // From now on all substances have that one, under a rough relief.
  void HoldRoughness(double roughness);
  // Becomes the estimate that begins so where it `asks` for it.
  using Asks = std::function<bool(const HeldOutErrors& with, const HeldOutErrors& without)>;
  bool TryFrom(const SampleModel& beginning, const Asks& asks, const SamplePart* other,
               const SpreadPowers& powers, const Sampling& blocks, Sampling* sampling);
  // What Choose() does with one roughness and other shapes of lobes tried too; `beginning`: before
  // anything was fitted.
  void ChooseShape(SampleModel beginning, const SamplePart* other, const Sampling& blocks,
                   Sampling* sampling);

  // What is known of a texel by itself; what its substance and a level surface say; both.
  TexelGaussian Initialisation(size_t texel) const;
  void MultiplySubstance(size_t texel, TexelGaussian* gaussian) const;
  TexelGaussian Knowledge(size_t texel) const;
  struct Neighbour {
    size_t texel;
    TexelValues values;
  };
  // Neighbours are expected to differ in their normals by as much as those differ from level, and
  // in their departures from their substances by `neighbour_spread_`.
  void MultiplyNeighbours(size_t texel, std::span<const Neighbour> neighbours,
                          TexelGaussian* gaussian) const;
  TexelPrior Scaled(const TexelGaussian& gaussian, const ResidualModel& residuals) const;

  const SamplePart* part_;
  RefineOptions options_;
  std::vector<int> all_views_;
  InitialisationErrors initial_errors_;
  SpecularLobes lobes_;
  ResidualModel residuals_, measured_residuals_;
  // Whether a surface is level and texels alike says anything beside the initialisation. That of
  // one photograph is an estimate by what materials are like, which knows both already.
  bool has_sample_priors_;
  SubstanceMeans means_;
  // Of n_x, n_y about 0, and about their neighbours' mean, by substance.
  std::vector<double> normal_spreads_;
  // By how much neighbours' departures from their substances differ, in spreads of departures.
  double neighbour_spread_ = constants::kNeighbourSd;
  // Of either slope of facets smaller than a texel, which are no height field's.
  double facet_variance_ = 0;
  bool learns_normals_ = false;  // whether Fit estimates them …
  bool finds_views_ = true;      // … and views' deviations
  ViewDeviations deviations_;
};

}  // namespace glint
