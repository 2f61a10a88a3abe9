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
// Roughness varies within many substances whose specular albedo does not.
constexpr std::array<SpreadPowers, 5> kDirections = {
    {{1, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 1, 0, 0, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}}};
constexpr int kPasses = 3;

class Search {
 public:
  explicit Search(const std::function<double(const SpreadPowers&)>& error) : error_(error) {
    least_ = ErrorAt(at_);
  }

  // As far along a direction as errors fall, one way or the other; false: nowhere.
  bool Descend(const SpreadPowers& direction) {
    return DescendBy(direction, -1) || DescendBy(direction, 1);
  }

  std::vector<TriedSpreads> tried() const {
    std::vector<TriedSpreads> all;
    for (const auto& [powers, error] : errors_) all.push_back({powers, error});
    return all;
  }

 private:
  double ErrorAt(const SpreadPowers& powers) {
    const auto known = errors_.find(powers);
    if (known != errors_.end()) return known->second;
    return errors_[powers] = error_(powers);
  }

  bool DescendBy(const SpreadPowers& direction, int sign) {
    bool moved = false;
    for (;; moved = true) {
      SpreadPowers next = at_;
      for (size_t i = 0; i < next.size(); ++i) {
        next[i] += sign * direction[i];
        if (next[i] < kLeast[i] || next[i] > kMost[i]) return moved;
      }
      const double error = ErrorAt(next);
      if (!(error < least_)) return moved;
      at_ = next;
      least_ = error;
    }
  }

  const std::function<double(const SpreadPowers&)>& error_;
  std::map<SpreadPowers, double> errors_;
  SpreadPowers at_{};
  double least_ = 0;
};

// Gauss's likelihoods of as many residuals, their variance the least that is found; sum 1.
std::vector<double> Likelihoods(const std::vector<double>& errors, double independent) {
  // 0 where all photographs that were held out are masked.
  const double least = std::max(*std::min_element(errors.begin(), errors.end()), 1e-300);
  std::vector<double> likelihoods;
  double sum = 0;
  for (const double error : errors) {
    sum += likelihoods.emplace_back(std::exp(-0.5 * independent * (error / least - 1)));
  }
  for (double& likelihood : likelihoods) likelihood /= sum;
  return likelihoods;
}

}  // namespace

std::vector<TriedSpreads> SearchSpreads(
    const std::function<double(const SpreadPowers& powers)>& error) {
  Search search(error);
  for (int pass = 0; pass < kPasses; ++pass) {
    bool moved = false;
    for (const SpreadPowers& direction : kDirections) moved |= search.Descend(direction);
    if (!moved) break;
  }
  return search.tried();
}

SpreadFactors LikelyFactors(const std::vector<TriedSpreads>& tried, double independent) {
  std::vector<double> errors(tried.size());
  for (size_t t = 0; t < tried.size(); ++t) errors[t] = tried[t].error;
  const std::vector<double> likelihoods = Likelihoods(errors, independent);
  SpreadFactors variances{}, logarithms{}, factors;
  for (size_t t = 0; t < tried.size(); ++t) {
    for (size_t i = 0; i < kSpreadKinds; ++i) {
      variances[i] += likelihoods[t] * std::exp2(2 * tried[t].powers[i]);
      logarithms[i] += likelihoods[t] * tried[t].powers[i];
    }
  }
  for (size_t i = 0; i < kSpreadKinds; ++i) {
    // Where photographs say nearly all, large factors are as likely as larger ones, and a mean
    // variance is the largest one's.
    const bool open = i == kDiffuseSpread || i == kInitialisationError;
    factors[i] = open ? std::exp2(logarithms[i]) : std::sqrt(variances[i]);
  }
  return factors;
}

double FactorOfMeanPrecision(std::span<const double> factors, const std::vector<double>& errors,
                             double independent) {
  const std::vector<double> likelihoods = Likelihoods(errors, independent);
  double precision = 0;
  for (size_t i = 0; i < factors.size(); ++i) {
    precision += likelihoods[i] / (factors[i] * factors[i]);
  }
  return 1 / std::sqrt(precision);
}

}  // namespace glint
