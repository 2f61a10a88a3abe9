// Speed of training the auto-encoder against a plain loop of the same losses in torch operations:
// float32, torch's own layouts, transposed convolutions, the renderer in tensor operations. One
// process, the same number of threads, the same network, batch and views; the ratio of processor
// times hardly suffers from what else the machine does.
//
//   bench_training [THREADS=1] [VIEWS=9] [CROP=128] [BATCH=8] [TURNS=3]
#include <torch/torch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <vector>

#include "datasets/procedural/material.h"
#include "fitting/encoding/encoding.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/layers/layers.h"
#include "fitting/render/render_reference.h"
#include "fitting/training/autoencoder_trainer.h"
#include "fitting/training/map_batches.h"
#include "fitting/training/random.h"
#include "fitting/training/render_loss.h"

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

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  const auto argument = [&](int i, int otherwise) {
    return argc > i ? std::max(1, std::atoi(argv[i])) : otherwise;
  };
  glint::Run(glint::Options(argument(1, 1), argument(2, 9), argument(3, 128), argument(4, 8)),
             argument(5, 3));
}
