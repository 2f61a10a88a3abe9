// glint-train: trains the learned parts of Glint. Builds with libtorch and header-only libraries
// alone.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/material_pack/pnm_materials.h"
#include "datasets/procedural/material.h"
#include "training/autoencoder_trainer.h"
#include "training/estimator_trainer.h"
#include "training/training_materials.h"

namespace {

using glint::AutoencoderTrainOptions;
using glint::EstimatorTrainOptions;
using glint::TrainFiles;
using glint::TrainOptions;
using glint::TrainProgress;

// Validation takes reserved seeds that no table of results uses.
constexpr std::uint64_t kValidationOffset = 500'000'000;

// Options that all trainings have.
void AddCommonOptions(CLI::App* app, TrainOptions* o, TrainFiles* files) {
  app->add_option("--out", files->weights, "weights file to write (safetensors)")->required();
  app->add_option("--checkpoint", files->checkpoint, "checkpoint file (default: OUT.checkpoint)");
  app->add_option("--log", files->log_csv, "loss log, CSV (default: OUT.csv)");
  app->add_option("--float32", files->float32,
                  "also write the averaged weights in float32 to this file (default: bf16 only)");
  app->add_flag("--resume", files->resume, "continue from the checkpoint if there is one");
  app->add_option("--steps", o->steps, "number of optimiser steps");
  app->add_option("--minutes", o->minutes,
                  "training time in minutes, in total, over all resumed runs");
  app->add_option("--batch", o->batch, "number of crops per step")->capture_default_str();
  app->add_option("--crop", o->crops,
                  "crop sizes in texels, multiples of 32; each step picks one at random, "
                  "with as many texels as --batch crops of the first size")
      ->delimiter(',')
      ->capture_default_str();
  app->add_option("--lr", o->learning_rate, "peak learning rate")->capture_default_str();
  app->add_option(
         "--clip", o->max_gradient_norm,
         "maximum norm of a step's gradient; larger gradients are scaled down; 0: no maximum")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app->add_option("--warmup", o->warmup_steps, "number of steps over which the learning rate rises")
      ->capture_default_str();
  app->add_option("--warmup-from", o->warmup_from,
                  "step at which warm-up starts; set it to the checkpoint's step when --resume "
                  "extends a run")
      ->capture_default_str();
  app->add_option("--accumulate", o->accumulate, "batches whose gradients are accumulated per step")
      ->capture_default_str();
  app->add_option(
         "--from", o->from,
         "file of initial weights from any earlier training run (default: newly initialised)")
      ->check(CLI::ExistingFile);
  app->add_option("--map-weight", o->map_weight, "weight of the map term")->capture_default_str();
  app->add_option("--render-weight", o->render_weight, "weight of the rendering term")
      ->capture_default_str();
  app->add_option("--render-views", o->render_views,
                  "number of renderings per crop (Gao et al. 2019: 9)")
      ->capture_default_str();
  app->add_option("--normal-weight", o->normal_weight, "weight of normals in the map loss")
      ->capture_default_str();
  app->add_option("--average-decay", o->average_decay, "decay of the weights' moving average")
      ->capture_default_str();
  app->add_option("--bf16", o->bf16, "multiply in bf16 where the device supports it")
      ->capture_default_str();
  app->add_option("--pool-window", o->pool.window, "number of materials from which each step draws")
      ->capture_default_str();
  app->add_option("--pool-first", o->pool.first,
                  "number of materials generated before the first step")
      ->capture_default_str();
  app->add_option("--pool-per-step", o->pool.per_step, "number of new materials per step")
      ->capture_default_str();
  app->add_option("--material-size", o->pool.material_size, "side of a material in texels")
      ->capture_default_str();
  app->add_option("--checkpoint-minutes", o->checkpoint_minutes, "minutes between checkpoints")
      ->capture_default_str();
  app->add_option("--report-seconds", o->report_seconds, "seconds between lines of the loss log")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_flag("--supervise", o->supervise,
                "when the loss jumps, return to the last good weights and halve the learning rate");
  app->add_option("--test-jump", o->test_jump_step,
                  "for tests: corrupt the weights once, after this step");
  app->add_option("--batches-ahead", o->batches_ahead, "number of batches prepared in advance")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app->add_option("--seed", o->seed, "seed of weights, materials and crops")->capture_default_str();
  app->add_option("--threads", o->threads,
                  "torch threads; results are reproducible for a fixed number of threads")
      ->capture_default_str();
  app->add_option("--pool-threads", o->pool.threads,
                  "threads that generate materials and cut crops; they do not change results")
      ->capture_default_str();
  app->add_option("--device", o->device,
                  "cpu, or cuda if libtorch supports it; results are reproducible only on a CPU")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
}

void AddAutoencoderOptions(CLI::App* app, AutoencoderTrainOptions* o) {
  app->add_option("--channels", o->channels,
                  "channels at each of the five levels (the last is the latent code)")
      ->delimiter(',')
      ->capture_default_str();
  app->add_option("--smoothness", o->smoothness,
                  "weight of the smoothness term (Gao et al. 2019: 2)")
      ->capture_default_str();
  app->add_option("--smoothness-share", o->smoothness_share,
                  "fraction of the batch to which the smoothness term is applied")
      ->capture_default_str();
  app->add_option("--noise-variance", o->noise_variance,
                  "variance of the noise added to the latent code")
      ->capture_default_str();
  app->add_option("--normalisation", o->normalisation,
                  "batch normalisation: none, on the code, or on all convolutions")
      ->check(CLI::IsMember({"none", "code", "all"}))
      ->capture_default_str();
  app->add_option("--principal-start", o->principal_start, "initialise from principal components")
      ->capture_default_str();
}

void AddEstimatorOptions(CLI::App* app, EstimatorTrainOptions* o) {
  app->add_option("--channels", o->channels,
                  "channels at each of the five levels, then at full resolution, then in the "
                  "branch of global features")
      ->delimiter(',')
      ->capture_default_str();
  app->add_option("--network", o->network,
                  "pooled: mean and maximum over the photographs; attended: attention over them; "
                  "descent: pooled, then improved by learned descent on the photographs' "
                  "likelihood; --from also takes pooled weights")
      ->check(CLI::IsMember({"pooled", "attended", "descent"}))
      ->capture_default_str();
  app->add_option(
         "--spread-weight", o->spread_weight,
         "weight of the negative log-likelihood of the errors under the predicted variances")
      ->capture_default_str();
  app->add_option("--batch-photographs", o->batch_photographs,
                  "maximum number of photographs per step; batches hold fewer samples when the "
                  "samples have many photographs")
      ->capture_default_str();
}

void Report(const TrainProgress& p) {
  std::fprintf(stderr,
               "step %lld  %.0f s  %.1f samples/s  lr %.2e  loss %.4f (map %.4f smooth %.4f "
               "render %.4f)  waiting for data %.0f %%  ETA %.0f s",
               static_cast<long long>(p.step), p.seconds, p.samples_per_second, p.learning_rate,
               p.loss, p.map_loss, p.smoothness_loss, p.render_loss, 100 * p.wait_share,
               p.eta_seconds);
  if (p.validation_map_loss) std::fprintf(stderr, "  validation %.4f", *p.validation_map_loss);
  if (!p.event.empty()) std::fprintf(stderr, "  %s", p.event.c_str());
  std::fputc('\n', stderr);
}

// What all trainings draw their materials from.
struct MaterialOptions {
  std::string pack;
  double pack_share = 0.5;
  double glossy_dielectric_share = 0;
  double one_substance_share = 0;
  double metal_share = -1;
  double varnish_share = 0;

