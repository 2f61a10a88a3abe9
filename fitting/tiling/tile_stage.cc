#include "fitting/tiling/tile_stage.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors/errors.h"
#include "fitting/reflectance/border.h"
#include "fitting/render/renderer.h"
#include "pipeline/contract/svbrdf_file.h"
#include "pipeline/images/image.h"

namespace glint {
namespace {

constexpr int kPreviewSize = 900;  // pixels along the longer side
constexpr int kCopies = 3;
// So bright that this share of the preview is darker than white.
constexpr double kBelowWhite = 0.98;

// Seen from above, from 2.5 times the longer side; a lamp as far away to the upper left.
View PreviewView(double longer_mm) {
  View view;
  view.camera_in_sample_mm = {0, 0, 2.5 * longer_mm};
  view.light_in_sample_mm = {-1.2 * longer_mm, 1.2 * longer_mm, 1.8 * longer_mm};
  const double power = 6 * longer_mm * longer_mm;
  view.light_rgb = {power, power, power};
  return view;
}

void WritePreview(const std::filesystem::path& file, const TileStageResult& result,
                  ReflectanceConvention convention, int threads) {
  const SvbrdfMaps& tile = result.tile.maps;
  const double scale = std::min(
      1.0, static_cast<double>(kPreviewSize) / (kCopies * std::max(tile.width, tile.height)));
  const SvbrdfMaps small =
      ResampleSvbrdf(tile, std::max(1, static_cast<int>(std::lround(tile.width * scale))),
                     std::max(1, static_cast<int>(std::lround(tile.height * scale))));
  const SvbrdfMaps maps = Repeated(small, kCopies, kCopies);
  convention.falloff = LightFalloff::kInverseSquare;
  const SamplePlane plane{maps.width, maps.height, kCopies * result.width_mm,
                          kCopies * result.height_mm, convention.sampling};
  Image image(maps.width, maps.height, {"R", "G", "B"});
  RenderView(maps, plane, PreviewView(std::max(plane.width_mm, plane.height_mm)), convention,
             image.samples.data(), threads);
  std::vector<float> sorted = image.samples;
  const auto white = sorted.begin() + static_cast<std::ptrdiff_t>(
                                          kBelowWhite * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), white, sorted.end());
  const float exposure = *white > 0 ? 1 / *white : 1;
  for (float& value : image.samples) {
    value = std::pow(std::clamp(exposure * value, 0.0f, 1.0f), 1 / 2.2f);
  }
  WritePng(file, image);
}

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
  set->AddChoice("from", &options->from, {"refine", "fit"}, "stage whose maps are tiled");
  set->AddRange(
      "border", &options->border, 0, kMostBorderRings,
      "outermost rings of texels, which may include the sample's surroundings, to replace with "
      "the nearest inner texels; 0: none");
  AddTilingOptions(set, &options->tile);
}

TileStageResult RunTileStage(const Capture& capture, const TileStageOptions& options, int threads,
                             Stage* stage) {
  const auto source = capture.work() / options.from / "manifest.json";
  VerifyOutputs(source, ReadManifest(source, options.from));
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
  WritePreview(stage->Output("preview.png"), result, convention, threads);
  stage->Commit({{"convention", ToString(convention)},
                 {"from", options.from},
                 {"size_mm", {result.width_mm, result.height_mm}},
                 {"columns", IntervalJson(tile.across)},
                 {"rows", IntervalJson(tile.down)}},
                result.metrics);
  return result;
}

}  // namespace glint
