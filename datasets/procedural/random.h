// Hashes and a small generator: every draw follows from the seed alone, on any machine and thread.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace glint::procedural {

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014).
inline uint64_t Mix64(uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

// Avalanche of one 32-bit word; written so that loops over it vectorise.
inline uint32_t Hash1(uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

// Hash of an integer lattice point.
inline uint32_t Hash2(int32_t ix, int32_t iy, uint32_t seed) {
  return Hash1(static_cast<uint32_t>(ix) * 0x8da6b343u + static_cast<uint32_t>(iy) * 0xd8163841u +
               seed);
}

// Upper 24 bits as a float in [0, 1).
inline float ToUnit(uint32_t h) {
  return static_cast<float>(static_cast<int32_t>(h >> 8)) * (1.0f / 16777216.0f);
}

// The k-th independent number in [0, 1) of a cell.
inline float CellRandom(uint32_t id, uint32_t k) { return ToUnit(Hash1(id + k * 0x9e3779b9u)); }

// Sequential generator for the parameters of a material.
class Rng {
 public:
  explicit Rng(uint64_t seed) : state_(Mix64(seed)) {}

  uint64_t Next() { return Mix64(state_ += 0x632be59bd9b4e019ull); }
  uint32_t Seed() { return static_cast<uint32_t>(Next() >> 32); }
  // Uniform in [0, 1).
  float Unit() { return static_cast<float>(Next() >> 40) * (1.0f / 16777216.0f); }
  float Uniform(float low, float high) { return low + (high - low) * Unit(); }
  // Uniform in the logarithm, for sizes and frequencies; 0 < low ≤ high.
  float LogUniform(float low, float high) { return low * std::exp(Unit() * std::log(high / low)); }
  // Integer in [low, high].
  int Int(int low, int high) {
    return low + static_cast<int>(Next() % static_cast<uint64_t>(high - low + 1));
  }
  // Standard normal, by Box and Muller.
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(1.0 - Unit()));
    return radius * std::cos(2 * std::numbers::pi * Unit());
  }
  bool Chance(float probability) { return Unit() < probability; }

 private:
  uint64_t state_;
};

}  // namespace glint::procedural
