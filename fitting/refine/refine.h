// Refinement: every texel's reflectance solved for from its own observations and what the sample as
// a whole tells of it (docs/model.md).
//
//   1. EstimateSample(): on texels that stand for the sample, its substances, variances and
//   spreads,
//      and what deviates about the views.
//   2. Every texel is solved, min over x of  Σ ρ(log(R(x) + 0.01) − log(I + 0.01)) + prior(x), from
//      its start and from the roughness that a search proposes, with albedos fitted to it: too
//      rough with too little specular is a minimum of its own (Gao et al. 2019, Fig. 16) that more
//      photographs do not cure.
//   3. Every texel tries the solutions of its neighbours, in checkerboard order, its prior now
//      including what these tell of it.
//   4. Standard deviations from the final normal equations.
// Texels are independent within a step, so the result depends neither on the number of threads nor
// on where the sample is cut into rows (refine_rows.h).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/model/estimate.h"
#include "base/model/photographs.h"
#include "base/model/solver.h"
#include "base/model/substances.h"
#include "base/reflectance/convention.h"
#include "base/reflectance/environment_lighting.h"
#include "base/reflectance/svbrdf_deviations.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/systematic_deviations.h"
#include "base/reflectance/view.h"
#include "fitting/refine/kinds_prior.h"
#include "fitting/view_correction/shared_light.h"

namespace glint {

// One photograph of the problem. The spans belong to the caller.
struct RefineView {
  View view;
  bool ldr = true;              // radiance ≥ 1 means "at least 1"
  std::span<const float> rgb;   // planar, 3·H·W, linear
  std::span<const float> mask;  // H·W; texels of less than ½ are left out
  double pixels_per_texel = 0;  // side of a texel in the picture that this was; 0: not known
  double blur_px = 0;           // of that picture, before it was resampled; 0: not known
  // Of log radiance: variance of the detail that its blur hides and sharper views show, and what
  // its squared residuals therefore weigh (view_sharpness.h).
  double hidden_variance = 0, weight = 1;
  std::optional<double> spread_variance = {};  // of its points, texels²; nullopt: by its blur
  // What is solved from; empty: rgb. Refinement itself sets it where the picture is blurred
  // (point_spread.h).
  std::span<const float> deblurred = {};
};

struct RefineProblem {
  SamplePlane plane;
  ReflectanceConvention convention;
  std::vector<RefineView> views;
  // Standard deviations of the initial maps, kDeviationPlanes planes of H·W, as whoever made them
  // states them, for one or two views; empty: those of InitialisationErrors. The span belongs to
  // the caller.
  std::span<const float> initial_sd = {};
  EnvironmentLighting environment;     // beside what each view has as ambient light
  SystematicDeviations systematic_sd;  // of errors that follow from uncertain views
};

struct RefineOptions {
  // Most Levenberg–Marquardt steps of one solve.
  int iterations = constants::kSolveIterations;
  // Solves per texel: 1: from the initial maps alone; more: from so many roughnesses.
  int starts = constants::kStarts;
  // How often a texel tries its neighbours' solutions.
  int neighbour_passes = constants::kNeighbourPasses;
  // At most, that share their roughness and albedos.
  int substances = constants::kSubstances;
  // Of variances and substances, on sampled texels: twice from each beginning, and up to twice at
  // the end.
  int estimation_rounds = constants::kEstimationRounds;
  // Texels along the longer side among which those are sampled, at most; the sample as a whole is
  // estimated from no others. A million texels: the few thousand that are solved are picked of
  // them.
  int estimation_size = constants::kEstimationSize;
  // Standard deviation expected of the flash's place beside where it is said to be, relative to its
  // distance (flash_offset.h). 0: it is where it is said to be.
  double flash_offset = 0;
  // Standard deviations expected of the logarithm of single views' exposures, and of their lights'
  // places across their directions, relative to their distance (view_deviations.h). 0: as said.
  double exposure_spread = 0;
  double light_spread = 0;
  // Prior standard deviations, for photographs with lamps of their own, of the gradient of log
  // exposure by the direction of light, and of the sample's mean slope (view_deviations.h). 0:
  // none.
  double lamp_gradient = 0, level_spread = 0;
  // Scale σ expected of residuals (log radiance) before any is seen: a weak prior, which decides
  // where photographs are few (residual_model.h).
  double residual_sigma = constants::kResidualSigma;
  // Of substances. That of the light's power is what calibration leaves open of a board's white.
  KindsPriorOptions kinds;
  // Standard deviations expected of all views' light (shared_light.h). 0: as said.
  double flash_beam = 0, distance_power = 0;
  // Likewise of their curve (characteristic_curve.h): its toe, radiance, and its shoulder.
  double toe = 0, shoulder = 0;
  bool second_lobe = true;    // of the whole sample, where held-out photographs ask for it
  bool anisotropy = true;     // of its lobes, likewise
  bool one_roughness = true;  // of all its substances, likewise
  bool lobe_tails = false;    // look for shorter ones than GGX's too, likewise
  double prior = constants::kPriorWeight;  // factor on the priors' weight; 0: none
  // Standard deviation by which lens, pixel, demosaicking and resampling spread a point of the
  // picture, pixels (point_spread.h), of views whose blur is not known, or of all. 0: not at all.
  double point_spread_px = constants::kPointSpread_px;
  bool share_detail = true;   // sharper photographs lend theirs to blurred ones (shared_detail.h)
  bool measured_blur = true;  // views whose blur is known have that
  double robust_scale = constants::kRobustScale;  // residuals (log units) beyond it count linearly

