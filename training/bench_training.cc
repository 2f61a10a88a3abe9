// Speed of training the auto-encoder against a plain loop of the same losses in torch operations:
// float32, torch's own layouts, transposed convolutions, the renderer in tensor operations. One
// process, the same number of threads, the same network, batch and views; the ratio of processor
// times hardly suffers from what else the machine does.
//
//   bench_training [THREADS=1] [VIEWS=9] [CROP=128] [BATCH=8] [TURNS=3]
//
// And the speed of training the estimator as training/gpu_run.sh does, on procedural materials made
// meanwhile: samples a second, and the share of the time that it waits for data.
//
//   bench_training estimator [DEVICE=cpu] [BATCH=16] [PHOTOGRAPHS=32] [POOL_THREADS=1] [SECONDS=60]
//   [NETWORK=pooled]
#include <torch/torch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/procedural/material.h"
#include "fitting/encoding/encoding.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/layers/layers.h"
#include "fitting/render/render_reference.h"
#include "training/autoencoder_trainer.h"
#include "training/estimator_trainer.h"
#include "training/map_batches.h"
#include "training/random.h"
#include "training/render_loss.h"
#include "training/training_materials.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kSteps = 12;             // of a turn of the plain loop
constexpr int kOurSteps = 4 * kSteps;  // of ours: told from what begins and ends a training
constexpr std::uint64_t kFirstMaterial = 10'000'019;
constexpr std::uint64_t kMaterials = 24;

// Made once: materials are not what is measured.
SvbrdfMaps Material(std::uint64_t k) {
  static const std::vector<SvbrdfMaps> made = [] {
    std::vector<SvbrdfMaps> list;
    for (std::uint64_t i = 0; i < kMaterials; ++i) {
      list.push_back(MakeMaterial(kFirstMaterial + i, 256, 256));
    }
    return list;
  }();
  return made[k % kMaterials];
}

// Seconds of the clock on the wall and of the process's threads.
struct Seconds {
  double wall = 0, processor = 0;
  static Seconds Now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {std::chrono::duration<double>(wall).count(),
            static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec)};
  }
  friend Seconds operator-(const Seconds& a, const Seconds& b) {
    return {a.wall - b.wall, a.processor - b.processor};
  }
};

AutoencoderTrainOptions Options(int threads, int views, int crop, int batch) {
  AutoencoderTrainOptions options;
  options.channels = {32, 64, 128, 256, 384};
  options.steps = kSteps;
  options.batch = batch;
  options.crops = {crop};
  options.render_views = views;
  options.threads = threads;
  options.principal_start = false;
  options.pool.window = options.pool.first = kMaterials;
  options.pool.per_step = 0;
  return options;
}

// A training of `steps`, from weights to file.
Seconds TrainFor(int steps, AutoencoderTrainOptions options) {
  const auto folder = std::filesystem::temp_directory_path() / "glint-bench-training";
  std::filesystem::create_directories(folder);
  options.steps = steps;
  const Seconds began = Seconds::Now();
  TrainAutoencoder(options, {folder / "w.safetensors", {}, {}, false}, Material, Material, {});
  const Seconds took = Seconds::Now() - began;
  std::filesystem::remove_all(folder);
  return took;
}

// kOurSteps of glint-train's own loop: what a longer training takes more than a short one.
Seconds OurTurn(const AutoencoderTrainOptions& options) {
  const Seconds shorter = TrainFor(2, options);
  return TrainFor(2 + kOurSteps, options) - shorter;
}

// The same network and losses as a plain torch program has them.
class PlainTraining {
 public:
  explicit PlainTraining(const AutoencoderTrainOptions& options) : options_(options) {
    int in = kEncodedChannels;
    for (const int out : options.channels) {
      Add(torch::randn({out, in, 4, 4}) * 0.05, out);
      in = out;
    }
    for (int i = 4; i >= 0; --i) {
      const int out = i > 0 ? options.channels[static_cast<size_t>(i) - 1] : kEncodedChannels;
      Add(torch::randn({in, out, 4, 4}) * 0.05, out);
      in = out;
    }
    torch::optim::AdamOptions adam(1e-4);
    adam.betas({0.5, 0.999});
    optimiser_ = std::make_unique<torch::optim::Adam>(parameters_, adam);
  }

  void Step(const Tensor& batch, std::uint64_t step) {
    optimiser_->zero_grad();
    const int64_t count = batch.size(0), twice = count / 2;
    Tensor x = batch;
    for (size_t i = 0; i < 5; ++i) {
      if (i > 0) x = torch::leaky_relu(x, kLeak);
      x = torch::conv2d(x, parameters_[2 * i], parameters_[2 * i + 1], 2, 1);
    }
    const Tensor z = torch::batch_norm(x, {}, {}, {}, {}, true, 0.1, 1e-5, false);
    const Tensor part = z.slice(0, 0, twice);
    x = torch::cat({z, part + 0.447 * torch::randn_like(part)}, 0);
    for (size_t i = 5; i < 10; ++i) {
      x = torch::conv_transpose2d(torch::leaky_relu(x, kLeak), parameters_[2 * i],
                                  parameters_[2 * i + 1], 2, 1);
    }
    const Tensor decoded = torch::tanh(x);
    const Tensor plain = decoded.slice(0, 0, count);
    const Tensor loss =
        (plain - batch).abs().mean() +
        options_.smoothness *
            (decoded.slice(0, count, count + twice) - decoded.slice(0, 0, twice)).abs().mean() +
        options_.render_weight * RenderLoss(plain, batch, step);
    loss.backward();
    optimiser_->step();
  }

