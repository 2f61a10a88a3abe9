#include "datasets/statistics/fourier.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace glint {
namespace {

// Radix 2, decimation in time (Cooley and Tukey 1965).
void Fourier1d(Complex* data, int n, const std::vector<Complex>& turns) {
  for (int i = 1, j = 0; i < n; ++i) {
    int bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(data[i], data[j]);
  }
  for (int length = 2; length <= n; length *= 2) {
    const int half = length / 2, stride = n / length;
    for (int first = 0; first < n; first += length) {
      for (int k = 0; k < half; ++k) {
        const Complex odd = data[first + k + half] * turns[static_cast<size_t>(k) * stride];
        const Complex even = data[first + k];
        data[first + k] = even + odd;
        data[first + k + half] = even - odd;
      }
    }
  }
}

void Transpose(std::vector<Complex>* plane, int side) {
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < y; ++x) {
      std::swap((*plane)[static_cast<size_t>(y) * side + x],
                (*plane)[static_cast<size_t>(x) * side + y]);
    }
  }
}

void Transform(std::vector<Complex>* plane, int side, double sign) {
  if (!IsPowerOfTwo(side) || plane->size() != static_cast<size_t>(side) * side) {
    throw std::invalid_argument("Fourier transform of a side of " + std::to_string(side) +
                                "; it must be a power of two, and the plane square");
  }
  std::vector<Complex> turns(static_cast<size_t>(side) / 2 + 1);
  for (size_t k = 0; k < turns.size(); ++k) {
    turns[k] = std::polar(1.0, sign * 2 * M_PI * static_cast<double>(k) / side);
  }
  for (int pass = 0; pass < 2; ++pass) {
    for (int row = 0; row < side; ++row) {
      Fourier1d(plane->data() + static_cast<size_t>(row) * side, side, turns);
    }
    Transpose(plane, side);
  }
}

}  // namespace

bool IsPowerOfTwo(int n) { return n > 0 && (n & (n - 1)) == 0; }

void Fourier2d(std::vector<Complex>* plane, int side) { Transform(plane, side, -1); }

void InverseFourier2d(std::vector<Complex>* plane, int side) {
  Transform(plane, side, 1);
  for (Complex& value : *plane) value /= static_cast<double>(side) * side;
}

}  // namespace glint