  void AddTo(CLI::App* app) {
    app->add_option("--materials", pack, "pack of real materials to mix in (glint-synth pack)");
    app->add_option("--materials-share", pack_share, "fraction of materials drawn from the pack")
        ->capture_default_str();
    app->add_option(
           "--glossy-dielectric-share", glossy_dielectric_share,
           "fraction of materials turned, wholly or partly, into dark, mostly glossy dielectrics")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app->add_option("--one-substance-share", one_substance_share,
                    "fraction of materials with nearly constant roughness and specular albedo")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app->add_option("--metal-share", metal_share,
                    "fraction of materials with metal; metals in the others become paint; "
                    "negative: leave all metals as generated and packed")
        ->check(CLI::Range(-1.0, 1.0))
        ->capture_default_str();
    app->add_option("--varnish-share", varnish_share,
                    "fraction of wood and paint given a clear varnish; for all other non-metals, a "
                    "fifth of that fraction")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
  }
};

// The sources of a training, and the name of its data.
struct Sources {
  glint::MaterialPack pack;
  glint::MaterialSource training, validation;
  std::string name = "procedural";

  Sources(const MaterialOptions& options, std::uint64_t seed, int size) {
    if (!options.pack.empty()) {
      pack = glint::ReadMaterialPack(options.pack);
      name += ", " + std::to_string(pack.size()) + " packed materials in " +
              std::to_string(options.pack_share);
    }
    if (options.glossy_dielectric_share > 0)
      name += ", " + std::to_string(options.glossy_dielectric_share) + " glossy dielectrics";
    if (options.one_substance_share > 0) {
      name += ", " + std::to_string(options.one_substance_share) + " of one substance";
    }
    if (options.metal_share >= 0)
      name += ", " + std::to_string(options.metal_share) + " with metal";
    if (options.varnish_share > 0)
      name += ", " + std::to_string(options.varnish_share) + " varnished";
    glint::TrainingMaterialOptions chosen;
    chosen.seed = seed;
    chosen.size = size;
    chosen.pack_share = options.pack_share;
    chosen.glossy_dielectric_share = options.glossy_dielectric_share;
    chosen.one_substance_share = options.one_substance_share;
    chosen.metal_share = options.metal_share;
    chosen.varnish_share = options.varnish_share;
    training = [this, chosen](std::uint64_t k) { return TrainingMaterial(chosen, &pack, k); };
    validation = [size](std::uint64_t k) {
      return glint::MakeMaterial(glint::kReservedSeedBase + kValidationOffset + k, size, size);
    };
  }
};

int Say(const TrainFiles& files, const TrainProgress& last) {
  std::printf("%s: %lld steps, map loss %.4f, validation %.4f\n", files.weights.c_str(),
              static_cast<long long>(last.step), last.map_loss,
              last.validation_map_loss.value_or(0.0));
  return 0;
}

// Folders of pictures to a pack, where glint-synth is not: it needs libraries that read pictures.
struct PackOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
  int size = 512;

