// Fourier transform of square planes.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace glint {

using Complex = std::complex<double>;

// In place, side × side, row-major; e^(−2πi…), no scaling. The inverse divides by side². Throws
// std::invalid_argument when the plane has another size.
void Fourier2d(std::vector<Complex>* plane, int side);
void InverseFourier2d(std::vector<Complex>* plane, int side);

// Signed frequency, in cycles a side, of the index-th coefficient.
inline int FrequencyOf(int index, int side) { return index <= side / 2 ? index : index - side; }

bool IsPowerOfTwo(int n);

}  // namespace glint
