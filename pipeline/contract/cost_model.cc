#include "pipeline/contract/cost_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/cpu/instruction_set.h"
#include "pipeline/contract/errors.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/memory_limit.h"
#include "pipeline/contract/rectified_set.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// A stage's work and memory are sums of parts. Fitted to five captures of 5 to 12 photographs of 2
// and 12 megapixels at 256² to 2048², on two cores of a Xeon with AVX-512 and without bfloat16
// (docs/experiments.md, "How long a run takes"); one with bfloat16 took about 0.6 of the time.
struct StageCost {
  const char* stage;
  double start_s;              // programs, weights, files
  double network_s;            // in the networks; twice as long without bfloat16
  double photograph_px_us;     // per pixel of every photograph
  double texel_us;             // per texel
  double photograph_texel_us;  // per texel of every photograph
  double start_bytes;
  double decoded_px_bytes;        // per pixel of the photographs that are decoded at once
  double texel_bytes;             // per texel
  double photograph_texel_bytes;  // per texel of every photograph
};

constexpr double kMega = 1e6;
constexpr StageCost kCosts[] = {
    {"calib", 2.6, 0, 0.046, 0, 0, 200 * kMega, 15, 0, 0},
    {"rectify", 0.6, 0, 0.02, 0, 0.5, 170 * kMega, 8, 0, 5},
    {"fit", 1, 11.5, 0, 2, 0, 330 * kMega, 0, 146, 17},
    {"start", 0.6, 0.3, 0, 2, 0.2, 330 * kMega, 0, 146, 17},
    {"refine", 2.5, 0, 0, 22, 0.4, 140 * kMega, 0, 226, 16},
    {"tile", 0.2, 0, 0, 3.2, 0, 140 * kMega, 0, 300, 0},
    {"export", 0.8, 0, 0, 8, 0, 136 * kMega, 0, 210, 0},
    {"report", 1.6, 0, 0, 7, 0.25, 280 * kMega, 0, 130, 3},
};

const StageCost* CostOf(const std::string& stage) {
  for (const StageCost& cost : kCosts) {
    if (stage == cost.stage) return &cost;
  }
  return nullptr;
}

}  // namespace

CaptureSize SizeOf(const Capture& capture) {
  CaptureSize size;
  size.texels = static_cast<double>(capture.resolution_px[0]) * capture.resolution_px[1];
  size.photographs = static_cast<int>(capture.photos.size());
  size.native_bfloat16 = NativeBfloat16();
  try {
    if (capture.imported()) {
      const fs::path manifest = capture.work() / "rectify" / "manifest.json";
      if (!fs::exists(manifest)) return size;
      const RectifiedSet set = ReadRectifiedSet(manifest);
      size.texels = static_cast<double>(set.plane.width) * set.plane.height;
      size.photographs = static_cast<int>(set.views.size());
      return size;
    }
    if (capture.photos.empty()) return size;
    const auto [width, height] = PhotoSize(capture.folder / capture.photos.front());
    size.photograph_px = static_cast<double>(width) * height;
  } catch (const Error&) {
    // The stage that reads it will say so.
  }
  return size;
}

double PredictedSeconds(const std::string& stage, const CaptureSize& size) {
  constexpr double kMicro = 1e-6;
  const StageCost* cost = CostOf(stage);
  if (cost == nullptr) return 0;
  const double network_s = (size.native_bfloat16 ? 1 : 2) * cost->network_s;
  return cost->start_s + network_s +
         kMicro * (cost->photograph_px_us * size.photographs * size.photograph_px +
                   cost->texel_us * size.texels +
                   cost->photograph_texel_us * size.photographs * size.texels);
}

double PredictedMemory_bytes(const std::string& stage, const CaptureSize& size, int threads) {
  const StageCost* cost = CostOf(stage);
  if (cost == nullptr) return 0;
  return cost->start_bytes +
         cost->decoded_px_bytes * std::min(threads, size.photographs) * size.photograph_px +
         cost->texel_bytes * size.texels +
         cost->photograph_texel_bytes * size.photographs * size.texels;
}

void RequireMemoryForStage(const std::string& stage, const Capture& capture, int threads) {
  const CaptureSize size = SizeOf(capture);
  const double needed = PredictedMemory_bytes(stage, size, threads);
  const auto limit = static_cast<double>(MemoryLimit_bytes());
  if (needed <= limit) return;
  throw EnvironmentError(fmt::format(
      "{}: glint-{} would need about {} of memory for {:.3g} million texels and {} photographs, "
      "more than "
      "the {} that it may use (--memory); reduce sample.resolution_px, or run it on a machine with "
      "more memory",
      capture.file.string(), stage, MemoryText(needed), size.texels / kMega, size.photographs,
      MemoryText(limit)));
}

}  // namespace glint
