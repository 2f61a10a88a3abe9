#include "calib/light/turned_photos.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/camera/orientation.h"
#include "base/statistics/median.h"

namespace glint::light {
namespace {

// A photo's flash across the optical axis as it alone sees it, in its picture's frame.
struct SeenFlash {
  Eigen::Vector2d at_mm{0, 0};
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // 1/mm²
};

Eigen::Vector2d Turned(const Eigen::Vector2d& across, int turns) {
  return TurnedCameraPoint({across.x(), across.y(), 0}, turns).head<2>();
}

// ∂ ln E/∂(x, y) of a spot's irradiance by the flash's place, by central differences.
Eigen::Vector2d LogSlope(const SpotGeometry& spot, const Eigen::Vector3d& flash_mm) {
  constexpr double kStep_mm = 0.5;
  Eigen::Vector2d slope(0, 0);
  for (int axis = 0; axis < 2; ++axis) {
    double value[2] = {0, 0};
    for (int side = 0; side < 2; ++side) {
      Eigen::Vector3d moved = flash_mm;
      moved[axis] += side == 0 ? -kStep_mm : kStep_mm;
      if (!FlashOnSpot(spot, moved.data(), 0.0, &value[side])) return {0, 0};
    }
    slope[axis] = std::log(value[1] / value[0]) / (2 * kStep_mm);
  }
  return slope;
}

// The information of a photo's paper about its flash, its exposure being unknown.
SeenFlash Seen(const State& state, const PhotoState& photo) {
  SeenFlash seen{photo.flash_mm.head<2>(), Eigen::Matrix2d::Zero()};
  double all = 0;
  Eigen::Vector2d sum(0, 0);
  for (const Spot& spot : photo.spots) {
    if (!spot.inlier) continue;
    const Eigen::Vector2d slope = LogSlope(spot.geometry, photo.flash_mm);
    for (int c = 0; c < 3; ++c) {
      const double weight = std::pow(spot.seen[c] / (spot.sigma[c] * state.weighing_scale()), 2);
      seen.information += weight * slope * slope.transpose();
      sum += weight * slope;
      all += weight;
    }
  }
  if (all > 0) seen.information -= sum * sum.transpose() / all;
  return seen;
}

struct Explanation {
  double cost = std::numeric_limits<double>::infinity();
  std::vector<int> turns;  // per photo
  Eigen::Vector2d flash{0, 0};
};

// The turn of a photo under which `flash` (in the sensor's frame) explains it best.
std::pair<int, double> BestTurn(const LightPhoto& photo, const SeenFlash& seen, bool first,
                                const Eigen::Vector2d& flash) {
  // By turned_photos.h; where all may be turned or none, the first is not.
  const double kUntold = 2 * std::log(first ? 60.0 : 50.0);
  std::pair<int, double> best{photo.possible_turns[0], std::numeric_limits<double>::infinity()};
  for (const int turns : photo.possible_turns) {
    const Eigen::Vector2d off = Turned(flash, turns) - seen.at_mm;
    double cost = off.dot(seen.information * off);
    if (!photo.surely_turned && turns != photo.possible_turns[0]) cost += kUntold;
    if (cost < best.second) best = {turns, cost};
  }
  return best;
}

// Turns and flash in turns, from a first guess of the flash.
Explanation Explain(const LightProblem& problem, const State& state,
                    const std::vector<SeenFlash>& seen, Eigen::Vector2d flash) {
  constexpr int kRounds = 5;
  Explanation found;
  for (int round = 0; round < kRounds; ++round) {
    found.cost = 0;
    found.turns.assign(seen.size(), 0);
    Eigen::Matrix2d information = 1e-6 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d sum(0, 0);
    for (size_t i = 0; i < seen.size(); ++i) {
      if (!state.photos[i].used) continue;
      const auto [turns, cost] = BestTurn(problem.photos[i], seen[i], i == 0, flash);
      found.turns[i] = turns;
      found.cost += cost;
      Eigen::Matrix2d turn;  // takes the flash of the sensor's frame to the picture's
      turn << Turned({1, 0}, turns), Turned({0, 1}, turns);
      information += turn.transpose() * seen[i].information * turn;
      sum += turn.transpose() * seen[i].information * seen[i].at_mm;
    }
    found.flash = flash;
    flash = information.ldlt().solve(sum);
  }
  return found;
}

Explanation BestExplanation(const LightProblem& problem, const State& state,
                            const std::vector<SeenFlash>& seen) {
  Explanation best;
  for (size_t i = 0; i < seen.size(); ++i) {
    if (!state.photos[i].used) continue;
    for (const int turns : problem.photos[i].possible_turns) {
      const Explanation one = Explain(problem, state, seen, Turned(seen[i].at_mm, -turns));
      if (one.cost < best.cost) best = one;
    }
  }
  return best;
}

// By how much flashes scatter about the explanation more than their information says: the median
// of their squared lengths over that of two normal numbers. Another tone curve does that.
double BadnessOf(const State& state, const std::vector<SeenFlash>& seen, const Explanation& best) {
  std::vector<double> squares;
  for (size_t i = 0; i < seen.size(); ++i) {
    if (!state.photos[i].used) continue;
    const Eigen::Vector2d off = Turned(best.flash, best.turns[i]) - seen[i].at_mm;
    squares.push_back(off.dot(seen[i].information * off));
  }
  return Median(squares) / (2 * std::log(2.0));
}

void Discount(double badness, std::vector<SeenFlash>* seen) {
  for (SeenFlash& one : *seen) one.information /= std::max(1.0, badness);
}

struct Found {
  Explanation explanation;
  double badness = 0;
};

Found FindWith(const LightProblem& problem, const LightOptions& options, const State& start,
               bool hold_tone) {
  constexpr int kRounds = 3;  // of weights by the solution
  State own = start;
  own.own_flashes = true;
  own.hold_tone = hold_tone;
  for (PhotoState& photo : own.photos) photo.flash_mm = options.offset_mm;
  for (int round = 0; round < kRounds; ++round) {
    Solve(options, true, &own);
    Reweigh(&own);
  }
  std::vector<SeenFlash> seen;
  for (const PhotoState& photo : own.photos) {
    seen.push_back(photo.used ? Seen(own, photo) : SeenFlash());
  }
  Found found{BestExplanation(problem, own, seen), 0};
  found.badness = BadnessOf(own, seen, found.explanation);
  Discount(found.badness, &seen);
  found.explanation = BestExplanation(problem, own, seen);
  return found;
}

}  // namespace

void TurnSpots(int turns, PhotoState* photo) {
  for (Spot& spot : photo->spots) {
    SpotGeometry& geometry = spot.geometry;
    geometry.spot_in_camera_mm = TurnedCameraPoint(geometry.spot_in_camera_mm, -turns);
    geometry.normal_in_camera = TurnedCameraPoint(geometry.normal_in_camera, -turns);
  }
}

bool FindTurns(const LightProblem& given, const LightOptions& options, bool unexpected,
               State* state) {
  LightProblem problem = given;
  bool any = false;
  for (LightPhoto& photo : problem.photos) {
    if (!unexpected && !photo.surely_turned) photo.possible_turns.resize(1);
    any = any || photo.possible_turns.size() > 1;
  }
  if (!any) return false;
  Found best = FindWith(problem, options, *state, true);
  if (!options.tone_known) {  // or a wrong curve would move flashes
    Found toned = FindWith(problem, options, *state, false);
    if (toned.badness < best.badness) best = std::move(toned);
  }
  any = false;
  for (size_t i = 0; i < best.explanation.turns.size(); ++i) {
    if (!state->photos[i].used || best.explanation.turns[i] == 0) continue;
    state->photos[i].turns = best.explanation.turns[i];
    TurnSpots(best.explanation.turns[i], &state->photos[i]);
    any = any || !problem.photos[i].surely_turned;
  }
  return any;
}

}  // namespace glint::light
