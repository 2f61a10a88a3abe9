#include "datasets/evaluation/tiling_verb.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/errors/errors.h"
#include "datasets/evaluation/experiment.h"
#include "datasets/evaluation/tiling_error.h"
#include "datasets/synth/material_source.h"
#include "fitting/tiling/tile_preview.h"
#include "fitting/tiling/tile_stage.h"

namespace glint {
namespace {

constexpr int kOwnMaterials = 8;

struct Figures {
  std::string material;
  int width = 0, height = 0;  // of the tile
  double seam = 0;
  TilingErrors errors;     // against the sample
  TilingErrors flattened;  // against the sample without low-frequency variation, as it was tiled
};

Figures Measure(const MaterialSource& material, const TileOptions& options,
                const std::filesystem::path& previews, int threads) {
  const TileResult tile = TileMaps(material.maps, options, threads);
  if (!previews.empty()) {
    WriteTilePreview(previews / (material.name + ".png"), tile.maps, tile.maps.width,
                     tile.maps.height, ReflectanceConvention::Dir2019(), threads);
  }
  const SvbrdfMaps flat = FlattenMaps(material.maps, options);
  return {material.name,
          tile.maps.width,
          tile.maps.height,
          tile.seam.worst(),
          CompareTile(tile.maps, material.maps, threads),
          CompareTile(tile.maps, flat, threads)};
}

std::string Markdown(const std::vector<Figures>& rows) {
  std::string text =
      "Differences from the sample, and from the sample without the low-frequency variation that "
      "tiling removes:\n\n"
      "| material | tile | seam | mean, % | spread, % | mean, worst view, % | spread, worst view, "
      "% | flattened: mean, % | spread, % |\n|---|---|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const Figures& row : rows) {
    text += fmt::format(
        "| {} | {} x {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n",
        row.material, row.width, row.height, row.seam, 100 * row.errors.mean,
        100 * row.errors.spread, 100 * row.errors.largest_mean, 100 * row.errors.largest_spread,
        100 * row.flattened.mean, 100 * row.flattened.spread);
  }
  return text;
}

Json ToJson(const TilingErrors& errors) {
  return {{"mean", errors.mean},
          {"spread", errors.spread},
          {"largest_mean", errors.largest_mean},
          {"largest_spread", errors.largest_spread}};
}

Json ToJson(const std::vector<Figures>& rows) {
  Json json = Json::array();
  for (const Figures& row : rows) {
    json.push_back({{"material", row.material},
                    {"width", row.width},
                    {"height", row.height},
                    {"seam", row.seam},
                    {"sample", ToJson(row.errors)},
                    {"flattened_sample", ToJson(row.flattened)}});
  }
  return json;
}

int RunTiling(int argc, char** argv, const ProgramInfo& info) {
  std::vector<std::string> named;
  int size = 512;
  TileOptions tile;
  std::filesystem::path previews;
  OptionSet options;
  options.AddPositional("materials", &named, "as in glint-eval table1", false);
  options.AddRange("size", &size, kLeastTileTexels, 4096, "texels per side");
  AddTilingOptions(&options, &tile);
  options.Add("previews", &previews, "folder for a picture of 3 x 3 tiles of each material");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (common.check) throw UserError("status: a measurement is not a stage; leave the option out");
    if (!previews.empty()) std::filesystem::create_directories(previews);
    std::vector<Figures> rows;
    for (const std::string& text :
         named.empty() ? ReservedMaterials(kOwnMaterials) : ExpandMaterials(named)) {
      rows.push_back(Measure(LoadMaterial(text, size), tile, previews, common.threads));
      spdlog::info("{}: seam {:.2f}, mean {:.1f} %, spread {:.1f} %", rows.back().material,
                   rows.back().seam, 100 * rows.back().errors.mean,
                   100 * rows.back().errors.spread);
    }
    return ProgramResult{Markdown(rows), {{"materials", ToJson(rows)}}};
  });
}

}  // namespace

Verb TilingVerb() {
  return {
      "tile",
      "Tiles materials as glint-tile does and compares renderings of the tile with those of the "
      "whole sample: how visible the seams are, and how far mean and standard deviation differ.",
      "Example: glint-eval tile procedural:1000000000 --flatten 0", RunTiling};
}

}  // namespace glint
