// Speed of training the auto-encoder against a plain loop of the same losses in torch operations:
// float32, torch's own layouts, transposed convolutions, the renderer in tensor operations. One
// process, the same number of threads, the same network, batch and views.
//
//   bench_training [THREADS=1] [VIEWS=9] [CROP=128] [BATCH=8]
#include <torch/torch.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

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

constexpr int kSteps = 12;
constexpr std::uint64_t kFirstMaterial = 10'000'019;

SvbrdfMaps Material(std::uint64_t k) { return MakeMaterial(kFirstMaterial + k, 256, 256); }

AutoencoderTrainOptions Options(int threads, int views, int crop, int batch) {
  AutoencoderTrainOptions options;
  options.channels = {32, 64, 128, 256, 384};
  options.steps = kSteps;
  options.batch = batch;
  options.crop = crop;
  options.render_views = views;
  options.threads = threads;
  options.principal_start = false;
  options.pool.window = options.pool.first = 24;
  options.pool.per_step = 0;
  return options;
}

// Samples per second of glint-train's own loop, the first steps aside.
double OursPerSecond(const AutoencoderTrainOptions& given) {
  const auto folder = std::filesystem::temp_directory_path() / "glint-bench-training";
  std::filesystem::create_directories(folder);
  AutoencoderTrainOptions options = given;
  const TrainFiles files{folder / "w.safetensors", {}, {}, false};
  options.steps = 2;
  TrainAutoencoder(options, files, Material, Material, {});  // what torch prepares once
  const double short_seconds = TrainAutoencoder(options, files, Material, Material, {}).seconds;
  options.steps = 2 + kSteps;
  const double long_seconds = TrainAutoencoder(options, files, Material, Material, {}).seconds;
  std::filesystem::remove_all(folder);
  return kSteps * given.batch / (long_seconds - short_seconds);
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
    batch.plane = {options_.crop, options_.crop, 2.0, 2.0, TexelSampling::kPixelCentres};
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

double PlainPerSecond(const AutoencoderTrainOptions& options) {
  torch::set_num_threads(options.threads);
  MapBatches batches(options, Material, 0);
  PlainTraining training(options);
  training.Step(batches.Sample(0), 0);  // what torch prepares once
  const auto began = std::chrono::steady_clock::now();
  for (int step = 1; step <= kSteps; ++step) {
    training.Step(batches.Sample(step), static_cast<std::uint64_t>(step));
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
  return kSteps * options.batch / seconds.count();
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  const auto argument = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const auto options =
      glint::Options(argument(1, 1), argument(2, 9), argument(3, 128), argument(4, 8));
  const double ours = glint::OursPerSecond(options);
  const double plain = glint::PlainPerSecond(options);
  std::printf("glint-train's loop            %8.1f samples/s\n", ours);
  std::printf("plain float32 torch, eager    %8.1f samples/s\n", plain);
  std::printf("ratio %.1f (wanted: 5 or more)\n", ours / plain);
}
