#include "fitting/refine/spread_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "base/model/estimate.h"

namespace glint {
namespace {

// Roughness varies within many substances whose specular albedo does not.
constexpr std::array<SpreadPowers, 7> kDirections = {{{1, 1, 0, 0, 0, 0},
                                                      {0, 0, 1, 0, 0, 0},
                                                      {0, 1, 0, 0, 0, 0},
                                                      {0, 0, 0, 1, 0, 0},
                                                      {0, 0, 0, 0, 1, 0},
                                                      {0, 0, 0, 0, 0, 1},
                                                      {1, 1, 0, 0, 0, -1}}};
// Of what is known beforehand.
double PriorEnergy(const SpreadPowers& powers) {
  const double octaves = powers[kInitialisationError] / constants::kInitialisationOctaves;
  return 0.5 * octaves * octaves;
}

bool InRange(const SpreadPowers& powers) {
  for (size_t i = 0; i < powers.size(); ++i) {
    if (powers[i] < constants::kLeastSdOctaves[i]) return false;
    if (powers[i] > constants::kMostSdOctaves[i]) return false;
  }
  return true;
}

SpreadPowers Moved(SpreadPowers powers, const SpreadPowers& direction, int sign) {
  for (size_t i = 0; i < powers.size(); ++i) powers[i] += sign * direction[i];
  return powers;
}

class Search {
 public:
  // The first that are predicted, in full, are narrow ones, which Descend() tries first: texels of
  // all others begin where these have theirs, nearer to their substances than with wide ones.
  Search(const PredictBySpreads& predict, const SpreadPowers& from)
      : predict_(predict), at_(from), best_(0) {
    const SpreadPowers narrower = Moved(from, kDirections.front(), -1);
    if (InRange(narrower)) known_.emplace(narrower, predict(narrower, {}));
    best_ = known_.emplace(from, predict(from, {})).first->second;
  }

  // As far along a direction as others are better, one way or the other; false: nowhere.
  bool Descend(const SpreadPowers& direction) {
    return DescendBy(direction, -1) || DescendBy(direction, 1);
  }

  // All along the axes through the best, each way until it is improbable. true: something better
  // was met, which is the best now.
  bool Surround() {
    around_ = {{at_, 0.0}};
    for (size_t i = 0; i < kSpreadKinds; ++i) {
      SpreadPowers axis{};
      axis[i] = 1;
      for (const int sign : {-1, 1}) {
        for (SpreadPowers next = Moved(at_, axis, sign); InRange(next);
             next = Moved(next, axis, sign)) {
          if (MoveIfBetter(next)) return true;
          around_.push_back({next, EnergyAt(next)});
          if (around_.back().energy > constants::kImprobable) break;
        }
      }
    }
    return false;
  }

  const std::vector<TriedSpreads>& around() const { return around_; }

 private:
  // Against the best as it is. One that was given up against another is finished where it is not
  // improbable against this one.
  double EnergyAt(const SpreadPowers& powers) {
    const double prior = PriorEnergy(powers) - PriorEnergy(at_);
    // Energies grow with what is known.
    const auto energy = [&](const HeldOutErrors& errors) {
      const double share = static_cast<double>(errors.folds()) / static_cast<double>(best_.folds());
      return errors.EnergyAgainst(best_) / share + prior;
    };
    const auto give_up = [&](const HeldOutErrors& first_folds) {
      return first_folds.EnergyAgainst(best_) + prior > constants::kGivenUp;
    };
    auto known = known_.find(powers);
    if (known == known_.end()) {
      known = known_.emplace(powers, predict_(powers, give_up)).first;
    } else if (known->second.folds() < best_.folds() &&
               energy(known->second) < constants::kImprobable) {
      known->second = predict_(powers, {});
    }
    return energy(known->second);
  }

  // Never back to one that something was better than: a may be better than b, b than c and c than
  // a.
  bool MoveIfBetter(const SpreadPowers& next) {
    if (left_.contains(next) || !(EnergyAt(next) < 0)) return false;
    left_.insert(at_);
    at_ = next;
    best_ = known_.at(next);
    return true;
  }

  bool DescendBy(const SpreadPowers& direction, int sign) {
    bool moved = false;
    for (;; moved = true) {
      const SpreadPowers next = Moved(at_, direction, sign);
      if (!InRange(next) || !MoveIfBetter(next)) return moved;
    }
  }

  const PredictBySpreads& predict_;
  std::map<SpreadPowers, HeldOutErrors> known_;
  std::set<SpreadPowers> left_;
  SpreadPowers at_;
  HeldOutErrors best_;  // of at_
  std::vector<TriedSpreads> around_;
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

std::vector<TriedSpreads> SearchSpreads(const PredictBySpreads& predict, const SpreadPowers& from) {
  Search search(predict, from);
  for (bool moved = true; moved;) {
    moved = false;
    for (const SpreadPowers& direction : kDirections) moved |= search.Descend(direction);
    moved = moved || search.Surround();
  }
  return search.around();
}

SpreadFactors ProbableFactors(const std::vector<TriedSpreads>& tried) {
  const SpreadPowers& best = tried.front().powers;
  SpreadFactors factors;
  for (size_t i = 0; i < kSpreadKinds; ++i) {
    std::vector<double> energies, alternatives;
    for (const TriedSpreads& one : tried) {
      SpreadPowers elsewhere = one.powers;
      elsewhere[i] = best[i];
      if (elsewhere != best) continue;
      energies.push_back(one.energy);
      alternatives.push_back(std::exp2(one.powers[i]));
    }
    const std::vector<double> probabilities = Probabilities(energies);
    factors[i] =
        std::inner_product(alternatives.begin(), alternatives.end(), probabilities.begin(), 0.0);
  }
  return factors;
}

}  // namespace glint
