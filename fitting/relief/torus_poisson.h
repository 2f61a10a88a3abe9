// Screened Poisson equations on a torus: grids whose last row and column have the first as
// neighbours.
#pragma once

#include <vector>

namespace glint {

// H·W values u that minimise
//
//   Σ (u(r, c + 1) − u(r, c) − across(r, c))² + (u(r + 1, c) − u(r, c) − down(r, c))²
//     + screening·(u(r, c) − data(r, c))²,
//
// indices modulo H and W; solved exactly by Fourier transforms. Without screening the mean is that
// of `data`. `data` may be empty: zeros.
std::vector<double> SolveTorusPoisson(int width, int height, const std::vector<double>& across,
                                      const std::vector<double>& down,
                                      const std::vector<double>& data, double screening);

}  // namespace glint
