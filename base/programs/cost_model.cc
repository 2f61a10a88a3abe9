#include "base/programs/cost_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/cpu/instruction_set.h"
#include "base/errors/errors.h"
#include "base/files/memory_limit.h"
#include "base/formats/rectified_set.h"
#include "base/stages/stages.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kMega = 1e6;

// Refinement looks at fewer texels for wrong views where photographs are more (kViewsOfAllSamples,
// fitting/view_correction).
constexpr int kMostPaired = 40;

// The estimator sees photographs at 256² at most (StageCost::network_texel_bytes).
constexpr double kNetworkTexels = 256 * 256;

// Stage fit with the method "initial": no fitting.
constexpr StageCost kInitialMaps = {0.6, 0, 0.3, 0, 2, 0.2, 330, 0, 146, 17, 0};

const StageCost* CostOf(const std::string& stage) {
  if (stage == "initial") return &kInitialMaps;
  const StageKind* kind = FindStage(stage);
  return kind == nullptr ? nullptr : &kind->cost;
}

}  // namespace

CaptureSize SizeOfMaps(const Capture& capture) {
  CaptureSize size;
  size.texels = static_cast<double>(capture.resolution_px[0]) * capture.resolution_px[1];
  size.photographs = static_cast<int>(capture.photos.size());
  size.native_bfloat16 = NativeBfloat16();
  try {
    if (!capture.imported()) return size;
    const fs::path manifest = ViewsManifest(capture.work());
    if (!fs::exists(manifest)) return size;
    const RectifiedSet set = ReadRectifiedSet(manifest);
    size.texels = static_cast<double>(set.plane.width) * set.plane.height;
    size.photographs = static_cast<int>(set.views.size());
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
  const int alike = std::min(size.photographs, kMostPaired);
  return cost->start_s + network_s + cost->photograph_pair_s * alike * alike +
         kMicro * (cost->photograph_px_us * size.photographs * size.photograph_px +
                   cost->texel_us * size.texels +
                   cost->photograph_texel_us * size.photographs * size.texels);
}

double PredictedMemory_bytes(const std::string& stage, const CaptureSize& size, int threads) {
  const StageCost* cost = CostOf(stage);
  if (cost == nullptr) return 0;
  const double texels = cost->texel_bytes * size.texels +
                        cost->photograph_texel_bytes * size.photographs * size.texels;
  return kMega * (cost->start_MB + cost->photograph_MB * size.photographs) +
         cost->decoded_px_bytes * std::min(threads, size.photographs) * size.photograph_px +
         (cost->most_MB > 0 ? std::min(texels, kMega * cost->most_MB) : texels) +
         cost->network_texel_bytes * size.photographs * std::min(size.texels, kNetworkTexels);
}

void RequireMemoryForStage(const std::string& stage, const Capture& capture,
                           const CaptureSize& size, int threads) {
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
