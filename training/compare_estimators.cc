// How well trained estimators do on captures like those of their training, of materials that no
// training sees: L1 of encoded maps and log-L1 of renderings, by number of photographs. The same
// captures for every file.
//
//   compare_estimators [--materials=48] [--size=128] [--threads=1] FILE.safetensors …
#include <torch/torch.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "datasets/procedural/material.h"
#include "fitting/encoding/encoding.h"
#include "fitting/estimator/estimator_file.h"
#include "fitting/layers/threads.h"
#include "training/map_losses.h"
#include "training/training_materials.h"
#include "training/training_photographs.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr std::uint64_t kCaptureStream = 0x5EED0006;
constexpr std::array kCounts = {1, 2, 5};

// Materials with the odds that trainings are given, of a seed that none should have.
Tensor Materials(int count, int size) {
  TrainingMaterialOptions options;
  options.seed = 77'777;
  options.size = size;
  options.glossy_dielectric_share = 0.2;
  options.one_substance_share = 0.25;
  options.metal_share = 0.1;
  options.varnish_share = 0.5;
  std::vector<Tensor> list;
  for (int k = 0; k < count; ++k) {
    const EncodedMaps maps =
        EncodeMaps(TrainingMaterial(options, nullptr, static_cast<std::uint64_t>(k)));
    list.push_back(torch::tensor(maps.planes).view({1, kEncodedChannels, size, size}));
  }
  return torch::cat(list);
}

struct Errors {
  double maps = 0, renderings = 0, roughness = 0;
};

Errors Evaluate(const EstimatorNetwork& network, const Tensor& materials, int photographs) {
  torch::NoGradGuard no_gradient;
  TrainOptions loss;
  loss.render_views = 6;
  Errors sum;
  const int64_t count = materials.size(0);
  for (int64_t k = 0; k < count; ++k) {
    const Tensor truth = materials.slice(0, k, k + 1);
    Stream random(StreamSeed(kCaptureStream, static_cast<std::uint64_t>(k)));
    const CaptureBatch seen = PhotographMaps(truth, photographs, CaptureQuality::kDrawn, &random);
    const Tensor maps =
        network.Forward(seen.features, seen.profiles, seen.conditions, torch::kFloat32).maps;
    const Tensor error = (maps - truth).abs();
    sum.maps += error.mean().item<double>();
    sum.roughness += error.select(1, kEncodedRoughness).mean().item<double>();
    sum.renderings += RenderLossOf(maps, truth, loss, k).item<double>();
  }
  const auto n = static_cast<double>(count);
  return {sum.maps / n, sum.renderings / n, sum.roughness / n};
}

int OptionOf(const std::string& argument, const std::string& name, int otherwise) {
  const std::string start = "--" + name + "=";
  return argument.starts_with(start) ? std::atoi(argument.c_str() + start.size()) : otherwise;
}

int Run(const std::vector<std::string>& arguments) {
  int materials = 48, size = 128, threads = 1;
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    materials = OptionOf(argument, "materials", materials);
    size = OptionOf(argument, "size", size);
    threads = OptionOf(argument, "threads", threads);
    if (!argument.starts_with("--")) files.push_back(argument);
  }
  UseThreads(threads);
  const Tensor truth = Materials(materials, size);
  std::printf("%-32s %3s %8s %10s %10s\n", "file", "N", "maps", "roughness", "renderings");
  for (const std::string& file : files) {
    const EstimatorNetwork network = LoadEstimator(file);
    for (const int photographs : kCounts) {
      const Errors errors = Evaluate(network, truth, photographs);
      std::printf("%-32s %3d %8.4f %10.4f %10.4f\n", file.c_str(), photographs, errors.maps,
                  errors.roughness, errors.renderings);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  try {
    return glint::Run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_estimators: %s\n", error.what());
    return 1;
  }
}
