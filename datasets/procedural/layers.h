// What a family of materials writes: rows of relief and reflectance at arbitrary points.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace glint::procedural {

// A row of points of the pattern's plane. One unit is about the longer side of the picture.
struct RowDomain {
  const float* x;
  const float* y;
  int n;
  float pixel;  // spacing of texels
};

// Rows to fill, n values each.
struct RowLayers {
  float* height;  // any unit: relief is brought to the drawn slope afterwards
  float* r;       // base colour, linear: diffuse albedo of a dielectric, F0 of a metal
  float* g;
  float* b;
  float* metal;      // 0 dielectric … 1 metal
  float* f0;         // F0 of the dielectric part
  float* roughness;  // (0, 1]
};

// Row buffers that families borrow for a single call; nothing is allocated once warm.
class Scratch {
 public:
  explicit Scratch(int n) : n_(n) {}
  void Reset() { used_floats_ = used_ids_ = 0; }
  float* Row() { return Take(floats_, used_floats_); }
  uint32_t* Ids() { return Take(ids_, used_ids_); }

 private:
  template <typename T>
  T* Take(std::vector<std::unique_ptr<T[]>>& rows, size_t& used) {
    if (used == rows.size()) rows.push_back(std::make_unique<T[]>(n_));
    return rows[used++].get();
  }
  int n_;
  size_t used_floats_ = 0, used_ids_ = 0;
  std::vector<std::unique_ptr<float[]>> floats_;
  std::vector<std::unique_ptr<uint32_t[]>> ids_;
};

// Fills every layer at the given points. A pure function of the points.
using RowFunction = std::function<void(const RowDomain&, Scratch&, const RowLayers&)>;

}  // namespace glint::procedural
