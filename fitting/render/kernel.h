// Inside of glint_render: the fused kernel's job description, and its choice by instruction set.
// One source (kernel.inl) is compiled once for each set, in float for use and double for tests.
#pragma once

#include <cstddef>

#include "base/cpu/instruction_set.h"
#include "base/reflectance/lobe_mix.h"

namespace glint::kernel {

enum class Mode {
  kRender,        // radiance into View::rendered
  kAdjoint,       // View::image is ∂loss/∂radiance; gradient of the maps
  kLoss,          // loss against View::image, or against renderings of Job::target_planes
  kLossGradient,  // and its gradient
};

template <class T>
struct View {
  T camera_mm[3];
  T light_mm[3];
  T exposed_light[3];        // exposure·light_rgb
  T exposed_ambient[3];      // exposure·ambient_rgb
  const T* image = nullptr;  // 3 planes `image_stride` apart
  const T* mask = nullptr;   // or null: all 1
  T* rendered = nullptr;     // 3 planes `image_stride` apart
};

// What a view collects over texels; sums are not divided by anything.
struct ViewSums {
  static constexpr int kCount = 8;
  // Σ mask·|…| of three channels, Σ mask, ∂Σ/∂exposed_light, ∂Σ/∂exposed_ambient.
  double values[kCount] = {};
  double loss() const { return values[0]; }
  double weight() const { return values[1]; }
  double light(int c) const { return values[2 + c]; }
  double ambient(int c) const { return values[5 + c]; }
};

// One set of maps under its views.
template <class T>
struct Job {
  int width = 0;
  int height = 0;
  const T* x_mm = nullptr;  // per column
  const T* y_mm = nullptr;  // per row
  const T* planes = nullptr;
  size_t plane_stride = 0;
  const T* target_planes =
      nullptr;  // loss modes: compare with renderings of these, not with images
  size_t target_stride = 0;
  T* gradient = nullptr;  // overwritten
  size_t gradient_stride = 0;
  size_t image_stride = 0;
  const View<T>* views = nullptr;
  int view_count = 0;
  bool inverse_square = true;
  bool one_minus_specular = false;
  LobeMix<T> mix;
  bool clamp_rendered = false;  // loss modes: to at most 1
  T log_offset = T(0.01);
};

// Loss modes: radiances above count as this, so that products of three stay finite.
inline constexpr double kMostRadiance = 1e12;

// Columns that are worked on together: gradients of so many texels stay in the first-level cache.
inline constexpr int kChunk = 128;
inline constexpr int kPlanes = 10;  // of the maps: kSvbrdfPlanes

// Bytes of scratch RunRows needs, to be aligned to 64.
inline size_t ScratchBytes(int view_count) {
  constexpr size_t kWidestVector = 64;
  return static_cast<size_t>(view_count) * ViewSums::kCount * kWidestVector;
}

// Adds the sums of rows [row_begin, row_end) to sums[view_count]; writes those rows' outputs.
template <class T>
using RunRowsFunction = void (*)(const Job<T>& job, Mode mode, int row_begin, int row_end,
                                 void* scratch, ViewSums* sums);

template <class T>
RunRowsFunction<T> RunRows(InstructionSet set);  // for float and double
template <>
RunRowsFunction<float> RunRows<float>(InstructionSet set);
template <>
RunRowsFunction<double> RunRows<double>(InstructionSet set);

}  // namespace glint::kernel
