#include "fitting/tiling/tile_stage.h"

#include <stdexcept>
#include <string>

#include "base/errors/errors.h"
#include "base/formats/svbrdf_file.h"
#include "base/reflectance/border.h"
#include "base/stages/stages.h"
#include "fitting/tiling/tile_preview.h"

namespace glint {
namespace {

Json IntervalJson(const Interval& interval) { return {interval.begin, interval.length}; }

}  // namespace

void AddTilingOptions(OptionSet* set, TileOptions* options) {
  set->AddRange("least-share", &options->least_share, 0.1, 0.95,
                "minimum side of the tile, as a fraction of the sample's");
  set->AddRange("overlap", &options->overlap, 0.02, 0.4,
                "overlap of the copies at a seam, as a fraction of the sample's side");
  set->AddRange("flatten", &options->flatten, 0, 1,
                "share of low-frequency variation to remove; 0: none");
  set->AddRange(
      "flatten-scale", &options->flatten_scale, 0.05, 1,
      "shortest wavelength that counts as low frequency, as a fraction of the sample's side");
}

void AddTileOptions(OptionSet* set, TileStageOptions* options) {
  set->AddChoice("from", &options->from, StagesWithMaps(ReadsMaps::kWhole),
                 "stage whose maps to tile");
  set->AddRange(
      "border", &options->border, 0, kMostBorderRings,
      "number of outermost rings of texels to replace with the nearest inner texels, since they "
      "may include the sample's surroundings; 0: none");
  AddTilingOptions(set, &options->tile);
}

TileStageResult RunTileStage(const Capture& capture, const TileStageOptions& options, int threads,
                             Stage* stage) {
  const auto source = capture.work() / options.from / "manifest.json";
  const Manifest made_from = ReadManifest(source, options.from);
  VerifyOutputs(source, made_from);
  ReflectanceConvention convention;
  SvbrdfMaps maps = ReadSvbrdf(source.parent_path() / "svbrdf.exr", &convention);
  ContinueBorder(&maps, options.border);
  TileStageResult result;
  try {
    result.tile = TileMaps(maps, options.tile, threads);
  } catch (const std::invalid_argument& error) {
    throw UserError(source.parent_path() / "svbrdf.exr", "",
                    std::to_string(maps.width) + " x " + std::to_string(maps.height) + " texels",
                    std::string(error.what()) + "; raise sample.resolution_px");
  }
  const TileResult& tile = result.tile;
  result.width_mm = capture.sample_size_mm[0] * tile.maps.width / maps.width;
  result.height_mm = capture.sample_size_mm[1] * tile.maps.height / maps.height;
  result.metrics = {{"seam",
                     {{"worst", tile.seam.worst()},
                      {"diffuse", tile.seam.diffuse},
                      {"specular", tile.seam.specular},
                      {"roughness", tile.seam.roughness},
                      {"normal", tile.seam.normal}}}};
  WriteSvbrdf(stage->Output("svbrdf.exr"), tile.maps, convention);
  WriteTilePreview(stage->Output("preview.png"), tile.maps, result.width_mm, result.height_mm,
                   convention, threads);
  stage->Commit({{"convention", ToString(convention)},
                 {"from", options.from},
                 {"metals", MetalsOf(source, made_from)},
                 {"size_mm", {result.width_mm, result.height_mm}},
                 {"columns", IntervalJson(tile.across)},
                 {"rows", IntervalJson(tile.down)}},
                result.metrics);
  return result;
}

}  // namespace glint
