#include "calib/capture/calib_options.h"

#include <fmt/format.h>

#include "base/board/board_kind.h"

namespace glint {
namespace {

std::string PosesInOneLine(const Capture& capture) {
  const PosesTable& poses = capture.poses;
  return fmt::format(
      "size {} x {} mm, photo '{}', corners [{}], points [{}] {} mm, cameras [{}] {} mm, height {} "
      "mm, picture {} mm, origin [{}], x axis [{}]",
      capture.sample_size_mm[0], capture.sample_size_mm[1], poses.photo,
      fmt::join(poses.corners_px, " "), fmt::join(poses.points_px, " "), poses.points_mm,
      fmt::join(poses.cameras, " "), poses.cameras_mm, poses.height_mm, poses.picture_width_mm,
      fmt::join(poses.origin_px, " "), fmt::join(poses.x_axis_px, " "));
}

// The file of lights is an input of its own.
std::string FixedCameraInOneLine(const Capture& capture) {
  const LightsTable& lights = capture.lights;
  return fmt::format(
      "picture {} mm, points [{}] {} mm, lights in {} at {} mm, camera at {} mm, balls [{}]",
      capture.poses.picture_width_mm, fmt::join(capture.poses.points_px, " "),
      capture.poses.points_mm, lights.unit.empty() ? "directions" : lights.unit, lights.distance_mm,
      lights.camera_mm, fmt::join(lights.balls_px, " "));
}

std::string ChartInOneLine(const ChartTable& chart) {
  if (!chart.present()) return "";
  return fmt::format("{} in '{}', corners [{}], illuminant {}, model {}, reflectance {}",
                     chart.kind, chart.photo, fmt::join(chart.corners_px, " "), chart.illuminant,
                     chart.model, chart.reflectance);
}

}  // namespace

namespace {

std::vector<std::string> ModelChoices() {
  std::vector<std::string> names = {"auto"};
  for (const CameraModel model : CalibratedModels(Calibrated::kOnDemand))
    names.emplace_back(CameraModelName(model));
  return names;
}

}  // namespace

void AddCalibOptions(OptionSet* set, CalibOptions* options) {
  // What the result depends on are the model's files, which are inputs, and the kind of source,
  // which is in the task; the place of the folder tells nothing.
  set->Add("poses", &options->poses,
           "where poses and intrinsics come from: board; colmap (runs the program); colmap:DIR (a "
           "COLMAP model); above (one photograph, taken from directly above, no board)",
           Invalidates::kNo);
  set->AddChoice("export", &options->write, {"none", "colmap"},
                 "also write the calibration for another program: colmap, to glint/colmap",
                 Invalidates::kNo);
  set->AddChoice(
      "model", &options->model, ModelChoices(),
      "camera model, by its COLMAP name; auto: the simplest one whose held-out error is not "
      "significantly above that of the best; with --poses colmap, auto means OPENCV, since there "
      "is no board to hold out");
  set->AddChoice("cameras", &options->cameras, {"auto", "one", "each"},
                 "auto: photographs of the same size and EXIF focal length share their intrinsics; "
                 "one: all photographs share one set; each: every photograph has its own");
  set->Add("hold", &options->hold, "distortion parameters fixed at 0, such as p1,p2");
  set->Add("fix-intrinsics", &options->fix_intrinsics,
           "manifest of another calibration whose intrinsics are used unchanged",
           Invalidates::kNo);  // its content is an input, and the place of the file tells nothing
  set->Add("library", &options->library,
           "folder of calib manifests; a camera whose EXIF matches one of them takes its "
           "intrinsics from it",
           Invalidates::kNo);  // likewise
  set->AddChoice("board-shape", &options->board_shape, {"auto", "flat", "bent"},
                 "bent: also estimate how far the board bulges in the middle; auto: where the "
                 "corners show that it does");
  set->AddRange("reject-sigmas", &options->reject_sigmas, 2, 1000,
                "corners farther off than this many robust standard deviations are rejected");
  set->AddRange("min-reject-px", &options->min_reject_px, 0, 1000,
                "corners off by less than this are never rejected");
  set->AddRange("min-corners", &options->min_corners, 4, 10000,
                "photographs with fewer corners are rejected");
  set->AddRange("detect-px", &options->detect_px, 200, 20000,
                "boards are detected in a copy whose longer side has this many pixels; corners are "
                "then located in the full-resolution photograph");
  set->AddChoice(
      "light", &options->light, {"board", "camera"},
      "board: flash position, lens fall-off, exposures and ambient illumination from the board's "
      "white paper; camera: the light at the lens or at [light] offset_mm, exposures from "
      "EXIF");
  set->AddRange("plane-tolerance", &options->plane_tolerance, 1e-5, 0.2,
                "--poses colmap: points farther from the sample's plane than this fraction of the "
                "cameras' distance are not part of it");
  set->AddRange(
      "feature-px", &options->feature_px, 200, 20000,
      "--poses colmap: features are detected in a copy whose longer side has this many pixels");
  set->AddChoice(
      "triage", &options->triage, {"warn", "drop", "off"},
      "what to do about blurred, dark, overexposed and duplicate photographs; warn: list them; "
      "drop: list and exclude them; off: do not check");
  set->AddRange(
      "paper-reflectance", &options->paper_reflectance, 0.05, 1,
      "reflectance of the board's white paper, from which the light's power is estimated");
}

BundleOptions BundleOptionsOf(const CalibOptions& options) {
  BundleOptions bundle;
  bundle.model = CameraModelFromName(options.model).value_or(CameraModel::kOpenCv);
  bundle.hold = options.hold;
  bundle.bend = options.board_shape == "bent";
  bundle.reject_sigmas = options.reject_sigmas;
  bundle.min_reject_px = options.min_reject_px;
  bundle.min_corners = options.min_corners;
  return bundle;
}

CalibTask ResolveTask(const Capture& capture, const CalibOptions& options) {
  CalibTask task;
  task.board = capture.has_board ? KindOf(capture.board.kind).InOneLine(capture.board) : "none";
  const bool colmap = options.poses.starts_with("colmap");
  task.poses = !colmap ? "board" : options.poses == "colmap" ? "colmap" : "model";
  if (colmap) task.poses_frame = PosesInOneLine(capture);
  if (capture.fixed_camera()) {
    task.poses = "fixed camera";
    task.poses_frame = FixedCameraInOneLine(capture);
  }
  task.board_centre_mm = {capture.board.board_centre_in_sample_mm.x(),
                          capture.board.board_centre_in_sample_mm.y()};
  task.encoding = capture.encoding;
  task.light_offset_mm.assign(capture.light_offset_mm.begin(), capture.light_offset_mm.end());
  task.light_power.assign(capture.light_power.begin(), capture.light_power.end());
  task.ambient.assign(capture.ambient.begin(), capture.ambient.end());
  task.sample_mm.assign(capture.sample_size_mm.begin(), capture.sample_size_mm.end());
  task.sample_height =
      capture.sample_height_mm ? fmt::format("{}", *capture.sample_height_mm) : "auto";
  task.chart = ChartInOneLine(capture.chart);
  task.resolution_px.assign(capture.resolution_px.begin(), capture.resolution_px.end());
  return task;
}

void AddTask(OptionSet* set, CalibTask* task) {
  set->Add("board", &task->board, "from [board]");
  set->Add("poses-from", &task->poses, "from --poses");
  set->Add("poses-frame", &task->poses_frame, "from [poses]");
  set->Add("board-centre-mm", &task->board_centre_mm, "from [sample] centre_mm");
  set->Add("encoding", &task->encoding, "from [radiometry]");
  set->Add("light-offset-mm", &task->light_offset_mm, "from [light]");
  set->Add("light-power", &task->light_power, "from [light]");
  set->Add("ambient", &task->ambient, "from [light]");
  set->Add("sample-mm", &task->sample_mm, "from [sample] size_mm");
  set->Add("resolution-px", &task->resolution_px, "from [sample]");
  set->Add("sample-height", &task->sample_height, "from [sample] height_mm");
  // Captures without a chart keep the manifests that they have.
  if (!task->chart.empty()) set->Add("chart", &task->chart, "from [chart]");
}

}  // namespace glint
