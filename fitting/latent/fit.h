// Fitting maps to photographs: in the auto-encoder's latent space, or on the maps themselves.
//
//   FitLatent   argmin_z Σ_i loss(I_i, R(D(z), C_i))   (Gao et al. 2019, eq. 3)
//   FitClassic  argmin_maps of the same loss from the same start, no learned space: the baseline
//
// loss is eq. 2, the mean of |log(I + 0.01) − log(R + 0.01)|, with R clamped to [0, 1] for LDR
// photographs. Both work from coarse to fine: at most `coarse_size` texels along a side first, then
// twice that, up to the photographs' size, each level from the enlarged maps of the one before.
// After the code has settled the decoder itself may be fine-tuned on the exemplar
// (`tune_iterations`; beyond the paper): what the learned space cannot express of this sample, its
// weights learn to, and a convolutional network prefers the regular over the accidental.
// Results are the same bits for any number of threads.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fitting/autoencoder/autoencoder.h"
#include "fitting/photographs/photographs.h"

namespace glint {

struct FitOptions {
  int coarse_iterations = 300;  // most at the first level
  int fine_iterations = 80;     // most at each later level
  int coarse_size = 256;        // texels along the longer side at the first level
  int finest_size = 1 << 20;    // texels along the longer side at the last level, at most
  double learning_rate = 0.03;  // Adam's, at the start of a level; falls as progress ends
  double tolerance = 0.003;     // relative fall of the loss over `patience` iterations that counts
  int patience = 25;
  int start_iterations = 25;  // latent only: pulling D(z) onto the start before fitting
  double code_prior = 0;      // latent only: weight of mean z² (codes of materials are N(0, 1))
  int tune_iterations = 0;  // latent only: of the decoder and the code together, at the last level
  double tune_rate = 0.01;  // of the decoder's weights, relative to the code's rate
  bool fast = true;         // latent only: bf16 where the CPU has it
  int threads = 1;

  static FitOptions Latent() { return {}; }
  // Of three photographs and more, where refinement follows: it comes to the same from maps that
  // have not converged (docs/experiments/latent-fitting.md).
  static FitOptions LatentForRefinement();
  static FitOptions Classic();
  // Empty: all is well; otherwise what is wrong.
  std::string Check() const;
};

struct FitLevel {
  int width = 0;
  int height = 0;
  bool tuned = false;        // the decoder's weights were free
  std::vector<double> loss;  // of the photographs, one value per iteration, before its step
  bool converged = false;    // ended by tolerance, not by the number of iterations
};

struct FitResult {
  SvbrdfMaps maps;  // at the photographs' size
  std::vector<FitLevel> levels;
  double start_loss = 0;          // of the start given, at the first level
  double final_loss = 0;          // of `maps`
  std::vector<double> view_loss;  // of `maps`, per photograph
  double light_scale = 1;         // what every light_rgb is to be multiplied with
  LatentCode code;                // latent only

  // The least that the last level reached, which start_loss can be compared with; final_loss
  // without levels.
  double fitted_loss() const;
  std::string BriefReport() const;
};

// Iterations done and all that may come.
using FitProgress = std::function<void(int done, int total, double loss)>;

// `start` is resampled to the first level. Throws std::invalid_argument when set.Check() or
// options.Check() says something, std::runtime_error when the loss is not finite.
FitResult FitLatent(const PhotographSet& set, const SvbrdfMaps& start, const Autoencoder& network,
                    const FitOptions& options, const FitProgress& progress = {});
FitResult FitClassic(const PhotographSet& set, const SvbrdfMaps& start, const FitOptions& options,
                     const FitProgress& progress = {});

// No fitting: `start` as it is, resampled where its size is not the photographs', and its loss.
// Throws std::invalid_argument when set.Check() says something.
FitResult KeepStart(const PhotographSet& set, const SvbrdfMaps& start, int threads);

}  // namespace glint
