#include "fitting/refine/lobe_search.h"

#include <array>
#include <map>
#include <optional>
#include <utility>

#include "base/model/constants.h"

namespace glint {
namespace {

using LobePlace = std::pair<int, int>;  // places of a share and a ratio
constexpr LobePlace kNearestToOne = {1, 0};
constexpr std::array<LobePlace, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

SpecularLobes LobesAt(const LobePlace& place) {
  return {constants::kNarrowLobeShares[static_cast<size_t>(place.first)],
          constants::kNarrowLobeRatios[static_cast<size_t>(place.second)]};
}

bool InLattice(const LobePlace& place) {
  return place.first >= 0 && place.first < static_cast<int>(constants::kNarrowLobeShares.size()) &&
         place.second >= 0 && place.second < static_cast<int>(constants::kNarrowLobeRatios.size());
}

}  // namespace

bool AskForTwoLobes(const HeldOutErrors& two, const HeldOutErrors& one) {
  return two.EnergyAgainst(one) < -constants::kSecondLobeLogOdds;
}

SpecularLobes SearchLobes(const std::function<HeldOutErrors(const SpecularLobes& lobes)>& predict) {
  std::map<LobePlace, HeldOutErrors> known;
  const auto at = [&](const LobePlace& place) -> const HeldOutErrors& {
    auto found = known.find(place);
    if (found == known.end()) found = known.emplace(place, predict(LobesAt(place))).first;
    return found->second;
  };
  const HeldOutErrors one = predict({});
  LobePlace best = kNearestToOne;
  if (!(at(best).EnergyAgainst(one) < 0)) return {};
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
  return AskForTwoLobes(at(best), one) ? LobesAt(best) : SpecularLobes();
}

}  // namespace glint
