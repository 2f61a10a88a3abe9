// The paper's schedule (Gao et al. 2019, section 4.4) against glint-fit and glint-refine: one
// process, the same material, photographs, start and threads.
//
//   bench_schedule [SIZE=256] [WHOLE=128] [PHOTOGRAPHS=20] [ITERATIONS=50] [THREADS=2]
//
// The paper's: eager torch in float32, its network (transposed convolutions, 64 to 512 channels),
// the renderer in tensor operations, all photographs in every iteration; Adam at 1e-3 for 4000
// iterations in latent space and 200 on the maps. At SIZE², seconds per iteration are measured over
// ITERATIONS and multiplied. At WHOLE² the schedule is run to its end in the learned space of
// Glint's own network, so that errors can be compared too; WHOLE = 0 leaves that out.
#include <fmt/format.h>
#include <torch/torch.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "datasets/evaluation/map_error.h"
#include "datasets/procedural/material.h"
#include "datasets/synth/view_set.h"
#include "fitting/autoencoder/network_file.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/estimator.h"
#include "fitting/latent/fit.h"
#include "fitting/refine/correct_views.h"
#include "fitting/refine/refine.h"
#include "fitting/render/render_reference.h"
#include "fitting/weights/find_model.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr std::uint64_t kMaterial = 1'000'000'007;  // of the measuring set
constexpr int kLatentIterations = 4000, kMapIterations = 200;
constexpr int kLevelsOfPaper[] = {512, 512, 256, 128, 64, kEncodedChannels};

// Of the clock on the wall and of the process's threads.
struct Seconds {
  double wall = 0, processor = 0;
};

Seconds Timed(const std::function<void()>& work) {
  const auto now = [] {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return Seconds{std::chrono::duration<double>(wall).count(),
                   static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec)};
  };
  const Seconds began = now();
  work();
  const Seconds ended = now();
  return {ended.wall - began.wall, ended.processor - began.processor};
}

struct Scene {
  SvbrdfMaps truth, start;
  PhotographSet set;
};

Scene MakeScene(int size, int photographs, int threads) {
  Scene scene{MakeMaterial(kMaterial, size, size), {}, {}};
  ViewSetOptions options;
  options.count = photographs;
  const PlannedViews planned = PlanViews(options, 1, size, size);
  scene.set.plane = planned.plane;
  scene.set.convention = planned.convention;
  for (int i = 0; i < photographs; ++i) {
    RectifiedImage image = RenderPlannedView(scene.truth, planned, i, options, threads);
    scene.set.photographs.push_back(
        {planned.views[static_cast<size_t>(i)], true, std::move(image.rgb), std::move(image.mask)});
  }
  const Estimator estimator = Estimator::Load(FindModel(kEstimatorModel));
  PhotographSet first = scene.set;
  first.photographs.resize(1);
  scene.start = estimator.Estimate(first, {}, threads).maps;
  return scene;
}

Tensor TensorOf(const EncodedMaps& maps) {
  return torch::tensor(at::ArrayRef<float>(maps.planes))
      .reshape({1, kEncodedChannels, maps.height, maps.width});
}

// The paper's schedule on one scene.
class PlainSchedule {
 public:
  explicit PlainSchedule(const Scene& scene) {
    const SamplePlane& plane = scene.set.plane;
    batch_.plane = plane;
    batch_.convention = scene.set.convention;
    batch_.views_per_element = static_cast<int>(scene.set.photographs.size());
    std::vector<Tensor> images;
    for (const Photograph& photograph : scene.set.photographs) {
      batch_.views.push_back(photograph.view);
      images.push_back(torch::tensor(at::ArrayRef<float>(photograph.rgb))
                           .reshape({3, plane.height, plane.width}));
    }
    images_ = torch::stack(images).unsqueeze(0);
  }

  // Adam on `unknown` from where it is, `decode` its encoded maps.
  void Descend(Tensor unknown, int iterations, const std::function<Tensor(const Tensor&)>& decode) {
    unknown.set_requires_grad(true);
    torch::optim::AdamOptions rate(1e-3);
    rate.betas({0.5, 0.999});
    torch::optim::Adam adam({unknown}, rate);
    TensorLossOptions ldr;
    ldr.clamp_rendered = true;
    for (int i = 0; i < iterations; ++i) {
      adam.zero_grad();
      const Tensor maps = DecodeTexelsReference(decode(unknown));
      LogLossReference(RenderReference(maps, {}, batch_), images_, {}, ldr).backward();
      adam.step();
    }
    unknown.set_requires_grad(false);
  }

 private:
  ViewBatch batch_;
  Tensor images_;
};