  // Empty: all is well; otherwise what is wrong.
  std::string Check() const;
};

// What confidence.exr holds: standard deviations (DeviationPlane), and beside them
enum ConfidencePlane : int {
  kTexelCost = kDeviationPlanes,  // half the sum of squared residuals
  kConfidencePlanes
};

struct RefineSummary {
  double start_cost = 0;  // means over texels
  double final_cost = 0;
  double residual_sigma = 0;      // scale σ of residuals, log units (docs/model.md) …
  double residual_deviation = 0;  // … and their standard deviation, which long tails raise
  double discrepancy = 0;         // of it, what the reflectance model does not express
  double effective_views = 0;     // how many views say something of their own
  int substances = 0;             // that are told apart
  SpecularLobes lobes;            // of the sample
  double one_roughness = 0;       // that of all substances' means; 0: each has its own
  double roughness_spread = 0;  // of texels about their substance's mean (∞: one photograph) …
  double specular_spread = 0;   // … relative
  double diffuse_spread = 0;    // likewise; ∞ from one or two photographs
  double initialisation_error = 0;  // in expected ones of one photograph
  double neighbour_spread = 0;      // between neighbours' departures from those means, in spreads
  double normal_spread = 0;         // of n_x, n_y about 0, and between neighbours; likewise
  double facet_spread = 0;          // of slopes of facets that are no height field's
  // By how much the light is stronger than stated, if dielectrics reflect what they do (of use
  // where its power was not calibrated): specular albedos over what they should be.
  double light_power = 1;
  SharedLight shared_light;   // of all views
  CharacteristicCurve curve;  // as `shared_light` has it
  // What single views deviate by: added to the lights beside `shared_light`, factors on
  // exposures; and the spreads of both, estimated.
  std::vector<Vec3d> light_offsets_mm;
  std::vector<double> exposures;
  double light_spread = 0, exposure_spread = 0;
  double converged = 0;           // share of texels
  double other_start = 0;         // share of texels whose solution came from another start …
  double neighbour = 0;           // … or from a neighbour
  std::vector<double> view_loss;  // per view: mean |log(I + 0.01) − log(R + 0.01)|, NaN: masked

  std::string BriefReport() const;
};

struct RefineResult {
  SvbrdfMaps maps;
  std::vector<float> confidence;  // kConfidencePlanes planes of H·W
  RefineSummary summary;
};

// `start` has the plane's size. `progress` (may be empty) is called with texels done so far and all
// texel visits to come, from one thread at a time.
// Throws std::invalid_argument when sizes do not fit, values are not finite or an option is wrong.
RefineResult Refine(
    const RefineProblem& problem, const SvbrdfMaps& start, const RefineOptions& options,
    int threads, const std::function<void(std::int64_t done, std::int64_t total)>& progress = {});

}  // namespace glint
