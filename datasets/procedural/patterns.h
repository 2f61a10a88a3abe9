// Plane tilings and streaks that families share. All of them work on rows of points.
#pragma once

#include <cstdint>

#include "datasets/procedural/layers.h"

namespace glint::procedural {

enum class Tiling {
  kGrid,         // aligned rows
  kRunningBond,  // rows shifted by half a brick
  kThirdBond,    // rows shifted by a third
  kRandomBond,   // rows shifted at random, as planks
  kHerringbone,  // right-angled zigzag
  kBasket,       // blocks of parallel bricks, alternately turned
  kHexagon,
  kVoronoi,  // irregular stones
};

struct TilingOptions {
  Tiling tiling = Tiling::kGrid;
  float frequency = 6.0f;  // bricks' short sides per unit
  int aspect = 2;          // long side over short side; hexagons and Voronoi cells ignore it
  float jitter = 0.9f;     // of Voronoi sites
  uint32_t seed = 0;
};

struct TilingRows {
  float* u;      // along the long side from the cell's centre, in short sides
  float* v;      // across it
  float* edge;   // distance to the cell's border, in short sides
  uint32_t* id;  // hash of the cell; its lowest bit alternates between neighbours (not for Voronoi)
};

TilingRows TakeTilingRows(Scratch& scratch);
void Tile(const TilingOptions& options, const float* x, const float* y, int n,
          const TilingRows& out);

// Streaks (scratches, fibres, blades) of one direction: parallel lanes, cut at random lengths.
struct StreakOptions {
  float angle_turns = 0.0f;
  float lanes = 40.0f;    // per unit
  float length = 0.3f;    // of a streak, in units
  float presence = 0.5f;  // part of the slots that holds a streak
  float width = 0.8f;     // of a streak over a lane's width, at its middle
  float bend = 0.0f;      // sideways wander, in lanes
  uint32_t seed = 0;
};

// `profile`: 0 outside, rising to 1 on the streak's middle line; `id`: hash of the streak.
void Streaks(const StreakOptions& options, const float* x, const float* y, int n, float pixel,
             float* profile, uint32_t* id);

}  // namespace glint::procedural
