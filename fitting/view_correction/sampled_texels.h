// Sampled texels that follow the views: what all texels together say of the views.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "fitting/texel/batch_search.h"
#include "fitting/view_correction/normal_equations.h"
#include "fitting/view_correction/texel_reduction.h"
#include "fitting/view_correction/view_unknowns.h"

namespace glint {

class SampledTexels {
 public:
  // About `texels` of the set's, each starting from `maps`. `set` and `unknowns` must outlive this.
  SampledTexels(const PhotographSet& set, const SvbrdfMaps& maps, const ViewUnknowns& unknowns,
                int texels, double robust_scale, int threads);
  ~SampledTexels();

  int size() const;
  double residuals() const { return residuals_; }  // of all texels
  // Per view, whether any texel sees it.
  std::vector<bool> UsableViews() const;

  // Standard deviation of a residual. The prior toward the initial maps weighs as one more
  // observation with it.
  void SetResidualSigma(double residual_sigma) { residual_sigma_ = residual_sigma; }

  using Values = std::vector<TexelValues>;
  Values Starts() const;
  // Fits every texel to the views at `x`, from `*values` and, unless null, from `others`: the
  // better of both. Returns half the sum of squared residuals, the priors' included.
  double Fit(const Eigen::VectorXd& x, const Values* others, Values* values);

  // The normal equations of the views alone, the texels following: their Schur complement
  // (Kaufman's form of variable projection). Keeps how the texels follow for Follow() and
  // MeanSlopeByViews().
  NormalEquations Reduce(const Eigen::VectorXd& x, const Values& values);
  // The texels after `step` of the views from where Reduce() was called, to first order.
  Values Follow(const Eigen::VectorXd& step, const Values& values) const;

  Eigen::Vector2d MeanSlope(const Values& values) const;
  // Its derivatives by the views, where Reduce() was called: a row each.
  Eigen::MatrixXd MeanSlopeByViews() const;

  // Standard deviations of the texels' errors that follow from errors of the views (root mean
  // square over texels), where Reduce() was called: of ∂texel/∂views · e, with e of the covariance
  // H⁻¹. `hessian` H: of the views' negative log posterior. No number if H has no inverse.
  SystematicDeviations PropagatedDeviations(const Eigen::MatrixXd& hessian,
                                            const Values& values) const;

  // See residual_noise.h.
  double SharedNoise(const Eigen::VectorXd& x, const Values& values);

 private:
  struct Texel;
  struct Worker;
  // The views as some unknowns say.
  struct ViewsAt {
    const Eigen::VectorXd& x;
    std::vector<View> views;
    EnvironmentLighting environment;
  };
  ViewsAt At(const Eigen::VectorXd& x) const;
  TexelPrior PriorOf(const Texel& texel) const;
  // What it reflects of each term of environment lighting.
  void AddEnvironment(const TexelSvbrdf<double>& svbrdf, const EnvironmentLighting& environment,
                      Texel* texel) const;
  // The observations of some texels, each in its lane; all of the set's views.
  void Gather(std::span<const size_t> texels, const ViewsAt& at, Worker* worker,
              BatchObservations* observations) const;
  double FitBlock(size_t first, size_t count, const ViewsAt& at, const Values* others,
                  Worker* worker, Values* values) const;
  // Of texels at `values`, photographs alone; leaves their observations and residuals in `worker`.
  BatchGram GramAt(std::span<const size_t> texels, const ViewsAt& at, const Values& values,
                   Worker* worker) const;
  // One texel's residuals with their derivatives by the views.
  void AddResiduals(const Texel& texel, int lane, const ViewsAt& at, const TexelValues& values,
                    const Worker& worker, TexelReduction* reduction) const;
  // What the texel's k-th view shows of the environment lighting, and its derivatives by the terms.
  double ReflectEnvironment(const Texel& texel, size_t k, const TexelSvbrdf<double>& svbrdf,
                            double exposure, const EnvironmentLighting& environment, int channel,
                            Eigen::VectorXd* by_term) const;

  const PhotographSet& set_;
  const ViewUnknowns& unknowns_;
  const int threads_;
  double residual_sigma_ = 0.02;
  double residuals_ = 0;
  std::vector<Texel> texels_;
  std::vector<TexelFollowing> following_;
  std::vector<TexelReduction> reductions_;  // memory of Reduce()
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace glint
