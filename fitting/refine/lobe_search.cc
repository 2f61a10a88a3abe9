#include "fitting/refine/lobe_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/model/estimate.h"

namespace glint {
namespace {

using LobePlace = std::pair<int, int>;  // places of a share and a ratio
constexpr LobePlace kNearestToOne = {1, 0};
constexpr std::array<LobePlace, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

using Predict = std::function<HeldOutErrors(const SpecularLobes& lobes)>;

SpecularLobes LobesAt(const LobePlace& place, double coat_f0) {
  return {constants::kNarrowLobeShares[static_cast<size_t>(place.first)],
          constants::kNarrowLobeRatios[static_cast<size_t>(place.second)], coat_f0};
}

bool InLattice(const LobePlace& place) {
  return place.first >= 0 && place.first < static_cast<int>(constants::kNarrowLobeShares.size()) &&
         place.second >= 0 && place.second < static_cast<int>(constants::kNarrowLobeRatios.size());
}

// ln(ratio)·(cos 2φ, sin 2φ) in steps.
using StretchPlace = std::pair<int, int>;

double LogRatio(const StretchPlace& place) {
  return constants::kAnisotropyStep * std::hypot(place.first, place.second);
}

Anisotropy AnisotropyAt(const StretchPlace& place) {
  if (place == StretchPlace{0, 0}) return {};
  const double half_turn_deg = std::atan2(place.second, place.first) * (90 / std::numbers::pi);
  return {std::exp(LogRatio(place)), half_turn_deg < 0 ? half_turn_deg + 180 : half_turn_deg};
}

struct LobeChoice {
  SpecularLobes lobes;
  HeldOutErrors errors;
};

// The best two lobes of a kind, where the first that are tried predict better than `one`.
std::optional<LobeChoice> SearchKind(double coat_f0, const HeldOutErrors& one,
                                     const Predict& predict) {
  std::map<LobePlace, HeldOutErrors> known;
  const auto at = [&](const LobePlace& place) -> const HeldOutErrors& {
    auto found = known.find(place);
    if (found == known.end()) found = known.emplace(place, predict(LobesAt(place, coat_f0))).first;
    return found->second;
  };
  LobePlace best = kNearestToOne;
  if (!(at(best).EnergyAgainst(one) < 0)) return std::nullopt;
  for (bool moved = true; moved;) {
    moved = false;
    for (const LobePlace& step : kSteps) {
      const LobePlace next = {best.first + step.first, best.second + step.second};
      // The sums: a may be more probable than b, b than c and c than a.
      if (!InLattice(next) || !(at(next).sum() < at(best).sum())) continue;
      best = next;
      moved = true;
      break;
    }
  }
  return LobeChoice{LobesAt(best, coat_f0), at(best)};
}

}  // namespace

bool AskForShortTails(const HeldOutErrors& short_tails, const HeldOutErrors& ggx) {
  return short_tails.EnergyAgainst(ggx) < -constants::kShortTailLogOdds;
}

bool AskForAnisotropy(const HeldOutErrors& anisotropic, const HeldOutErrors& isotropic) {
  return anisotropic.EnergyAgainst(isotropic) < -constants::kAnisotropyLogOdds;
}

bool AskForOneRoughness(const HeldOutErrors& one, const HeldOutErrors& as_found) {
  return one.EnergyAgainst(as_found) < -constants::kRoughnessLogOdds;
}

std::optional<double> SearchRoughness(const HeldOutErrors& as_found,
                                      const std::function<HeldOutErrors(double)>& predict) {
  constexpr int kLevels = static_cast<int>(constants::kRoughnessLevels.size()), kFirst = 1;
  const auto sum = [&](int place) {
    return predict(constants::kRoughnessLevels[static_cast<size_t>(place)]).sum();
  };
  int best = kFirst;
  double least = sum(kFirst);
  for (const int step : {1, -1}) {
    while (best + step >= 0 && best + step < kLevels) {
      const double next = sum(best + step);
      if (!(next < least)) break;
      least = next;
      best += step;
    }
    if (best != kFirst) break;
  }
  if (!(least < as_found.sum())) return std::nullopt;
  return constants::kRoughnessLevels[static_cast<size_t>(best)];
}

Anisotropy SearchAnisotropy(const std::function<HeldOutErrors(const Anisotropy&)>& predict) {
  std::map<StretchPlace, double> known;
  const auto at = [&](const StretchPlace& place) {
    auto found = known.find(place);
    if (found == known.end()) {
      found = known.emplace(place, predict(AnisotropyAt(place)).sum()).first;
    }
    return found->second;
  };
  StretchPlace best = {0, 0};
  for (bool moved = true; moved;) {
    moved = false;
    for (const LobePlace& direction : kSteps) {
      const StretchPlace next = {best.first + direction.first, best.second + direction.second};
      if (LogRatio(next) > std::log(kMostAnisotropy) || !(at(next) < at(best))) continue;
      best = next;
      moved = true;
    }
  }
  return AnisotropyAt(best);
}

bool AskForTwoLobes(const HeldOutErrors& two, const HeldOutErrors& one) {
  return two.EnergyAgainst(one) < -constants::kSecondLobeLogOdds;
}

std::vector<SpecularLobes> SearchLobes(double coat_f0, const Predict& predict) {
  const HeldOutErrors one = predict({});
  std::vector<LobeChoice> found;
  for (const double f0 : {0.0, coat_f0}) {
    const auto best = SearchKind(f0, one, predict);
    if (best && AskForTwoLobes(best->errors, one)) found.push_back(*best);
  }
  std::stable_sort(found.begin(), found.end(), [](const LobeChoice& a, const LobeChoice& b) {
    return a.errors.sum() < b.errors.sum();
  });
  std::vector<SpecularLobes> lobes;
  lobes.reserve(found.size());
  for (const LobeChoice& choice : found) lobes.push_back(choice.lobes);
  return lobes;
}

}  // namespace glint
