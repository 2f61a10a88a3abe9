// Where two overlapping copies of maps are joined: the path along which they agree best.
#pragma once

#include <functional>
#include <vector>

namespace glint {

// For each of `steps` places along the overlap, how many of its `depth` texels come from the first
// copy: a path that moves by at most one texel a step and has the least sum of cost(step,
// position), positions 0 … depth − 1 (dynamic programming; Efros and Freeman, "Image quilting",
// 2001). `cyclic`: the last step has the first as its neighbour.
std::vector<int> CheapestPath(int steps, int depth, bool cyclic,
                              const std::function<double(int step, int position)>& cost);

}  // namespace glint