  void AddTo(CLI::App* app) {
    app->add_option("folders", folders,
                    "folders of maps as PNM pictures, or folders of such folders")
        ->required()
        ->check(CLI::ExistingDirectory);
    app->add_option("--out", out, "pack to write, ….safetensors")->required();
    app->add_option("--size", size, "texels per side")
        ->check(CLI::Range(8, 8192))
        ->capture_default_str();
  }
};

int Pack(const PackOptions& options) {
  namespace fs = std::filesystem;
  std::vector<fs::path> materials;
  for (const fs::path& folder : options.folders) {
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_directory()) inside.push_back(entry.path());
    }
    std::sort(inside.begin(), inside.end());
    if (inside.empty()) inside.push_back(folder);
    materials.insert(materials.end(), inside.begin(), inside.end());
  }
  glint::MaterialPack pack;
  for (const fs::path& material : materials) {
    pack.push_back(glint::ReadPnmMaterial(material, options.size));
  }
  glint::WriteMaterialPack(options.out, pack);
  std::printf("%s: %zu materials of %d x %d\n", options.out.c_str(), pack.size(), options.size,
              options.size);
  return 0;
}

// `train` is TrainAutoencoder or TrainEstimator.
template <class Options, class Train>
int Run(Options options, const TrainFiles& files, const MaterialOptions& materials, Train train) {
  const Sources sources(materials, options.seed, options.pool.material_size);
  options.data_name = sources.name;
  return Say(files, train(options, files, sources.training, sources.validation, Report));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Trains Glint's networks on procedural and packed materials.", "glint-train");
  app.set_version_flag("--version", GLINT_VERSION);
  app.require_subcommand(1);
  // Of an option given twice the later one counts: scripts append to their own.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  AutoencoderTrainOptions autoencoder_options;
  EstimatorTrainOptions estimator_options;
  TrainFiles files;
  MaterialOptions materials;
  CLI::App* autoencoder =
      app.add_subcommand("autoencoder", "train the auto-encoder whose latent space glint-fit uses");
  AddCommonOptions(autoencoder, &autoencoder_options, &files);
  AddAutoencoderOptions(autoencoder, &autoencoder_options);
  materials.AddTo(autoencoder);
  CLI::App* estimator = app.add_subcommand("estimator", "train the estimator of the initial maps");
  AddCommonOptions(estimator, &estimator_options, &files);
  AddEstimatorOptions(estimator, &estimator_options);
  materials.AddTo(estimator);
  PackOptions pack_options;
  CLI::App* pack = app.add_subcommand(
      "pack", "pack folders of PNM pictures for --materials; glint-synth pack reads other formats");
  pack_options.AddTo(pack);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (pack->parsed()) return Pack(pack_options);
    if (autoencoder->parsed()) {
      return Run(autoencoder_options, files, materials, glint::TrainAutoencoder);
    }
    return Run(estimator_options, files, materials, glint::TrainEstimator);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "glint-train: error: %s\n", error.what());
    return 1;
  }
}
