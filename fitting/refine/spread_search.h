// Which of many spreads predict best, all of them by powers of two, each judged with the others as
// they are then: they stand in for each other (a wide spread of diffuse albedo for one of specular
// albedo), so that the best of each alone need not be the best together.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "fitting/refine/held_out_errors.h"

namespace glint {

// What cross-validation chooses of a sample (sample_model.h).
enum SpreadKind : size_t {
  kRoughnessSpread,
  kSpecularSpread,
  kNormalSpread,
  kDiffuseSpread,
  kInitialisationError,
  kNeighbourSpread,
  kSpreadKinds
};
using SpreadPowers = std::array<int, kSpreadKinds>;  // log₂ of the factors
using SpreadFactors = std::array<double, kSpreadKinds>;

// Whether the first folds of a prediction tell enough of it: it need not be finished.
using GiveUp = std::function<bool(const HeldOutErrors& first_folds)>;
using PredictBySpreads =
    std::function<HeldOutErrors(const SpreadPowers& powers, const GiveUp& give_up)>;

struct TriedSpreads {
  SpreadPowers powers;
  double energy;  // against the best: negative logarithm of how probable they are
};

// Coordinate descent on the negative log posterior, from the factors `from`: roughness and specular
// albedo together, normals, specular albedo alone, diffuse albedo, the initial maps' errors,
// neighbours, and neighbours against roughness and specular albedo; then again until nothing is
// better. Returns the best first, then along the axes through it all that is not
// improbable; the way to it, which rounding decides, is not told. What is out of
// the question by its first folds is given up. The initialisation is expected to err by as much as
// is said, within a factor of two.
std::vector<TriedSpreads> SearchSpreads(const PredictBySpreads& predict,
                                        const SpreadPowers& from = {});

// Of each kind the mean along the axis through the best, by how probable each factor is: what
// predicts nearly as well as the best is nearly as probable. `tried`: of SearchSpreads().
SpreadFactors ProbableFactors(const std::vector<TriedSpreads>& tried);

}  // namespace glint
