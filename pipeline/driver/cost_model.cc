#include "pipeline/driver/cost_model.h"

#include "pipeline/contract/errors.h"
#include "pipeline/contract/image.h"

namespace glint {
namespace {

// A stage's work is a sum of parts; microseconds of each. Measured on 12 photographs of
// 12 megapixels at 512², 1024² and 2048² (docs/experiments.md, "How long a run takes").
struct StageCost {
  const char* stage;
  double start_s;              // programs, weights, files
  double photograph_px_us;     // per pixel of every photograph
  double texel_us;             // per texel
  double photograph_texel_us;  // per texel of every photograph
};

constexpr StageCost kCosts[] = {
    {"calib", 0.3, 0.042, 0, 0},   {"rectify", 0.2, 0.012, 0, 0.40}, {"fit", 7.5, 0, 6.7, 0},
    {"refine", 1.5, 0, 6.0, 0.6},  {"tile", 0.2, 0, 2.0, 0},         {"export", 0.3, 0, 17, 0},
    {"report", 1.5, 0, 2.0, 0.35},
};

}  // namespace

CaptureSize SizeOf(const Capture& capture) {
  CaptureSize size;
  size.texels = static_cast<double>(capture.resolution_px[0]) * capture.resolution_px[1];
  size.photographs = static_cast<int>(capture.photos.size());
  if (capture.imported() || capture.photos.empty()) return size;
  try {
    const auto [width, height] = PhotoSize(capture.folder / capture.photos.front());
    size.photograph_px = static_cast<double>(width) * height;
  } catch (const Error&) {
    // The stage that reads it will say so.
  }
  return size;
}

double PredictedSeconds(const std::string& stage, const CaptureSize& size) {
  constexpr double kMicro = 1e-6;
  for (const StageCost& cost : kCosts) {
    if (stage != cost.stage) continue;
    return cost.start_s + kMicro * (cost.photograph_px_us * size.photographs * size.photograph_px +
                                    cost.texel_us * size.texels +
                                    cost.photograph_texel_us * size.photographs * size.texels);
  }
  return 0;
}

}  // namespace glint
