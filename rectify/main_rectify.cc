// glint-rectify: photographs and their calibration to top views in linear radiance.
#include <fmt/format.h>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "base/programs/capture_size.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "rectify/views/rectify_capture.h"

namespace glint {
namespace {

ProgramResult Summarise(const Stage& stage, const RectifySummary& summary) {
  const SamplePlane& plane = summary.set.plane;
  ProgramResult result;
  result.text = fmt::format("rectify: {} views of {}x{} texels ({:.3f} mm per texel)\n",
                            summary.set.views.size(), plane.width, plane.height,
                            plane.width_mm / plane.width);
  result.summary = fmt::format("{} view{} of {} x {} texels, {:.3g} mm per texel",
                               summary.set.views.size(), summary.set.views.size() == 1 ? "" : "s",
                               plane.width, plane.height, plane.width_mm / plane.width);
  for (size_t i = 0; i < summary.set.views.size(); ++i) {
    const Json& metrics = summary.metrics["views"][i];
    result.text += fmt::format(
        "  {}  {:<28} usable {:5.1f} %  saturated {:4.1f} %  outside {:4.1f} %  {:.2f} px per "
        "texel\n",
        summary.set.views[i].name, summary.set.views[i].photo,
        100 * metrics["usable"].get<double>(), 100 * metrics["saturated"].get<double>(),
        100 * metrics["outside"].get<double>(), metrics["pixels_per_texel"].get<double>());
  }
  result.json = {{"stage", "rectify"},
                 {"up_to_date", false},
                 {"manifest", stage.manifest_file().string()},
                 {"metrics", summary.metrics}};
  return result;
}

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, RectifyOptions* options,
                  const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "rectify");
  RectifyTask task = ResolveTask(capture, *options);
  AddTask(set, &task);
  if (capture.imported()) {
    throw UserError(capture.file, "photos", "an imported capture, which is rectified already",
                    "continue with: glint run --from fit");
  }
  const auto calibration_file = capture.work() / "calib" / "manifest.json";
  const Calibration calibration = ReadCalibration(calibration_file);
  CheckPhotos(capture, calibration, calibration_file);
  std::vector<std::filesystem::path> inputs = {calibration_file};
  std::vector<std::string> photos;
  for (const CalibratedPhoto& photo : calibration.photos) photos.push_back(photo.photo);
  for (const auto& file : capture.FilesBehind(photos)) inputs.push_back(file);
  Stage stage(capture.work() / "rectify", {"rectify", kRectifyVersion}, *set, common, inputs);
  if (stage.UpToDate()) return stage.UpToDateResult();
  RequireMemoryForStage("rectify", capture, SizeOf(capture), common.threads);
  return Summarise(stage, RectifyCapture(capture, calibration, *options, task, common, &stage));
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::RectifyOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddRectifyOptions(&set, &options);
  const glint::ProgramInfo info{"glint-rectify",
                                "Resamples each calibrated photograph to an undistorted top view "
                                "of the sample in linear radiance.",
                                GLINT_VERSION, "Example: glint rectify wood --resolution 512"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, common);
  });
}
