#include "rectify/views/rectify_capture.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/formats/rectified_rows.h"
#include "base/linearize/light_guess.h"
#include "base/photos/photo_name.h"
#include "base/programs/progress.h"
#include "rectify/views/frame_mask.h"
#include "rectify/views/photo_stream.h"
#include "rectify/views/rectify_photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kWorthAWarning = 0.01;  // of the texels

void CheckSize(const fs::path& file, const Camera& camera) {
  const auto [width, height] = PhotoSize(file);
  if (width == camera.width_px && height == camera.height_px) return;
  throw UserError(file, "size", std::to_string(width) + "x" + std::to_string(height),
                  "its camera was calibrated at " + std::to_string(camera.width_px) + "x" +
                      std::to_string(camera.height_px) + "; run calib again");
}

// Of the frame that the view shows; none without a frame. `task` and `view` must outlive it.
FrameStatus FrameOf(const RectifyTask& task, const RectifyOptions& options,
                    const Rigid3& board_from_sample, const View& view) {
  if (task.board_opening_mm.empty()) return {};
  const BoardRectangle opening{task.board_opening_mm[0], task.board_opening_mm[1],
                               task.board_opening_mm[2], task.board_opening_mm[3]};
  const double frame_above_sample_mm = options.frame_height_mm - board_from_sample.translation.z();
  return [opening, frame_above_sample_mm, &options, &view](const SamplePlane& rows) {
    return MaskFrame(rows, opening, frame_above_sample_mm, options.frame_margin_mm, view);
  };
}

// Exposures relative to the first photograph's: as calib found them or else, where EXIF gives them
// for all, from there.
void SetExposures(const Calibration& calibration, const std::vector<double>& by_exif,
                  const RectifyOptions& options, std::vector<RectifiedView>* views) {
  std::vector<double> exposures;
  for (const CalibratedPhoto& photo : calibration.photos) exposures.push_back(photo.exposure);
  const auto known = [](const std::vector<double>& all) {
    return std::all_of(all.begin(), all.end(), [](double e) { return e > 0; });
  };
  if (options.exposure != "calib" || !known(exposures)) exposures = by_exif;
  if (options.exposure == "equal" || !known(exposures)) return;
  for (size_t i = 0; i < views->size(); ++i) {
    (*views)[i].view.exposure = exposures[i] / exposures[0];
  }
}

void Warn(const fs::path& file, const ViewCounts& counts) {
  if (counts.outside > kWorthAWarning) {
    spdlog::warn(
        "{}: {:.0f} % of the sample lies outside the photograph; get all of it into the picture",
        file.string(), 100 * counts.outside);
  }
  if (counts.saturated > 0.5) {
    spdlog::warn("{}: {:.0f} % of the sample is saturated; expose less", file.string(),
                 100 * counts.saturated);
  }
}

}  // namespace

void CheckPhotos(const Capture& capture, const Calibration& calibration,
                 const fs::path& calibration_file) {
  if (calibration.photos.empty()) {
    throw UserError(calibration_file, "data.photos", "no calibrated photograph", "run calib again");
  }
  const Manifest manifest = ReadManifest(calibration_file, "calib");
  const fs::path folder = fs::absolute(calibration_file).parent_path();
  std::set<fs::path> checked;
  for (const CalibratedPhoto& photo : calibration.photos) {
    const fs::path name = capture.folder / photo.photo, file = SplitPhotoName(name).file;
    CheckSize(name, calibration.cameras[static_cast<size_t>(photo.camera)]);
    if (!checked.insert(file).second) continue;  // another frame of the same video
    const fs::path relative = fs::absolute(file).lexically_normal().lexically_relative(folder);
    for (const ManifestInput& input : manifest.inputs) {
      if (fs::path(input.path).lexically_normal() != relative || input.hash == HashFile(file)) {
        continue;
      }
      throw UserError(file, "", "contents other than those calib read", "run calib again");
    }
  }
}

RectifySummary RectifyCapture(const Capture& capture, const Calibration& calibration,
                              const RectifyOptions& options, const RectifyTask& task,
                              const CommonOptions& common, Stage* stage) {
  RectifySummary summary;
  RectifiedSet& set = summary.set;
  set.plane = PlaneOf(task);
  set.convention = ReflectanceConvention::Photograph();
  set.light_power_known = calibration.light_power_known;
  set.fixed_camera = calibration.fixed_camera;
  set.light_sd_mm = calibration.light_sd_mm;

  std::vector<fs::path> files;
  for (const CalibratedPhoto& photo : calibration.photos) {
    files.push_back(capture.folder / photo.photo);
  }
  const std::string encoding = calibration.tone_curve.empty()
                                   ? capture.resolved_encoding()
                                   : (capture.work() / "calib" / calibration.tone_curve).string();
  PhotoStream stream(files, encoding, SaturationRuleOf(options), common.threads > 1);
  LightGuess guess(set.plane, set.convention.falloff);
  std::vector<double> exposures;
  summary.metrics["views"] = Json::array();
  Progress progress("rectify", static_cast<int64_t>(files.size()));

  for (size_t i = 0; i < files.size(); ++i) {
    const CalibratedPhoto& calibrated = calibration.photos[i];
    const StreamedPhoto photo = stream.Next();
    RectifiedView view;
    view.name = ViewName(i);
    view.file = view.name + ".exr";
    view.photo = calibrated.photo;
    view.ldr = photo.ldr;
    view.linear = photo.photo.stored_linear();
    view.view =
        ViewOf(calibration, calibrated, task.ambient, capture.work() / "calib" / "manifest.json");
    const Camera& camera = calibration.cameras[static_cast<size_t>(calibrated.camera)];
    const CameraProjection posed(camera, calibrated.camera_from_sample);
    const MovedProjection projection(posed, calibrated.registration);
    ResampleOptions resample = ResampleOptionsOf(options, common.threads);
    if (camera.vignetting != std::array<double, 3>{}) resample.vignetting = camera;
    for (int c = 0; c < 3; ++c) resample.gain_rgb[c] = 1 / calibrated.white_balance_rgb[c];
    resample.colour = calibration.colour_correction;
    resample.pixels_as_they_are =
        calibration.fixed_camera && TexelsArePixels(projection, set.plane);
    RectifiedWriter writer(stage->Output(view.file), set, view);
    guess.BeginView();
    const ViewCounts counts =
        RectifyByRows(photo.photo, projection, set.plane, resample,
                      FrameOf(task, options, calibration.board_from_sample, view.view), files[i],
                      [&](const RectifiedImage& rows) {
                        writer.Write(rows);
                        guess.AddRows(rows);
                      });
    writer.Close();
    Warn(files[i], counts);
    // Not of pixels that became texels: how sharp a picture was made is its maker's.
    if (!resample.pixels_as_they_are) view.pixels_per_texel = counts.pixels_per_texel;
    if (calibrated.blur_px > 0) view.blur_px = calibrated.blur_px;
    exposures.push_back(photo.exposure);
    Json metrics = {{"name", view.name}};
    metrics.update(ToJson(counts));
    summary.metrics["views"].push_back(metrics);
    set.views.push_back(std::move(view));
    progress.Advance(1, calibrated.photo);
  }
  SetExposures(calibration, exposures, options, &set.views);
  if (!set.light_power_known) GiveLight(guess, &set);
  stage->Commit(ToJson(set), summary.metrics);
  set.manifest_file = stage->manifest_file();
  return summary;
}

}  // namespace glint
