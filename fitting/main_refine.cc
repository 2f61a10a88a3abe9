// glint-refine: the fitted maps, refined texel by texel.
#include <fmt/format.h>

#include "fitting/refine/refine_stage.h"
#include "pipeline/contract/capture.h"
#include "pipeline/contract/cost_model.h"
#include "pipeline/contract/program.h"

namespace glint {
namespace {

ProgramResult Summarise(const Stage& stage, const RefineStageResult& refined) {
  const double texels = static_cast<double>(refined.width) * refined.height;
  ProgramResult result;
  result.text =
      fmt::format("refine: {}x{} texels from {} views in {:.1f} s ({:.0f} texels/s)\n  {}\n",
                  refined.width, refined.height, refined.views.size(), refined.seconds,
                  texels / refined.seconds, refined.summary.BriefReport());
  result.summary = fmt::format("{} view{}, residuals {:.3g} %, {} substances", refined.views.size(),
                               refined.views.size() == 1 ? "" : "s",
                               100 * refined.summary.residual_sigma, refined.summary.substances);
  const Json& correction = refined.metrics["correction"];
  if (refined.correction.taken && !correction["views_moved"].get<bool>()) {
    result.text += fmt::format(
        "  room's light found: {:.1f} % of the flash; lights and pictures as they were\n",
        100 * correction["ambient_of_flash"].get<double>());
  } else if (refined.correction.taken) {
    result.text += fmt::format(
        "  views corrected: lights turned by {:.1f} deg, pictures moved by {:.2f} texels, ambient "
        "light {:.1f} % of the flash (means)\n",
        correction["light_turned_deg"].get<double>(),
        correction["registration_texel"].get<double>(),
        100 * correction["ambient_of_flash"].get<double>());
  }
  for (const Json& view : refined.metrics["views"]) {
    result.text += fmt::format("  {}  {:<28} loss {:.3g}\n", view["name"].get<std::string>(),
                               view["photo"].get<std::string>(), view["log_l1"].get<double>());
  }
  result.json = {{"stage", "refine"},
                 {"up_to_date", false},
                 {"manifest", stage.manifest_file().string()},
                 {"metrics", refined.metrics}};
  return result;
}

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, RefineStageOptions* options,
                  const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "refine");
  const RefineStart start = ResolveRefineStart(capture.work(), *options);
  const auto rectify_manifest = capture.work() / "rectify" / "manifest.json";
  VerifyOutputs(rectify_manifest, ReadManifest(rectify_manifest, "rectify"));
  std::vector<std::filesystem::path> inputs = {rectify_manifest};
  inputs.push_back(start.manifest_file.empty() ? start.maps_file : start.manifest_file);
  Stage stage(capture.work() / "refine", {"refine", kRefineVersion}, *set, common, inputs);
  if (stage.UpToDate()) return stage.UpToDateResult();
  RequireMemoryForStage("refine", capture, common.threads);
  return Summarise(stage,
                   RunRefineStage(rectify_manifest, start, *options, common.threads, &stage));
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::RefineStageOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddRefineOptions(&set, &options);
  const glint::ProgramInfo info{"glint-refine",
                                "Refines the fitted maps texel by texel, staying close to them "
                                "where the photographs say little.",
                                GLINT_VERSION,
                                "Example: glint refine wood --exclude view_003,view_007"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, common);
  });
}
