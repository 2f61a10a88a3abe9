// Values with the distribution of others: what a piece of a sample lacks of the whole's extremes.
#pragma once

#include <span>
#include <vector>

namespace glint {

// Maps `values` by the increasing function that takes their quantiles to those of `wanted`,
// linear between 256 of them. Equal values stay equal.
void MatchDistribution(std::span<const float> wanted, std::vector<double>* values);

// The same of a distribution in the plane: along four directions and across each, one after the
// other (iterative distribution transfer, Pitié, Kokaram and Dahyot 2005). Maps of slopes need it,
// since light from aside sees their distribution along its own direction.
struct PlaneValues {
  std::vector<double> x, y;
};
void MatchDistribution(std::span<const float> wanted_x, std::span<const float> wanted_y,
                       PlaneValues* values);

}  // namespace glint
