// Lattice noise and Voronoi cells evaluated over whole rows of points.
//
// Points are given as arrays x[n], y[n]; `frequency` is lattice cells per unit of x. `pixel` is the
// spacing of texels in the same unit: octaves finer than two texels fade out, so that one material
// keeps its look when it is made at another resolution.
#pragma once

#include <cstdint>

namespace glint::procedural {

enum class NoiseKind {
  kSmooth,  // signed gradient noise (Perlin 2002), standard deviation 1/3, seldom beyond ±1
  kBillow,  // |noise|: pillows with sharp valleys, about [0, 1]
  kRidged,  // 1 − |noise|: sharp crests, about [0, 1]
};

struct NoiseOptions {
  NoiseKind kind = NoiseKind::kSmooth;
  float frequency = 4.0f;  // of the first octave
  float stretch = 1.0f;    // y frequency over x frequency
  int octaves = 4;
  float gain = 0.5f;         // amplitude ratio of successive octaves
  float lacunarity = 2.03f;  // frequency ratio of successive octaves; off 2 so that lattices part
  uint32_t seed = 0;
};

// Fractal sum of octaves, scaled so that its spread does not depend on their number.
void FractalNoise(const NoiseOptions& options, const float* x, const float* y, int n, float pixel,
                  float* out);

struct VoronoiRows {
  float* dx;  // nearest site minus point, in cells
  float* dy;
  float* edge;   // distance to the border with the nearest neighbour cell, in cells
  uint32_t* id;  // hash of the nearest site
};

// Jittered-grid Voronoi diagram, `jitter` in [0, 1]. Border distance as in Quilez, "Voronoi
// borders".
void Voronoi(float frequency, float jitter, uint32_t seed, const float* x, const float* y, int n,
             const VoronoiRows& out);

}  // namespace glint::procedural
