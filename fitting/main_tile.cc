// glint-tile: a piece of the material that repeats without visible borders.
#include <fmt/format.h>

#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "fitting/tiling/tile_stage.h"

namespace glint {
namespace {

ProgramResult Summarise(const Stage& stage, const TileStageResult& result) {
  const SvbrdfMaps& maps = result.tile.maps;
  const std::string facts =
      fmt::format("{} x {} texels repeat, change across seams {:.3g} x the texture's own",
                  maps.width, maps.height, result.tile.seam.worst());
  return {fmt::format("tile: {} ({:.3g} x {:.3g} mm)\npreview: {}\n", facts, result.width_mm,
                      result.height_mm, (stage.folder() / "preview.png").string()),
          {{"stage", "tile"},
           {"up_to_date", false},
           {"manifest", stage.manifest_file().string()},
           {"metrics", result.metrics}},
          facts};
}

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, TileStageOptions* options,
                  const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "tile");
  const auto source = capture.work() / options->from / "manifest.json";
  ReadManifest(source, options->from);
  Stage stage(capture.work() / "tile", {"tile", kTileVersion}, *set, common, {source});
  if (stage.UpToDate()) return stage.UpToDateResult();
  RequireMemoryForStage("tile", capture, SizeOfMaps(capture), common.threads);
  return Summarise(stage, RunTileStage(capture, *options, common.threads, &stage));
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::TileStageOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddTileOptions(&set, &options);
  const glint::ProgramInfo info{
      "glint-tile",
      "Makes maps that tile seamlessly: removes low-frequency variation, selects the region whose "
      "opposite edges match best, and blends it with its copies. If there is a [tile] section in "
      "capture.toml, glint run does this before export.",
      GLINT_VERSION,
      "Examples:\n  glint tile wood && glint export wood --from tile\n"
      "  glint tile wood --least-share 0.8 --flatten 0"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, common);
  });
}
