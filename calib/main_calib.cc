// glint-calib: photographs of a sample on a board to cameras, poses and the light's power.
#include "calib/capture/calibrate_capture.h"
#include "pipeline/contract/capture.h"
#include "pipeline/contract/errors.h"
#include "pipeline/contract/program.h"

namespace glint {
namespace {

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, CalibOptions* options,
                  const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "calib");
  if (!capture.has_board) {
    throw UserError(capture.file, "board", "no such table",
                    "describe the board that lies round the sample, or import a rectified set and "
                    "go on with: glint run --from fit");
  }
  if (capture.photos.empty()) {
    throw UserError(capture.file, "photos", "no photographs",
                    "give files = [\"photos/*.jpg\"] in [photos]");
  }
  CalibTask task = ResolveTask(capture);
  AddTask(set, &task);
  Stage stage(capture.work() / "calib", {"calib", kCalibVersion}, *set, common,
              CalibInputs(capture, *options));
  Json json = {{"stage", "calib"},
               {"up_to_date", stage.UpToDate()},
               {"manifest", stage.manifest_file().string()}};
  if (stage.UpToDate()) return {stage.UpToDateText(), json};
  const CalibSummary summary = CalibrateCapture(capture, *options, common, &stage);
  json["metrics"] = MetricsOf(summary);
  return {TextOf(summary), json};
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::CalibOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddCalibOptions(&set, &options);
  const glint::ProgramInfo info{
      "glint-calib",
      "Finds the board in each photograph and estimates intrinsics, poses and the flash's power.",
      GLINT_VERSION,
      "Examples:\n  glint calib wood\n  glint calib wood --model RADIAL --cameras one"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, common);
  });
}
