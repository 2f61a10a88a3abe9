// glint-fit: maps from rectified views, in the latent space or texel by texel.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/formats/capture.h"
#include "base/formats/rectified_set.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "fitting/latent/fit_stage.h"

namespace glint {
namespace {

ProgramResult Summarise(const Stage& stage, const FitStageOptions& options,
                        const FitStageResult& done) {
  ProgramResult result;
  result.text = fmt::format("fit ({}): {}x{} texels from {} views in {:.1f} s\n  {}\n",
                            options.method, done.width, done.height, done.fit.view_loss.size(),
                            done.seconds, done.fit.BriefReport());
  const size_t views = done.fit.view_loss.size();
  result.summary = fmt::format("{}, {} view{}, log-L1 {:.3g}", options.method, views,
                               views == 1 ? "" : "s", done.fit.fitted_loss());
  result.json = {{"stage", "fit"},
                 {"up_to_date", false},
                 {"manifest", stage.manifest_file().string()},
                 {"data", done.data},
                 {"metrics", done.metrics}};
  return result;
}

void WarnOfLeftOut(const FitStageResult& done) {
  for (const LeftOutView& view : done.left_out) {
    spdlog::warn(
        "{} is left out: no maps explain it together with the other photographs (residuals of "
        "{:.2g} in log radiance; without it {:.2g}): was something on the sample, did a shadow "
        "fall "
        "on it, was it exchanged, or is the photograph edited? --views uses what it names in any "
        "case",
        view.photo, view.log_l1, done.fit.final_loss);
  }
}

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, FitStageOptions* options,
                  const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "fit");
  const auto views_manifest = ViewsManifest(capture.work());
  ResolveFitOptions(views_manifest, options);
  std::vector<std::filesystem::path> inputs = {views_manifest};
  for (const auto& input : FitInputs(*options)) inputs.push_back(input);
  Stage stage(capture.work() / "fit", {"fit", kFitVersion}, *set, common, inputs);
  if (stage.UpToDate()) return stage.UpToDateResult();
  RequireMemoryForStage("fit", capture, SizeOfMaps(capture), common.threads);
  const FitStageResult done = RunFitStage(views_manifest, *options, common.threads, &stage);
  WarnOfLeftOut(done);
  return Summarise(stage, *options, done);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::FitStageOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddFitOptions(&set, &options);
  const glint::ProgramInfo info{
      "glint-fit",
      "Fits maps to the rectified views: in the auto-encoder's latent space, or texel by texel.",
      GLINT_VERSION, "Example: glint fit wood --method latent --exclude view_003,view_007"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, common);
  });
}
