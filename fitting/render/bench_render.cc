// Speed and memory of the fused renderer against the same loss in torch operations: forward and
// adjoint of eq. 2 over many views, in one process, on the same number of threads.
//
//   bench_render [THREADS=1] [SIZE=256] [VIEWS=20]
#include <malloc.h>
#include <torch/torch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "fitting/reflectance/svbrdf_maps.h"
#include "fitting/render/fused_loss.h"
#include "fitting/render/kernel.h"
#include "fitting/render/render_autograd.h"
#include "fitting/render/render_reference.h"

namespace glint {
namespace {

constexpr int kRepeats = 5;

struct Problem {
  ViewBatch batch;
  torch::Tensor maps, images;
};

Problem MakeProblem(int size, int views) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> jitter(-kDirJitter, kDirJitter);
  Problem problem;
  problem.batch.convention = ReflectanceConvention::Dir2019();
  problem.batch.plane = {size, size, 2.0, 2.0, problem.batch.convention.sampling};
  problem.batch.views_per_element = views;
  for (int v = 0; v < views; ++v) {
    problem.batch.views.push_back(DirView(jitter(engine), jitter(engine)));
  }
  torch::manual_seed(1);
  problem.maps = 0.05 + 0.9 * torch::rand({1, kSvbrdfPlanes, size, size});
  const torch::Tensor normal =
      torch::cat({0.6 * torch::rand({1, 2, size, size}) - 0.3, torch::ones({1, 1, size, size})}, 1);
  problem.maps.slice(1, 0, 3) = normal / normal.norm(2, 1, true);
  problem.images = torch::rand({1, views, 3, size, size});
  return problem;
}

double Milliseconds(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  return spent.count();
}

// Medians of kRepeats after one unmeasured call of each; in turn, so that both meet the same
// machine.
std::pair<double, double> MedianMilliseconds(const std::function<void()>& first,
                                             const std::function<void()>& second) {
  std::vector<double> first_times, second_times;
  for (int i = 0; i <= kRepeats; ++i) {
    const double first_time = Milliseconds(first), second_time = Milliseconds(second);
    if (i == 0) continue;
    first_times.push_back(first_time);
    second_times.push_back(second_time);
  }
  std::sort(first_times.begin(), first_times.end());
  std::sort(second_times.begin(), second_times.end());
  return {first_times[kRepeats / 2], second_times[kRepeats / 2]};
}

double LossAndBackward(const Problem& problem,
                       const std::function<torch::Tensor(const torch::Tensor&)>& loss_of) {
  const torch::Tensor maps = problem.maps.detach().requires_grad_();
  const torch::Tensor loss = loss_of(maps);
  loss.backward();
  return loss.item<double>();
}

// A field of /proc/self/status in MiB, such as VmRSS and VmHWM (its peak); −1 where there is none.
double StatusMiB(const std::string& field) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind(field + ":", 0) == 0) return std::atof(line.c_str() + field.size() + 1) / 1024;
  }
  return -1;
}

void ResetPeak() { std::ofstream("/proc/self/clear_refs") << "5"; }

// Peak memory above what is held before the call: the maps and images are there already.
double PeakGrowthMiB(const std::function<void()>& run) {
  ResetPeak();
  const double before = StatusMiB("VmRSS");
  run();
  return StatusMiB("VmHWM") - before;
}

void CompareSpeed(int threads, int size, int views) {
  const Problem problem = MakeProblem(size, views);
  const TensorLossOptions options;
  double reference_loss = 0, fused_loss = 0;
  const auto reference = [&] {
    reference_loss = LossAndBackward(problem, [&](const torch::Tensor& maps) {
      return LogLossReference(RenderReference(maps, {}, problem.batch), problem.images, {},
                              options);
    });
  };
  const auto fused = [&] {
    fused_loss = LossAndBackward(problem, [&](const torch::Tensor& maps) {
      return LogLossBatch(maps, problem.images, {}, {}, problem.batch, options);
    });
  };
  const auto [reference_ms, fused_ms] = MedianMilliseconds(reference, fused);
  std::printf("%dx%d, %d views, %d thread%s, %s: forward + adjoint, median of %d\n", size, size,
              views, threads, threads == 1 ? "" : "s", kernel::Name(kernel::BestInstructionSet()),
              kRepeats);
  std::printf("  torch operations %9.2f ms  (loss %.7f)\n", reference_ms, reference_loss);
  std::printf("  fused kernel     %9.2f ms  (loss %.7f), %.2f ns per texel and view\n", fused_ms,
              fused_loss, fused_ms * 1e6 / (static_cast<double>(size) * size * views));
  std::printf("  ratio            %9.1f\n", reference_ms / fused_ms);
}

void CompareMemory(int threads, int size) {
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // maps and images go back to the system when freed
  std::printf("peak memory above maps and images, MiB:\n   views    fused     torch\n");
  for (const int views : {5, 20, 80}) {
    const Problem problem = MakeProblem(size, views);
    SvbrdfMaps maps(size, size);
    std::copy_n(problem.maps.data_ptr<float>(), maps.planes.size(), maps.planes.begin());
    std::vector<ViewImages> images;
    for (int v = 0; v < views; ++v) {
      images.push_back({problem.batch.views[v],
                        problem.images.data_ptr<float>() + v * 3 * maps.texels(), nullptr});
    }
    LogLossOptions options;
    options.threads = threads;
    const double fused = PeakGrowthMiB([&] {
      EvaluateLogLoss(maps, problem.batch.plane, images, problem.batch.convention, options);
    });
    const double reference = PeakGrowthMiB([&] {
      LossAndBackward(problem, [&](const torch::Tensor& tensor) {
        return LogLossReference(RenderReference(tensor, {}, problem.batch), problem.images, {}, {});
      });
    });
    std::printf("   %5d %8.1f  %8.1f\n", views, fused, reference);
  }
}

int Main(int argc, char** argv) {
  const int threads = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1;
  const int size = argc > 2 ? std::max(1, std::atoi(argv[2])) : 256;
  const int views = argc > 3 ? std::max(1, std::atoi(argv[3])) : 20;
  torch::set_num_threads(threads);
  CompareSpeed(threads, size, views);
  CompareMemory(threads, size);
  return 0;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) { return glint::Main(argc, argv); }