// The paper's decoder with weights drawn at random: its time does not depend on them.
class PaperDecoder {
 public:
  PaperDecoder() {
    for (size_t i = 0; i + 1 < std::size(kLevelsOfPaper); ++i) {
      weights_.push_back(0.02 * torch::randn({kLevelsOfPaper[i], kLevelsOfPaper[i + 1], 4, 4}));
    }
  }
  Tensor operator()(const Tensor& code) const {
    Tensor x = code;
    for (const Tensor& weight : weights_) {
      x = torch::conv_transpose2d(torch::leaky_relu(x, 0.2), weight, {}, 2, 1);
    }
    return torch::tanh(x);
  }

 private:
  std::vector<Tensor> weights_;
};

struct Glint {
  SvbrdfMaps maps;
  Seconds took;
};

Glint FitWithGlint(const Scene& scene, int threads) {
  Glint result;
  const Autoencoder network = Autoencoder::Load(FindModel("autoencoder.safetensors"));
  result.took = Timed([&] {
    FitOptions options = FitOptions::LatentForRefinement();
    options.threads = threads;
    const FitResult fit = FitLatent(scene.set, scene.start, network, options);
    result.maps = Refine(ProblemOf(scene.set), fit.maps, {}, threads).maps;
  });
  return result;
}

void PrintRatio(const Seconds& theirs, const Seconds& ours) {
  std::printf("ratio: %.0f in wall time, %.0f in processor time\n", theirs.wall / ours.wall,
              theirs.processor / ours.processor);
}

void CompareSpeed(int size, int photographs, int iterations, int threads) {
  const Scene scene = MakeScene(size, photographs, threads);
  PlainSchedule plain(scene);
  const PaperDecoder decoder;
  const Tensor code = torch::randn({1, kLevelsOfPaper[0], size / 32, size / 32});
  const auto as_it_is = [](const Tensor& maps) { return maps; };
  Tensor maps = TensorOf(EncodeMaps(scene.start));
  plain.Descend(code.clone(), 2, decoder);  // what torch prepares once
  const Seconds latent = Timed([&] { plain.Descend(code.clone(), iterations, decoder); });
  const Seconds texels = Timed([&] { plain.Descend(maps, iterations, as_it_is); });
  const auto whole = [&](double in_latent, double in_texels) {
    return (kLatentIterations * in_latent + kMapIterations * in_texels) / iterations;
  };
  const Seconds theirs = {whole(latent.wall, texels.wall),
                          whole(latent.processor, texels.processor)};
  const Glint ours = FitWithGlint(scene, threads);
  std::printf("%d x %d, %d photographs, %d threads\n", size, size, photographs, threads);
  std::printf(
      "paper's: %.3f s per iteration in latent space, %.3f s on maps; 4000 and 200: %.0f s\n",
      latent.wall / iterations, texels.wall / iterations, theirs.wall);
  std::printf("glint-fit and glint-refine: %.1f s\n", ours.took.wall);
  PrintRatio(theirs, ours.took);
}

void PrintErrors(const char* name, const Seconds& took, const SvbrdfMaps& maps,
                 const SvbrdfMaps& truth, int threads) {
  const Table1Row errors = EvaluateMaps(maps, truth, threads);
  std::printf("%-8s %8.1f s   maps %.6f   renderings %.6f\n", name, took.wall,
              errors.maps.average(), errors.render);
}

void CompareWhole(int size, int photographs, int threads) {
  const Scene scene = MakeScene(size, photographs, threads);
  const AutoencoderNetwork network = LoadNetwork(FindModel("autoencoder.safetensors"));
  PlainSchedule plain(scene);
  Tensor maps;
  const Seconds theirs = Timed([&] {
    Tensor code;
    {
      const torch::NoGradGuard no_gradient;
      code = network.NormaliseByRunning(
          network.EncodeRaw(TensorOf(EncodeMaps(scene.start)), torch::kFloat32));
    }
    const auto decode = [&](const Tensor& z) { return network.Decode(z, torch::kFloat32); };
    plain.Descend(code, kLatentIterations, decode);
    {
      const torch::NoGradGuard no_gradient;
      maps = decode(code).clone();
    }
    plain.Descend(maps, kMapIterations, [](const Tensor& m) { return m; });
  });
  const Glint ours = FitWithGlint(scene, threads);
  std::printf("%d x %d, %d photographs, both complete, in the same learned space\n", size, size,
              photographs);
  PrintErrors("paper's", theirs, DecodeMaps(CroppedMaps(maps, size, size)), scene.truth, threads);
  PrintErrors("Glint", ours.took, ours.maps, scene.truth, threads);
  PrintRatio(theirs, ours.took);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  const auto argument = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const int photographs = argument(3, 20), threads = argument(5, 2);
  torch::manual_seed(1);
  torch::set_num_threads(threads);
  glint::CompareSpeed(argument(1, 256), photographs, argument(4, 50), threads);
  if (argument(2, 128) > 0) glint::CompareWhole(argument(2, 128), photographs, threads);
}
