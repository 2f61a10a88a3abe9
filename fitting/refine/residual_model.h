// How far apart photographs and renderings of the right maps are, and how much that is worth:
// docs/model.md, "The photographs".
//
// A residual log(R + 0.01) − log(I + 0.01) is measurement noise q, each channel's own, plus model
// discrepancy d (Kennedy and O'Hagan, "Bayesian calibration of computer models", JRSS B 2001): what
// the reflectance model cannot express of this sample. Discrepancy is common to the three channels,
// and alike in views whose half vectors are close. Correlated residuals say less than independent
// ones; all are weighted alike, so that together they count as many as they are worth (a composite
// likelihood, its magnitude adjusted: Pauli, Racugno and Ventura, Statistica Sinica 2011).
#pragma once

#include <vector>

#include "base/model/photographs.h"
#include "fitting/refine/refine.h"

namespace glint {

struct ResidualModelOptions {
  // Inter-channel correlation of discrepancy; fourteen real samples: .75 to .99.
  double channel_correlation = constants::kChannelCorrelation;
  // Length scale, in degrees between half vectors, over which discrepancy stays alike.
  double half_vector_deg = constants::kDiscrepancyLength_deg;
  // Share of its variance that is a smooth function of the half vector; the rest is each view's
  // own (registration, exposure).
  double smooth_share = constants::kSmoothShare;
  // What residuals are expected to be before any is seen (RefineOptions::residual_sigma), and
  // how many per texel that belief is worth while views are being found.
  double expected_sigma = constants::kResidualSigma;
  double expected_residuals = constants::kResidualSigmaWeight;
};

class ResidualModel {
 public:
  ResidualModel(const RefineProblem& problem, const ResidualModelOptions& options);

  // For residuals of variance σ² in all, at least that of measurement.
  void SetVariance(double variance);
  double variance() const { return variance_; }
  // Standard deviation of discrepancy, and its share of the variance.
  double discrepancy() const;
  double discrepancy_share() const { return 1 - measurement_ / variance_; }
  // Number of views that say something of their own: the sum of the inverse correlation matrix.
  double effective_views() const { return effective_views_; }
  // Standard deviation by which residuals of weight 1 are to be judged against priors:
  // σ·√(1 + 2κω)·√(views / effective views), κ the inter-channel correlation of discrepancy, ω its
  // share of the variance.
  double scale() const;

  const ResidualModelOptions& options() const { return options_; }

 private:
  ResidualModelOptions options_;
  double measurement_;
  double variance_ = 0;
  double effective_views_ = 1;
  std::vector<std::vector<double>> likeness_;  // of discrepancy, by pairs of views
};

// Variance of log(I + 0.01) by rounding to 8 bits of gamma 2.2, mean over usable samples of LDR
// photographs, and what sensors add. For float photographs the latter alone.
double MeasurementVariance(const RefineProblem& problem);

// The scale σ² of residuals whose negative log likelihood is Charbonnier's loss / σ²
// (batch_kernel.h): they have the symmetric hyperbolic distribution (Barndorff-Nielsen, Proc. R.
// Soc. A 1977), whose mean squared g² is more than σ² where its tails are long. ζ = δ²/σ² solves
// K₀(ζ)/K₁(ζ) + 1/ζ − 1 = mean g² / 2δ²: the likelihood's maximum.
double HyperbolicVariance(double mean_square, double robust_scale);

// The mean square of such residuals themselves (not of g): σ² where their tails are short, above it
// where they are long. With ζ = δ²/σ² it is δ²·K₂(ζ)/(ζ·K₁(ζ)).
double HyperbolicMeanSquare(double variance, double robust_scale);

// Effective views where all of a residual is discrepancy that is smooth in the half vector:
// n² / Σ_ij exp(−θ_ij²/2τ²), θ_ij the angle between half vectors at the sample's centre, τ = 8°.
double DistinctViews(const RefineProblem& problem);

}  // namespace glint
