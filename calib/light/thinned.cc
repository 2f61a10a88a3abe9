#include "calib/light/thinned.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "calib/light/turned_photos.h"

namespace glint::light {

State Thinned(const State& full, size_t spots) {
  State thin = full;
  size_t before = 0, after = 0;
  for (PhotoState& photo : thin.photos) {
    const size_t step = (photo.spots.size() + spots - 1) / spots;
    std::vector<Spot> kept;
    for (size_t i = step / 2; i < photo.spots.size(); i += step) kept.push_back(photo.spots[i]);
    if (!photo.spots.empty()) {
      photo.kept_share *=
          static_cast<double>(kept.size()) / static_cast<double>(photo.spots.size());
    }
    before += photo.spots.size();
    after += kept.size();
    photo.spots = std::move(kept);
  }
  // As many spots of a block as before would count.
  const double share =
      static_cast<double>(after) / static_cast<double>(std::max<size_t>(1, before));
  thin.shared = std::max(1.0, thin.shared * std::sqrt(share));
  return thin;
}

void Adopt(const State& thin, State* full) {
  State adopted = thin;
  adopted.shared = full->shared;
  for (size_t i = 0; i < adopted.photos.size(); ++i) {
    adopted.photos[i].spots = std::move(full->photos[i].spots);
    adopted.photos[i].kept_share = full->photos[i].kept_share;
    TurnSpots(adopted.photos[i].turns - full->photos[i].turns, &adopted.photos[i]);
  }
  *full = std::move(adopted);
}

}  // namespace glint::light
