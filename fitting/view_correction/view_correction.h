// What calibration and rectification left wrong in the views, found from the photographs alone:
// where each flash was, what environment lighting adds, and by how much each picture is displaced
// on the sample:
//
//   min over views  Σ_texels min over texel Σ_views ρ( log(R(texel; view) + 0.01) − log(I + 0.01) )
//       + expectations of the views' errors
//
// over sampled texels; residuals as in fitting/texel/batch_kernel.h. Every cost is that of
// texels that are fitted anew to the views as they then are (variable projection: Golub and
// Pereyra, "The differentiation of pseudo-inverses and nonlinear least squares problems whose
// variables separate", SIAM J. Numer. Anal. 1973), each by the search that refinement uses. Texels
// solved for together with the views, as points are in a bundle adjustment, stay behind in minima
// of the wrong views and keep these from their correct values: lights came back to a degree, not to
// a tenth.
//
// Lights that are wrong alike (a flash elsewhere beside the lens) and normals that are tilted alike
// explain matte photographs equally well. So what all lights share is expected apart, and the
// sample is expected to be level in the mean.
#pragma once

#include <string>
#include <vector>

#include "base/model/photographs.h"
#include "base/model/solver.h"
#include "base/model/view_correction.h"
#include "base/reflectance/environment_lighting.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/systematic_deviations.h"
#include "fitting/photographs/photographs.h"
#include "fitting/photographs/picture_shift.h"

namespace glint {

// Added to what the view says. Nothing to correct: the default.
struct ViewCorrection {
  Vec3d light_offset_mm{0, 0, 0};
  double exposure = 1;  // factor
  CornerShifts shifts;  // the picture is to be looked up so far off, in texels

  bool none() const { return light_offset_mm == Vec3d{0, 0, 0} && exposure == 1 && !shifts.any(); }
};

// All that is to be corrected about a set.
struct ViewCorrections {
  std::vector<ViewCorrection> views;  // one per photograph
  EnvironmentLighting environment;    // added to the set's
  // Of the maps' errors that follow from the corrections' own.
  SystematicDeviations systematic_sd;
};

// Standard deviations expected beforehand.
struct ViewExpectations {
  // Of the light's offset across its direction, relative to its distance …
  double light = constants::kCorrectedLightSd;
  // … and along it; both beside what all lights share: the flash stands elsewhere beside the lens
  // of an upright camera.
  double distance = constants::kCorrectedDistanceSd;
  double shared_light = constants::kSharedLightSd;
  double level = constants::kCorrectedLevelSd;  // of the sample's mean slope
  // Of ambient illumination, of the flash's at the sample's centre: in the mean of all directions,
  // and of each term that says where it comes from (docs/experiments/wrong-views.md).
  double ambient = constants::kAmbientSd;
  double ambient_direction = constants::kAmbientDirectionSd;
  double exposure = constants::kCorrectedExposureSd;  // of its logarithm
  double registration_texel = constants::kShiftSd_texel;
};

struct ViewCorrectionOptions {
  bool light = true;
  // Terms of environment lighting by channel (environment_lighting.h); 0: none, 1: uniform. Lights
  // that are off and environment lighting that is not uniform explain some of the same.
  int environment_terms = 1;
  bool exposure = false;
  bool registration = true;
  ViewExpectations expected;
  // Effective sample size of a view's residuals. Errors of model and maps are common to many of
  // them; at their full number they would outweigh any prior.
  double effective_residuals = constants::kEffectiveResiduals;
  // The same where what remains looks like noise: without inter-channel correlation.
  double independent_residuals = constants::kIndependentResiduals;
  int texels = constants::kCorrectionTexels;           // sampled, about …
  int last_texels = constants::kLastCorrectionTexels;  // … and for the last descent
  // Levenberg–Marquardt steps of one descent, at most.
  int iterations = constants::kCorrectionIterations;
  double robust_scale = constants::kRobustScale;  // residuals (log units) beyond it count linearly
  // Displacements that lower the squared residuals by a smaller share, beside what looking up
  // between texels takes off their noise, are not taken: it costs sharpness.
  double registration_gain = constants::kLeastRegistrationGain;

  // Empty: all is well; otherwise what is wrong.
  std::string Check() const;
};

struct ViewCorrectionResult {
  ViewCorrections corrections;
  // Half the sum of squared residuals of the texels sampled last, fitted to the views as they
  // were and as they are now.
  double cost_before = 0, cost_after = 0;
  double rounding_cost = 0;  // what rounding to 8 bits would add
  // Share of noise that the displacements leave in the pictures: less noise is no better explained.
  double noise_left = 1;

  // Relative fall of a cost of the same texels, their pictures where they were, to this one;
  // rounding included: where photographs are explained better than that, nothing is gained.
  double GainOver(double cost) const {
    return (cost - cost_after / noise_left) / (cost + rounding_cost);
  }
};

// `maps`: what the texels start from, and the mean of their prior, which is worth one more
// observation; of the set's size. Displacements are relative to their mean over the views: what all
// share is the maps' own place. The result does not depend on the number of threads.
// `known`: corrections to begin with, of an earlier call with other maps; empty: none.
// Throws std::invalid_argument when sizes or options are wrong.
ViewCorrectionResult CorrectViews(const PhotographSet& set, const SvbrdfMaps& maps,
                                  const ViewCorrectionOptions& options, int threads,
                                  const ViewCorrections& known = {});

// The view as the correction says.
View CorrectedView(View view, const ViewCorrection& correction);

// The photographs as the corrections say: lights moved, environment lighting added, pictures
// resampled. Of rows of a sample, the outermost RowsReached() at a cut are wrong.
// Throws std::invalid_argument unless there is a correction for every photograph.
PhotographSet Corrected(PhotographSet set, const ViewCorrections& corrections, int threads);
int RowsReached(const ViewCorrections& corrections);

// The same corrections for pictures of another size.
ViewCorrections AtSize(ViewCorrections corrections, int from_width, int from_height, int to_width,
                       int to_height);

// Angle at the sample's centre between where the light was said to be and where it is found.
double LightTurnedDeg(const View& view, const ViewCorrection& correction);

}  // namespace glint