 private:
  void Add(Tensor weight, int out) {
    parameters_.push_back(weight.set_requires_grad(true));
    parameters_.push_back(torch::zeros({out}).set_requires_grad(true));
  }

  Tensor RenderLoss(const Tensor& decoded, const Tensor& truth, std::uint64_t step) const {
    ViewBatch batch;
    batch.plane = {options_.crops[0], options_.crops[0], 2.0, 2.0, TexelSampling::kPixelCentres};
    batch.convention = {DiffuseWeight::kOne, LightFalloff::kNone, TexelSampling::kPixelCentres};
    batch.views_per_element = options_.render_views;
    Stream random(step);
    for (int64_t b = 0; b < truth.size(0); ++b) {
      const auto views = DrawRenderLossViews(&random, options_.render_views);
      batch.views.insert(batch.views.end(), views.begin(), views.end());
    }
    Tensor images;
    {
      torch::NoGradGuard no_gradient;
      images = RenderReference(DecodeTexelsReference(truth), {}, batch);
    }
    return LogLossReference(RenderReference(DecodeTexelsReference(decoded), {}, batch), images, {},
                            {});
  }

  AutoencoderTrainOptions options_;
  std::vector<Tensor> parameters_;
  std::unique_ptr<torch::optim::Adam> optimiser_;
};

class PlainTurns {
 public:
  explicit PlainTurns(const AutoencoderTrainOptions& options)
      : batches_(options, Material, 0), training_(options) {
    Steps(1);  // what torch prepares once
  }
  Seconds Turn() {
    const Seconds began = Seconds::Now();
    Steps(kSteps);
    return Seconds::Now() - began;
  }

 private:
  void Steps(int count) {
    for (int i = 0; i < count; ++i, ++step_) {
      training_.Step(batches_.Sample(step_), static_cast<std::uint64_t>(step_));
    }
  }
  MapBatches batches_;
  PlainTraining training_;
  std::int64_t step_ = 0;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Samples a second of each turn, by the processor's and by the wall's clock.
struct Rates {
  std::vector<double> processor, wall;
  void Add(const char* name, double samples, const Seconds& took) {
    processor.push_back(samples / took.processor);
    wall.push_back(samples / took.wall);
    std::printf("%-6s %8.1f samples a second of processor time, %8.1f on the wall\n", name,
                processor.back(), wall.back());
  }
};

void Run(const AutoencoderTrainOptions& options, int turns) {
  torch::set_num_threads(options.threads);
  Rates theirs, ours;
  PlainTurns plain(options);
  OurTurn(options);  // what torch prepares once
  for (int turn = 0; turn < turns; ++turn) {
    theirs.Add("plain", kSteps * options.batch, plain.Turn());
    ours.Add("ours", kOurSteps * options.batch, OurTurn(options));
  }
  std::printf("ratio of medians: %.1f by processor time, %.1f on the wall (target: 5 or more)\n",
              Median(ours.processor) / Median(theirs.processor),
              Median(ours.wall) / Median(theirs.wall));
}

struct EstimatorBench {
  std::string device = "cpu";
  int batch = 16, photographs = 32, pool_threads = 1, seconds = 60;
  std::string network = "pooled";
};

void RunEstimator(const EstimatorBench& bench) {
  EstimatorTrainOptions options;
  options.device = bench.device;
  options.batch = bench.batch;
  options.batch_photographs = bench.photographs;
  options.network = bench.network;
  options.minutes = bench.seconds / 60.0;
  options.report_seconds = bench.seconds / 6.0;
  options.checkpoint_minutes = 1e9;
  options.supervise = true;
  options.pool.threads = bench.pool_threads;
  options.pool.first = 64;
  options.pool.window = 6000;
  options.pool.per_step = 2;
  TrainingMaterialOptions materials;
  materials.glossy_dielectric_share = 0.2;
  materials.one_substance_share = 0.25;
  materials.metal_share = 0.1;
  materials.varnish_share = 0.5;
  const auto folder = std::filesystem::temp_directory_path() / "glint-bench-training";
  std::filesystem::create_directories(folder);
  const auto source = [&](std::uint64_t k) { return TrainingMaterial(materials, nullptr, k); };
  int lines = 0;
  TrainEstimator(options, {folder / "e.safetensors", {}, {}, false}, source, Material,
                 [&](const TrainProgress& p) {
                   if (++lines <= 2) return;  // what is prepared once
                   std::printf("%8.1f samples a second, %3.0f %% of the time waiting for data\n",
                               p.samples_per_second, 100 * p.wait_share);
                 });
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  const auto argument = [&](int i, int otherwise) {
    return argc > i ? std::max(1, std::atoi(argv[i])) : otherwise;
  };
  if (argc > 1 && std::string(argv[1]) == "estimator") {
    glint::EstimatorBench bench;
    if (argc > 2) bench.device = argv[2];
    bench.batch = argument(3, bench.batch);
    bench.photographs = argument(4, bench.photographs);
    bench.pool_threads = argument(5, bench.pool_threads);
    bench.seconds = argument(6, bench.seconds);
    if (argc > 7) bench.network = argv[7];
    glint::RunEstimator(bench);
    return 0;
  }
  glint::Run(glint::Options(argument(1, 1), argument(2, 9), argument(3, 128), argument(4, 8)),
             argument(5, 3));
}
