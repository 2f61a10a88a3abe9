// glint-calib: photographs of a sample on a board to cameras, poses and the light's power.
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "base/programs/capture_size.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "calib/capture/calibrate_capture.h"
#include "calib/capture/export_colmap.h"
#include "calib/capture/guide_capture.h"
#include "calib/capture/place_sample.h"
#include "calib/capture/pose_source.h"

namespace glint {
namespace {

ProgramResult Check(const Capture& capture, const CalibOptions& options,
                    const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const CalibSummary summary = CheckCapture(capture, options, common);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Json json = {{"capture", capture.folder.string()},
               {"seconds", seconds},
               {"sample_plane", PlacementMetrics(summary)},
               {"guidance", ToJson(summary.guidance)}};
  if (summary.chart) json["chart"] = ToJson(*summary.chart);
  return {(summary.chart ? TextOf(*summary.chart) : "") + PlacementText(summary) +
              TextOf(summary.guidance) + fmt::format("checked in {:.1f} s\n", seconds),
          json};
}

// What would be ignored is refused.
void CheckTogether(const PoseSource source, const CalibOptions& options) {
  if (source == PoseSource::kBoard) return;
  for (const auto& [name, value] : {std::pair{"library", options.library},
                                    std::pair{"fix-intrinsics", options.fix_intrinsics}}) {
    if (value.empty()) continue;
    throw UserError(fmt::format(
        "{}: found {} together with --poses {}, which takes intrinsics from COLMAP; leave one out",
        name, value.string(), options.poses));
  }
}

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, CalibOptions* options,
                  const bool* check, const CommonOptions& common) {
  Capture capture = ReadCapture(folder);
  const bool asked = *check;
  set->LoadToml(capture.file, "calib");
  if (*check != asked) {
    throw UserError(capture.file, "calib.check", *check ? "true" : "false",
                    "remove it: request a check when you want one, with glint-calib --check");
  }
  const PoseSource source = PoseSourceOf(capture, *options);
  CheckTogether(source, *options);
  if (source == PoseSource::kBoard && !capture.has_board) {
    throw UserError(capture.file, "board", "no such table",
                    "describe the board that lies round the sample, give --poses colmap, or import "
                    "a rectified set and continue with: glint run --from fit");
  }
  if (capture.photos.empty()) {
    throw UserError(capture.file, "photos", "no photographs",
                    "give files = [\"photos/*.jpg\"] in [photos]");
  }
  if (asked) {
    if (!capture.has_board && !capture.fixed_camera()) {
      throw UserError(capture.file, "board", "no such table",
                      "a check looks for the board; run without --check");
    }
    return Check(capture, *options, common);
  }
  if (source != PoseSource::kBoard) {
    CheckPoses(capture, *options);
    capture.board_photos.clear();  // they show no sample
  }
  CalibTask task = ResolveTask(capture, *options);
  AddTask(set, &task);
  Stage stage(capture.work() / "calib", {"calib", kCalibVersion}, *set, common,
              CalibInputs(capture, *options));
  Json json = {{"stage", "calib"},
               {"up_to_date", stage.UpToDate()},
               {"manifest", stage.manifest_file().string()}};
  std::string text = stage.UpToDateText(), brief = "up to date";
  if (!stage.UpToDate()) {
    RequireMemoryForStage("calib", capture, SizeOf(capture), common.threads);
    const CalibSummary summary = CalibrateCapture(capture, *options, common, &stage);
    json["metrics"] = MetricsOf(summary);
    text = TextOf(summary);
    brief = BriefTextOf(summary);
  }
  if (options->write == "colmap") {
    const std::string exported = ExportColmap(capture, stage.manifest_file()).string();
    json["exported"] = exported;
    text += (text.ends_with("\n") ? "COLMAP model: " : "\nCOLMAP model: ") + exported;
  }
  return {text, json, brief};
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::CalibOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddCalibOptions(&set, &options);
  bool check = false;
  set.Add("check", &check,
          "quick check of what the capture still lacks, for use before you put the sample away; "
          "writes nothing",
          glint::Invalidates::kNo);
  const glint::ProgramInfo info{
      "glint-calib",
      "Finds the board in each photograph and estimates intrinsics, poses and the flash's power; "
      "or takes poses and intrinsics from COLMAP.",
      GLINT_VERSION,
      "Examples:\n  glint calib wood\n  glint calib wood --model RADIAL --cameras one\n"
      "  glint calib wood --check\n  glint calib wood --poses colmap\n"
      "  glint calib wood --poses colmap:wood/sparse/0\n  glint calib wood --export colmap"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, &check, common);
  });
}
