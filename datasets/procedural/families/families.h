// The families: each draws the parameters of one material and returns what fills its rows.
#pragma once

#include <span>
#include <string_view>

#include "datasets/procedural/layers.h"
#include "datasets/procedural/random.h"

namespace glint::procedural {

struct Family {
  std::string_view name;
  RowFunction (*draw)(Rng& rng);
  float slope_low;  // root mean square of the relief's slope (tangent), drawn log-uniformly
  float slope_high;
  float weight;                // share of draws
  bool directional;            // keeps its axes in half of the draws; otherwise any angle always
  bool wood_or_paint = false;  // which people varnish
};

std::span<const Family> AllFamilies();

// mineral.cc
RowFunction DrawStone(Rng& rng);
RowFunction DrawMarble(Rng& rng);
RowFunction DrawTerrazzo(Rng& rng);
RowFunction DrawGravel(Rng& rng);
RowFunction DrawCracks(Rng& rng);
RowFunction DrawPlaster(Rng& rng);
// masonry.cc
RowFunction DrawBricks(Rng& rng);
RowFunction DrawTiles(Rng& rng);
RowFunction DrawPaving(Rng& rng);
// wood.cc
RowFunction DrawWood(Rng& rng);
RowFunction DrawPlanks(Rng& rng);
RowFunction DrawBark(Rng& rng);
// textile.cc
RowFunction DrawWeave(Rng& rng);
RowFunction DrawKnit(Rng& rng);
RowFunction DrawFibres(Rng& rng);
// hide.cc
RowFunction DrawLeather(Rng& rng);
RowFunction DrawScales(Rng& rng);
RowFunction DrawCrumple(Rng& rng);
// ornament.cc
RowFunction DrawStripes(Rng& rng);
RowFunction DrawDots(Rng& rng);
RowFunction DrawStamps(Rng& rng);
RowFunction DrawDamask(Rng& rng);
// metal.cc
RowFunction DrawBrushed(Rng& rng);
RowFunction DrawScratched(Rng& rng);
RowFunction DrawFlakes(Rng& rng);
RowFunction DrawPlates(Rng& rng);
RowFunction DrawSmooth(Rng& rng);
// corroded.cc
RowFunction DrawRust(Rng& rng);
RowFunction DrawPeelingPaint(Rng& rng);
RowFunction DrawStains(Rng& rng);
// growth.cc
RowFunction DrawGrass(Rng& rng);
RowFunction DrawLitter(Rng& rng);
RowFunction DrawChipboard(Rng& rng);
RowFunction DrawImpasto(Rng& rng);
RowFunction DrawMoss(Rng& rng);
// ground.cc
RowFunction DrawSoil(Rng& rng);
RowFunction DrawAsphalt(Rng& rng);
RowFunction DrawSand(Rng& rng);
RowFunction DrawFormwork(Rng& rng);
RowFunction DrawIce(Rng& rng);
// formed.cc
RowFunction DrawCorrugated(Rng& rng);
RowFunction DrawTread(Rng& rng);
RowFunction DrawHammered(Rng& rng);
RowFunction DrawPerforated(Rng& rng);
RowFunction DrawQuilted(Rng& rng);
RowFunction DrawPile(Rng& rng);

}  // namespace glint::procedural
