// Colours of plausible materials, linear Rec.709.
#pragma once

#include "datasets/procedural/random.h"

namespace glint::procedural {

struct Color {
  float r = 0.0f, g = 0.0f, b = 0.0f;
};

// Hue in turns, saturation and value in [0, 1]; the value is linear.
Color FromHsv(float hue, float saturation, float value);
Color MixColors(const Color& a, const Color& b, float t);
Color ScaleColor(const Color& c, float gain);

Color AnyColor(Rng& rng);        // greys, earths, saturated, pastel, near-black, near-white
Color GreyColor(Rng& rng);       // stones and concretes, barely tinted
Color EarthColor(Rng& rng);      // browns, ochres, brick reds
Color WoodColor(Rng& rng);       // pale maple to dark wenge, some stained
Color SaturatedColor(Rng& rng);  // paints, plastics, dyes
Color RustColor(Rng& rng);
Color MetalColor(Rng& rng);  // F0 of pure, tinted and coated metals, .4 to 1

// A neighbour of `c`: brightness within a factor of about 1 ± spread, hue and saturation moved a
// little.
Color Related(Rng& rng, const Color& c, float spread);

// Roughness from glossy to rough; `bias` in [-1, 1] leans to glossy or to rough.
float AnyRoughness(Rng& rng, float bias = 0.0f);
// F0 of a dielectric, .02 to .08, mostly about .04.
float AnyDielectricF0(Rng& rng);

}  // namespace glint::procedural
