// How far a capture's calibration can be trusted: uncertainty, cross-validation, diagnosis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/capture.h"
#include "base/programs/stage.h"
#include "calib/bundle/bundle.h"
#include "calib/uncertainty/projection_uncertainty.h"
#include "calib/uncertainty/sample_uncertainty.h"
#include "calib/validation/cross_validation.h"
#include "calib/validation/diagnosis.h"
#include "calib/validation/model_choice.h"

namespace glint {

struct Trust {
  std::vector<UncertaintyMap> projection;  // by camera; no points: intrinsics given, or unused
  std::vector<SampleUncertainty> sample;   // by photo of the bundle; zeros: rejected
  double sample_sigma_mm = 0;              // root mean over the photos
  double texel_mm = 0;                     // of the maps to come; 0: not told
  CrossValidation validation;
  Diagnosis diagnosis;
  std::optional<ModelChoice> choice;  // with --model auto

  size_t WorstPhoto() const;  // on the sample; only where sample_sigma_mm > 0
};

// `result` solves `problem` under `options`.
Trust AssessTrust(const Capture& capture, const BundleProblem& problem,
                  const BundleOptions& options, const BundleResult& result);

// What neither noise nor a photograph of its own explains; "": nothing that moves a texel.
std::string MisfitInWords(const CrossValidation& validation);

// projection_camera0.png, odd_even_camera0.png, residuals_by_photo_camera0.png …,
// residuals_by_place.png.
void WriteTrustPictures(const BundleResult& result, const Trust& trust, Stage* stage);

// Fields of the stage's metrics, and of residuals.json.
void AddTrustMetrics(const BundleResult& result, const Trust& trust, Json* metrics);
void AddTrustResiduals(const BundleResult& result, const Trust& trust, Json* residuals);
std::string TextOf(const BundleResult& result, const Trust& trust);

}  // namespace glint
