// The stage `tile`: maps that repeat, from those of refine or fit.
//
// Writes svbrdf.exr, and preview.png: three by three repetitions, lit from the upper left. data:
// size_mm of the piece, its texels in the sample; metrics: seam (SeamScore).
#pragma once

#include <filesystem>
#include <string>

#include "base/formats/capture.h"
#include "base/programs/options.h"
#include "base/programs/stage.h"
#include "fitting/tiling/tile_maps.h"

namespace glint {

inline constexpr int kTileVersion = 6;

struct TileStageOptions {
  std::string from = "refine";
  int border = 1;  // rings of texels that mix with the sample's surroundings
  TileOptions tile;
};

void AddTileOptions(OptionSet* set, TileStageOptions* options);
// Those of them that are about tiling itself.
void AddTilingOptions(OptionSet* set, TileOptions* options);

struct TileStageResult {
  TileResult tile;
  double width_mm = 0, height_mm = 0;
  Json metrics;
};

// Throws UserError: no such maps, or too few texels.
TileStageResult RunTileStage(const Capture& capture, const TileStageOptions& options, int threads,
                             Stage* stage);

}  // namespace glint
