#include "rectify/views/rectify_options.h"

#include <cmath>

#include "base/errors/errors.h"

namespace glint {
namespace {
constexpr int kMinResolution_px = 8;
constexpr int kMaxResolution_px = 16384;
}  // namespace

void AddRectifyOptions(OptionSet* set, RectifyOptions* options) {
  set->AddRange("resolution", &options->resolution, 0, kMaxResolution_px,
                "width of the views in texels; 0: use [sample] resolution_px");
  set->AddChoice(
      "filter", &options->filter, {"sharp", "soft", "lanczos"},
      "resampling kernel: sharp, soft (least ringing) or lanczos (best low-pass, slower)");
  set->AddRange("saturation-level", &options->saturation_level, 0.5, 1.01,
                "stored value (full scale is 1) at or above which a pixel of an 8- or 16-bit "
                "photograph counts as clipped; above 1: never");
  set->AddRange("float-saturation-level", &options->float_saturation_level, 0, 1e9,
                "the same for float photographs; 0: they never clip");
  set->AddChoice(
      "exposure", &options->exposure, {"calib", "exif", "equal"},
      "relative exposure of the photographs; calib: as estimated by calib, or as for exif if "
      "calib estimated none; exif: from EXIF if all photographs have it; equal: the same for all");
  set->AddRange(
      "frame-height-mm", &options->frame_height_mm, 0, 100,
      "thickness of the board around the sample; texels that it shadows or hides are masked");
  set->AddRange("frame-margin-mm", &options->frame_margin_mm, 0, 1000,
                "width of the strip along the inside of the window's edge that is masked");
}

RectifyTask ResolveTask(const Capture& capture, const RectifyOptions& options) {
  RectifyTask task;
  task.sample_size_mm = {capture.sample_size_mm[0], capture.sample_size_mm[1]};
  int width = capture.resolution_px[0], height = capture.resolution_px[1];
  if (options.resolution > 0) {
    height =
        static_cast<int>(std::lround(static_cast<double>(options.resolution) * height / width));
    width = options.resolution;
  }
  if (width < kMinResolution_px || height < kMinResolution_px || height > kMaxResolution_px) {
    throw UserError("--resolution: found " + std::to_string(options.resolution) + ", which makes " +
                    std::to_string(width) + "x" + std::to_string(height) +
                    " texels; give a width so that both sides are from " +
                    std::to_string(kMinResolution_px) + " to " + std::to_string(kMaxResolution_px));
  }
  task.resolution_px = {static_cast<double>(width), static_cast<double>(height)};
  task.encoding = capture.encoding;
  task.ambient.assign(capture.ambient.begin(), capture.ambient.end());
  const auto opening = capture.has_board ? OpeningInSample(capture.board) : std::nullopt;
  if (opening) {
    task.board_opening_mm = {opening->left_mm, opening->bottom_mm, opening->right_mm,
                             opening->top_mm};
  }
  return task;
}

void AddTask(OptionSet* set, RectifyTask* task) {
  set->Add("sample-size-mm", &task->sample_size_mm, "from [sample]");
  set->Add("resolution-px", &task->resolution_px, "from [sample] or --resolution");
  set->Add("encoding", &task->encoding, "from [radiometry]");
  set->Add("ambient", &task->ambient, "from [light]");
  set->Add("board-opening-mm", &task->board_opening_mm, "from [board] window");
}

SamplePlane PlaneOf(const RectifyTask& task) {
  SamplePlane plane;
  plane.width = static_cast<int>(task.resolution_px[0]);
  plane.height = static_cast<int>(task.resolution_px[1]);
  plane.width_mm = task.sample_size_mm[0];
  plane.height_mm = task.sample_size_mm[1];
  return plane;
}

ResampleOptions ResampleOptionsOf(const RectifyOptions& options, int threads) {
  ResampleOptions resample;
  resample.filter = FilterFromName(options.filter).value_or(FilterKind::kSharp);
  resample.threads = threads;
  return resample;
}

SaturationRule SaturationRuleOf(const RectifyOptions& options) {
  SaturationRule rule;
  rule.stored_level = options.saturation_level;
  if (options.float_saturation_level > 0) rule.float_level = options.float_saturation_level;
  return rule;
}

}  // namespace glint
