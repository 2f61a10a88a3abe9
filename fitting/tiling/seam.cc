#include "fitting/tiling/seam.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace glint {
namespace {

constexpr double kForbidden = std::numeric_limits<double>::infinity();

struct Path {
  std::vector<int> positions;
  double cost = kForbidden;
};

// From any position, or from `only` (and back to within one texel of it).
Path Cheapest(int steps, int depth, int only, const std::vector<double>& costs) {
  std::vector<double> sums(costs.begin(), costs.begin() + depth);
  if (only >= 0) {
    for (int p = 0; p < depth; ++p) {
      if (p != only) sums[static_cast<size_t>(p)] = kForbidden;
    }
  }
  std::vector<std::int8_t> moves(static_cast<size_t>(steps) * depth);
  std::vector<double> next(sums.size());
  for (int step = 1; step < steps; ++step) {
    for (int p = 0; p < depth; ++p) {
      int best = 0;
      for (const int move : {-1, 1}) {
        const int from = p + move;
        if (from < 0 || from >= depth) continue;
        if (sums[static_cast<size_t>(from)] < sums[static_cast<size_t>(p + best)]) best = move;
      }
      const size_t i = static_cast<size_t>(step) * depth + p;
      moves[i] = static_cast<std::int8_t>(best);
      next[static_cast<size_t>(p)] = sums[static_cast<size_t>(p + best)] + costs[i];
    }
    sums.swap(next);
  }
  Path path;
  int end = 0;
  for (int p = 0; p < depth; ++p) {
    if (only >= 0 && std::abs(p - only) > 1) continue;
    if (sums[static_cast<size_t>(p)] >= path.cost) continue;
    path.cost = sums[static_cast<size_t>(p)];
    end = p;
  }
  path.positions.resize(static_cast<size_t>(steps));
  for (int step = steps - 1; step >= 0; --step) {
    path.positions[static_cast<size_t>(step)] = end;
    if (step > 0) end += moves[static_cast<size_t>(step) * depth + end];
  }
  return path;
}

}  // namespace

std::vector<int> CheapestPath(int steps, int depth, bool cyclic,
                              const std::function<double(int, int)>& cost) {
  std::vector<double> costs(static_cast<size_t>(steps) * depth);
  for (int step = 0; step < steps; ++step) {
    for (int p = 0; p < depth; ++p) {
      costs[static_cast<size_t>(step) * depth + p] = cost(step, p);
    }
  }
  if (!cyclic) return Cheapest(steps, depth, -1, costs).positions;
  Path best;
  for (int p = 0; p < depth; ++p) {
    Path path = Cheapest(steps, depth, p, costs);
    if (path.cost < best.cost) best = std::move(path);
  }
  return best.positions;
}

}  // namespace glint
