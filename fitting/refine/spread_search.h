// Which of many spreads predict best, all of them by powers of two, each judged with the others as
// they are then: they stand in for each other (a wide spread of diffuse albedo for one of specular
// albedo), so that the best of each alone need not be the best together.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace glint {

// What cross-validation chooses of a sample (sample_model.h).
enum SpreadKind : size_t {
  kRoughnessSpread,
  kSpecularSpread,
  kNormalSpread,
  kDiffuseSpread,
  kInitialisationError,
  kSpreadKinds
};
using SpreadPowers = std::array<int, kSpreadKinds>;  // log₂ of the factors
using SpreadFactors = std::array<double, kSpreadKinds>;

struct TriedSpreads {
  SpreadPowers powers;
  double error;  // mean square of what is predicted
};

// Coordinate descent on the negative log posterior, from factors of 1: roughness and specular
// albedo together, normals, specular albedo alone, diffuse albedo, the initialisation; then again
// until nothing is better, at most three times. Returns all that were tried, each once: the best
// and, nearly always, those next to it. `independent`: residuals in each mean square. The
// initialisation is expected to err by as much as is said, within a factor of two.
std::vector<TriedSpreads> SearchSpreads(
    const std::function<double(const SpreadPowers& powers)>& error, double independent);

// Factors over all that were tried, by how probable each is: what predicts nearly as well as the
// best is nearly as probable, and to take the best alone would state deviations that are too small.
SpreadFactors ProbableFactors(const std::vector<TriedSpreads>& tried, double independent);

// The factor for `errors[i]`, a mean square that was found with factors[i], at its mean precision.
double FactorOfMeanPrecision(std::span<const double> factors, const std::vector<double>& errors,
                             double independent);

}  // namespace glint
