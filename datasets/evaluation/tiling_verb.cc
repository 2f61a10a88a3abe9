#include "datasets/evaluation/tiling_verb.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "base/errors/errors.h"
#include "datasets/evaluation/experiment.h"
#include "datasets/evaluation/tiling_error.h"
#include "datasets/synth/material_source.h"
#include "fitting/tiling/tile_stage.h"

namespace glint {
namespace {

constexpr int kOwnMaterials = 8;

struct Figures {
  std::string material;
  int width = 0, height = 0;  // of the tile
  double seam = 0;
  TilingErrors errors;
};

Figures Measure(const MaterialSource& material, const TileOptions& options, int threads) {
  const TileResult tile = TileMaps(material.maps, options, threads);
  return {material.name, tile.maps.width, tile.maps.height, tile.seam.worst(),
          CompareTile(tile.maps, material.maps, threads)};
}

std::string Markdown(const std::vector<Figures>& rows) {
  std::string text =
      "| material | tile | seam | mean, % | spread, % | mean, worst view, % | spread, worst view, "
      "% "
      "|\n|---|---|---:|---:|---:|---:|---:|\n";
  for (const Figures& row : rows) {
    text +=
        fmt::format("| {} | {} x {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", row.material,
                    row.width, row.height, row.seam, 100 * row.errors.mean, 100 * row.errors.spread,
                    100 * row.errors.largest_mean, 100 * row.errors.largest_spread);
  }
  return text;
}

Json ToJson(const std::vector<Figures>& rows) {
  Json json = Json::array();
  for (const Figures& row : rows) {
    json.push_back({{"material", row.material},
                    {"width", row.width},
                    {"height", row.height},
                    {"seam", row.seam},
                    {"mean", row.errors.mean},
                    {"spread", row.errors.spread},
                    {"largest_mean", row.errors.largest_mean},
                    {"largest_spread", row.errors.largest_spread}});
  }
  return json;
}

int RunTiling(int argc, char** argv, const ProgramInfo& info) {
  std::vector<std::string> named;
  int size = 512;
  TileOptions tile;
  OptionSet options;
  options.AddPositional("materials", &named, "as in glint-eval table1", false);
  options.AddRange("size", &size, kLeastTileTexels, 4096, "texels per side");
  AddTilingOptions(&options, &tile);
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (common.check) throw UserError("status: a measurement is not a stage; leave the option out");
    std::vector<Figures> rows;
    for (const std::string& text :
         named.empty() ? ReservedMaterials(kOwnMaterials) : ExpandMaterials(named)) {
      rows.push_back(Measure(LoadMaterial(text, size), tile, common.threads));
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
