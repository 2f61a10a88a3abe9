// Stage "fit" of a capture: rectified views in, svbrdf.exr out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/programs/stage.h"
#include "fitting/latent/fit.h"

namespace glint {

// Raised whenever the same inputs give other bytes.
inline constexpr int kFitVersion = 13;

struct FitStageOptions {
  // latent: in the learned space; classic: texel by texel; initial: no fitting
  std::string method = "latent";
  std::string initial_maps = "estimator";  // estimator: the trained network; rules: rules.h
  // rare or possible: what the estimator is told of dark, glossy texels (estimator_conditions.h).
  // Without effect where `start` is given, and on rules.
  std::string metals = "rare";
  // Texels along the longer side of what the estimator is shown, at most; 0: by the number of
  // photographs.
  int estimator_size = 0;
  int iterations = 0;       // at the first level; 0: the method's own, by the number of photographs
  int fine_iterations = 0;  // at each later level; 0: the method's own
  int finest_size = 256;    // latent: of the last level, texels, or the photographs'
  double learning_rate = FitOptions().learning_rate;
  int tune_iterations = FitOptions().tune_iterations;
  double tune_rate = FitOptions().tune_rate;
  double code_prior = FitOptions().code_prior;
  std::filesystem::path start;       // maps to start from (svbrdf.exr); empty: from the photographs
  std::filesystem::path weights;     // of the auto-encoder; empty: the shipped ones
  std::filesystem::path estimator;   // weights of the estimator; empty: the shipped ones
  std::vector<std::string> views;    // names of those to use; empty: all
  std::vector<std::string> exclude;  // names of those held out
};

void AddFitOptions(OptionSet* set, FitStageOptions* options);

// Puts the method's own numbers of iterations where none are given, for as many photographs as are
// fitted, and what `auto` comes to: the manifest then has what was done. Throws UserError where
// `rectify_manifest` or the choice of views is wrong.
void ResolveFitOptions(const std::filesystem::path& rectify_manifest, FitStageOptions* options);

// The files the result depends on beside the rectified set's manifest: weights, start. Throws
// UserError when one is missing.
std::vector<std::filesystem::path> FitInputs(const FitStageOptions& options);

// A view to which no map was found that explains it as it does the others.
struct LeftOutView {
  std::string name, photo;
  double log_l1 = 0;
};

struct FitStageResult {
  Json data, metrics;
  FitResult fit;                      // to those that are left
  std::vector<LeftOutView> left_out;  // of photographs that the user did not choose one by one
  int width = 0, height = 0;
  double seconds = 0;  // for a person only
};

// `options` as ResolveFitOptions leaves them. Reads, fits, writes the stage's outputs and commits
// them. Throws UserError, ComputationError.
FitStageResult RunFitStage(const std::filesystem::path& rectify_manifest,
                           const FitStageOptions& options, int threads, Stage* stage);

}  // namespace glint
