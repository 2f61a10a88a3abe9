#include "fitting/refine/spread_search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace glint {
namespace {

// As far as each may go, in the order of SpreadKind. Specular albedo's reaches further down than
// roughness's, with which it is scaled first and then alone. The initialisation has seen the
// photographs that are held out, so that its errors would be thought smaller than they are.
constexpr SpreadPowers kLeast = {-2, -4, -2, -3, 0}, kMost = {1, 2, 1, 1, 4};
// Standard deviation of log₂ of the factor on the initialisation's errors. Photographs that hardly
// tell a rough specular lobe from diffuse light say nothing of it, and what is said of them does.
constexpr double kInitialisationOctaves = 1;
// Roughness varies within many substances whose specular albedo does not.
constexpr std::array<SpreadPowers, 5> kDirections = {
    {{1, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 1, 0, 0, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}}};
constexpr int kPasses = 3;

// Negative logarithm of Gauss's likelihood of `independent` residuals of unknown variance, whose
// mean square is `error` (0 where all photographs that were held out are masked).
double LikelihoodEnergy(double error, double independent) {
  return 0.5 * independent * std::log(std::max(error, 1e-300));
}

double Energy(const TriedSpreads& tried, double independent) {
  const double octaves = tried.powers[kInitialisationError] / kInitialisationOctaves;
  return LikelihoodEnergy(tried.error, independent) + 0.5 * octaves * octaves;
}

class Search {
 public:
  Search(const std::function<double(const SpreadPowers&)>& error, double independent)
      : error_(error), independent_(independent) {
    least_ = EnergyAt(at_);
  }

  // As far along a direction as energies fall, one way or the other; false: nowhere.
  bool Descend(const SpreadPowers& direction) {
    return DescendBy(direction, -1) || DescendBy(direction, 1);
  }

  std::vector<TriedSpreads> tried() const {
    std::vector<TriedSpreads> all;
    for (const auto& [powers, error] : errors_) all.push_back({powers, error});
    return all;
  }

 private:
  double EnergyAt(const SpreadPowers& powers) {
    auto known = errors_.find(powers);
    if (known == errors_.end()) known = errors_.emplace(powers, error_(powers)).first;
    return Energy({powers, known->second}, independent_);
  }

  bool DescendBy(const SpreadPowers& direction, int sign) {
    bool moved = false;
    for (;; moved = true) {
      SpreadPowers next = at_;
      for (size_t i = 0; i < next.size(); ++i) {
        next[i] += sign * direction[i];
        if (next[i] < kLeast[i] || next[i] > kMost[i]) return moved;
      }
      const double energy = EnergyAt(next);
      if (!(energy < least_)) return moved;
      at_ = next;
      least_ = energy;
    }
  }

  const std::function<double(const SpreadPowers&)>& error_;
  const double independent_;
  std::map<SpreadPowers, double> errors_;
  SpreadPowers at_{};
  double least_ = 0;
};

// Of such negative logarithms; sum 1.
std::vector<double> Probabilities(const std::vector<double>& energies) {
  const double least = *std::min_element(energies.begin(), energies.end());
  std::vector<double> probabilities;
  double sum = 0;
  for (const double energy : energies) {
    sum += probabilities.emplace_back(std::exp(least - energy));
  }
  for (double& probability : probabilities) probability /= sum;
  return probabilities;
}

}  // namespace

std::vector<TriedSpreads> SearchSpreads(
    const std::function<double(const SpreadPowers& powers)>& error, double independent) {
  Search search(error, independent);
  for (int pass = 0; pass < kPasses; ++pass) {
    bool moved = false;
    for (const SpreadPowers& direction : kDirections) moved |= search.Descend(direction);
    if (!moved) break;
  }
  return search.tried();
}

SpreadFactors ProbableFactors(const std::vector<TriedSpreads>& tried, double independent) {
  std::vector<double> energies(tried.size());
  std::transform(tried.begin(), tried.end(), energies.begin(),
                 [&](const TriedSpreads& one) { return Energy(one, independent); });
  const std::vector<double> probabilities = Probabilities(energies);
  SpreadFactors variances{}, logarithms{}, factors;
  for (size_t t = 0; t < tried.size(); ++t) {
    for (size_t i = 0; i < kSpreadKinds; ++i) {
      variances[i] += probabilities[t] * std::exp2(2 * tried[t].powers[i]);
      logarithms[i] += probabilities[t] * tried[t].powers[i];
    }
  }
  for (size_t i = 0; i < kSpreadKinds; ++i) {
    // Where photographs say nearly all, large factors predict as well as larger ones, and a mean
    // variance is nearly the largest one's.
    const bool open = i == kDiffuseSpread || i == kInitialisationError;
    factors[i] = open ? std::exp2(logarithms[i]) : std::sqrt(variances[i]);
  }
  return factors;
}

double FactorOfMeanPrecision(std::span<const double> factors, const std::vector<double>& errors,
                             double independent) {
  std::vector<double> energies(errors.size());
  std::transform(errors.begin(), errors.end(), energies.begin(),
                 [&](double error) { return LikelihoodEnergy(error, independent); });
  const std::vector<double> probabilities = Probabilities(energies);
  double precision = 0;
  for (size_t i = 0; i < factors.size(); ++i) {
    precision += probabilities[i] / (factors[i] * factors[i]);
  }
  return 1 / std::sqrt(precision);
}

}  // namespace glint
