// Counter-based random numbers: the n-th number of a stream depends on nothing but the stream's
// name, so that training resumes exactly and batches do not depend on threads.
#pragma once

#include <cmath>
#include <cstdint>

namespace glint {

// SplitMix64's finaliser (Steele, Lea, Flood 2014).
inline std::uint64_t MixBits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

inline std::uint64_t StreamSeed(std::uint64_t seed, std::uint64_t stream) {
  return MixBits(MixBits(seed) ^ (stream * 0xD1342543DE82EF95ull));
}

class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(seed) {}
  std::uint64_t Bits() { return MixBits(state_++); }
  double Uniform() { return static_cast<double>(Bits() >> 11) * 0x1.0p-53; }  // [0, 1)
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  int Below(int n) { return static_cast<int>(Uniform() * n); }
  double Normal() {  // Box–Muller, one of the pair
    const double u = 1.0 - Uniform(), v = Uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
  }

 private:
  std::uint64_t state_;
};

}  // namespace glint
