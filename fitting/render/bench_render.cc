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
#include <ctime>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
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

// Milliseconds by the wall's clock, and of processor time over all threads.
struct Times {
  double wall = 0, processor = 0;
};

Times Measure(const std::function<void()>& run) {
  const std::clock_t processor_start = std::clock();
  const auto start = std::chrono::steady_clock::now();
  run();
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), 1e3 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC};
}

Times Median(std::vector<Times> times) {
  const size_t middle = times.size() / 2;
  Times median;
  std::sort(times.begin(), times.end(), [](auto& a, auto& b) { return a.wall < b.wall; });
  median.wall = times[middle].wall;
  std::sort(times.begin(), times.end(), [](auto& a, auto& b) { return a.processor < b.processor; });
  median.processor = times[middle].processor;
  return median;
}

// Medians of kRepeats after two unmeasured calls. Not in turn with other work: the memory that goes
// back to the system after a call of one side would be counted at the other's.
Times MedianTimes(const std::function<void()>& run) {
  malloc_trim(0);
  std::vector<Times> times;
  run();
  run();
  for (int i = 0; i < kRepeats; ++i) times.push_back(Measure(run));
  return Median(times);
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
  malloc_trim(0);
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
  const Times fused_times = MedianTimes(fused), torch_times = MedianTimes(reference);
  std::printf("%dx%d, %d views, %d thread%s, %s: forward + adjoint, median of %d\n", size, size,
              views, threads, threads == 1 ? "" : "s", Name(BestInstructionSet()), kRepeats);
  std::printf("                      wall ms   processor ms   loss\n");
  std::printf("  torch operations %10.2f %14.2f   %.7f\n", torch_times.wall, torch_times.processor,
              reference_loss);
  std::printf("  fused kernel     %10.2f %14.2f   %.7f  (%.2f ns per texel and view)\n",
              fused_times.wall, fused_times.processor, fused_loss,
              fused_times.wall * 1e6 / (static_cast<double>(size) * size * views));
  std::printf("  ratio            %10.1f %14.1f\n", torch_times.wall / fused_times.wall,
              torch_times.processor / fused_times.processor);
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
