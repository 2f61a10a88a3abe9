// What a texel's neighbours know of its highlight.
//
// A texel that no photograph shows near its highlight keeps the roughness and specular albedo it
// started with, though neighbours of the same substance have seen theirs. So refinement is done
// again from a start that is pooled over the neighbourhood: means of roughness and specular albedo
// weighted by likeness of diffuse albedo, nearness, and how sure each texel is of its own values;
// and the spread among those neighbours is the error that is expected of that start (empirical
// Bayes: what varies little nearby is held firmly, what varies is left to the photographs).
// Of roughness, what the texels' own uncertainty spreads is taken off first. Specular albedo keeps
// its whole spread: metals beside dielectrics look alike in diffuse albedo and differ in truth.
#pragma once

#include <vector>

#include "fitting/refine/refine.h"

namespace glint {

struct HighlightPoolOptions {
  double radius = 24.0 / 256;  // of the neighbourhood, of the longer side
  int samples = 17;            // across the neighbourhood, in each direction
  double likeness = 0.1;       // standard deviation of the square root of diffuse albedo
  double least_sigma = 0.03;   // of a texel's own values (half for specular): none is surer
  double least_error = 0.02;   // expected of the pooled start (half for specular) at least
};

struct HighlightPool {
  SvbrdfMaps start;  // `refined` with roughness and specular albedo of the neighbourhood
  std::vector<float> roughness_error, specular_error;  // H·W: standard deviations expected of them
};

// Results do not depend on `threads`.
HighlightPool PoolHighlights(const RefineResult& refined, const HighlightPoolOptions& options,
                             int threads);

}  // namespace glint
