// The camera model that the photographs ask for, by cross-validation.
//
// A model with too few terms leaves residuals; one with too many follows the noise of the
// photographs it was fitted to. Both show in photographs that were held out: each model is fitted
// to the odd photographs and judged by the even ones and the other way round, and the simplest is
// chosen whose held-out residual is not clearly above the least (by more than one standard error
// over the photographs, Breiman et al. 1984, and by more than a hundredth).
#pragma once

#include <string>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint {

struct ModelTrial {
  CameraModel model = CameraModel::kOpenCv;
  double rms_px = 0;           // of all photographs, with the corners that all models share
  double held_out_rms_px = 0;  // see CrossValidation
  double ratio = 0;            // of difference and prediction
  std::string problem;         // why it was not judged; empty: it was
};

struct ModelChoice {
  CameraModel model = CameraModel::kOpenCv;
  std::vector<ModelTrial> trials;  // simplest first
  std::string reason;
};

// Of CalibratedModels(kCompared); `options.model` where no model can be judged
// (see CrossValidate). Terms of options.hold that a model has not are ignored for that model.
// Throws what AdjustBundle throws when no model can be fitted.
ModelChoice ChooseModel(const BundleProblem& problem, const BundleOptions& options);

// Options for another model: without the held terms that it has not.
BundleOptions WithModel(BundleOptions options, CameraModel model);

}  // namespace glint
