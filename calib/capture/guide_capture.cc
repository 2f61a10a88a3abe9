#include "calib/capture/guide_capture.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "calib/capture/capture_chart.h"
#include "calib/capture/fixed_camera.h"

namespace glint {
namespace {

constexpr int kQuick_px = 2100;  // 12 megapixels at half, 50 at a quarter of their size

const DetectedPhoto& FindPhoto(const CalibSummary& summary, const std::string& name) {
  return *std::find_if(summary.photos.begin(), summary.photos.end(),
                       [&](const DetectedPhoto& photo) { return photo.name == name; });
}

// "15.0 mm on the left, 1 square, …": sides on which the sample reaches beyond the board's opening.
// What lies on a whole board, or beside it, covers squares by intent.
std::string ReachOverBoard(const Capture& capture) {
  constexpr double kLeast_mm = 1;  // to which people measure a sample and lay it down
  if (!capture.has_board) return "";
  const auto opening = OpeningInSample(capture.board);
  if (!opening) return "";
  const double x = capture.sample_size_mm[0] / 2, y = capture.sample_size_mm[1] / 2;
  const std::pair<const char*, double> sides[] = {{"on the left", opening->left_mm + x},
                                                  {"on the right", x - opening->right_mm},
                                                  {"at the bottom", opening->bottom_mm + y},
                                                  {"at the top", y - opening->top_mm}};
  std::string text;
  for (const auto& [side, over_mm] : sides) {
    if (over_mm < kLeast_mm) continue;
    text += fmt::format("{}{:.0f} mm {}", text.empty() ? "" : ", ", over_mm, side);
    if (capture.board.square_mm <= 0) continue;
    const double squares = std::ceil(over_mm / capture.board.square_mm);
    text += fmt::format(": {:.0f} square{}", squares, squares == 1 ? "" : "s");
  }
  return text;
}

void SolveQuickly(const Capture& capture, const CalibOptions& options, int threads,
                  CalibSummary* summary) {
  try {
    SolveCapture(capture, options, {}, threads, summary);
    return;
  } catch (const Error& error) {
    if (!options.fix_intrinsics.empty()) throw;
    spdlog::debug("assuming the focal length: {}", error.what());
  }
  SolveWithAssumedCameras(capture, options, threads, summary);
}

}  // namespace

GuidanceInput GuidanceInputOf(const Capture& capture, const CalibSummary& summary,
                              bool focal_assumed) {
  GuidanceInput input;
  input.sample_size_mm = capture.sample_size_mm;
  input.resolution_px = capture.resolution_px;
  input.focal_assumed = focal_assumed;
  input.fixed_camera = summary.calibration.fixed_camera;
  input.over_board = ReachOverBoard(capture);
  input.board_findings = summary.board_findings;
  input.light_findings = summary.light_findings;
  for (const CalibratedPhoto& photo : summary.calibration.photos) {
    const Rigid3 sample_from_camera = Inverse(photo.camera_from_sample);
    GuidancePhoto one;
    one.name = photo.photo;
    one.camera_in_sample_mm = sample_from_camera.translation;
    one.light_in_sample_mm = sample_from_camera * photo.light_in_camera_mm;
    one.posed = {summary.calibration.cameras[photo.camera], photo.camera_from_sample};
    one.clipped_share = FindPhoto(summary, photo.photo).sample_clipped_share;
    one.blur_px = photo.blur_px;
    input.photos.push_back(one);
  }
  for (const RejectedPhoto& photo : summary.rejected) {
    if (FindPhoto(summary, photo.name).board_photo) continue;
    input.left_out.push_back({photo.name, photo.reason});
  }
  for (const CameraEstimate& estimate : summary.bundle.cameras) {
    if (estimate.photos == 0) continue;
    const double sigma = estimate.sigma[0] / estimate.camera.focal_length_x();
    input.focal_sigma = std::max(input.focal_sigma, std::isfinite(sigma) ? sigma : 1.0);
  }
  return input;
}

CalibSummary CheckCapture(const Capture& capture, const CalibOptions& given,
                          const CommonOptions& common) {
  CalibOptions options = given;
  options.quick_px = kQuick_px;
  if (capture.fixed_camera()) {
    CalibSummary fixed;
    CalibrateFixedCamera(capture, given, common.threads, &fixed);
    return fixed;
  }
  CalibSummary summary = DetectCapture(capture, options, common.threads);
  SolveQuickly(capture, options, common.threads, &summary);
  CorrectColours(capture, &summary);
  return summary;
}

}  // namespace glint
