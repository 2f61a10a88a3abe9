#include "calib/validation/model_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/errors/errors.h"
#include "calib/validation/cross_validation.h"

namespace glint {
namespace {

// Corners that are inliers under the model with the most of them: so that all models are judged by
// the same corners, and a poor model cannot hide what it does not explain.
BundleProblem SharedCorners(const BundleProblem& problem, const BundleOptions& options) {
  std::exception_ptr error;
  BundleResult best;
  for (const CameraModel model : CalibratedModels(Calibrated::kCompared)) {
    try {
      BundleResult result = AdjustBundle(problem, WithModel(options, model));
      if (result.inliers > best.inliers) best = std::move(result);
    } catch (const Error&) {
      if (!error) error = std::current_exception();
    }
  }
  if (best.inliers == 0) std::rethrow_exception(error);
  return Accepted(problem, best);
}

struct Judged {
  ModelTrial trial;
  std::vector<double> held_out_px2;
};

Judged Judge(const BundleProblem& problem, const BundleOptions& options) {
  Judged out;
  out.trial.model = options.model;
  try {
    const BundleResult result = AdjustBundle(problem, options);
    const CrossValidation validation = CrossValidate(problem, options, result);
    out.trial.rms_px = result.rms_px;
    out.trial.problem = validation.problem;
    out.trial.held_out_rms_px = validation.held_out_rms_px;
    out.trial.ratio = validation.ratio();
    out.held_out_px2 = validation.held_out_px2;
  } catch (const Error& error) {
    out.trial.problem = error.what();
  }
  return out;
}

// Whether `other` is as good as `best` within the scatter over the photographs.
bool AsGood(const Judged& other, const Judged& best) {
  constexpr double kWorthless = 0.01;  // relative, of the residual
  if (other.trial.held_out_rms_px <= (1 + kWorthless) * best.trial.held_out_rms_px) return true;
  double sum = 0, squares = 0;
  int n = 0;
  for (size_t i = 0; i < best.held_out_px2.size(); ++i) {
    const double excess = other.held_out_px2[i] - best.held_out_px2[i];
    if (std::isnan(excess)) continue;
    sum += excess;
    squares += excess * excess;
    ++n;
  }
  if (n < 2) return false;
  const double mean = sum / n;
  const double standard_error = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
  return mean <= standard_error;
}

}  // namespace

BundleOptions WithModel(BundleOptions options, CameraModel model) {
  options.model = model;
  const auto& names = CameraParameterNames(model);
  std::erase_if(options.hold, [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) == names.end();
  });
  return options;
}

ModelChoice ChooseModel(const BundleProblem& problem, const BundleOptions& options) {
  BundleOptions fixed_corners = options;
  fixed_corners.reject = false;
  const BundleProblem shared = options.reject ? SharedCorners(problem, options) : problem;
  std::vector<Judged> judged;
  const Judged* best = nullptr;
  const std::vector<CameraModel> compared = CalibratedModels(Calibrated::kCompared);
  judged.reserve(compared.size());
  for (const CameraModel model : compared) {
    judged.push_back(Judge(shared, WithModel(fixed_corners, model)));
    const Judged& last = judged.back();
    if (!last.trial.problem.empty()) continue;
    if (!best || last.trial.held_out_rms_px < best->trial.held_out_rms_px) best = &last;
  }
  ModelChoice choice;
  choice.model = options.model;
  for (const Judged& j : judged) choice.trials.push_back(j.trial);
  if (!best) {
    choice.reason = "no model could be cross-validated: " + judged.back().trial.problem;
    return choice;
  }
  const auto chosen = std::find_if(judged.begin(), judged.end(), [&](const Judged& j) {
    return j.trial.problem.empty() && AsGood(j, *best);
  });
  choice.model = chosen->trial.model;
  choice.reason = fmt::format(
      "the simplest whose held-out residual, {:.3f} px, is not clearly above the least, {:.3f} px",
      chosen->trial.held_out_rms_px, best->trial.held_out_rms_px);
  return choice;
}

}  // namespace glint
