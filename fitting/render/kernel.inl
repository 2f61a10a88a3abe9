// The fused kernel. Included by kernel_<set>.cc, each compiled for its instruction set, after it
// has defined GLINT_VECTOR_BYTES and GLINT_KERNEL_NAME.
//
// Loop order: rows, chunks of kChunk columns, views, vectors. A chunk's texels and gradients stay
// in the first-level cache while all views pass over them; images are read once, in order.

#if GLINT_VECTOR_BYTES > 16
#include <immintrin.h>
#endif

#include "base/reflectance/brdf_core.h"
#include "fitting/render/kernel.h"

namespace glint::kernel {
namespace {

#include "base/cpu/vectors.inl"

}  // namespace
}  // namespace glint::kernel

#include "base/reflectance/brdf_vectors.inl"

namespace glint::kernel {
namespace {

#include "fitting/render/kernel_shade.inl"

// Texels of one row that are worked on together, in vectors. Lanes beyond the row's end hold zeros,
// and weigh nothing.
template <class T>
struct Chunk {
  static constexpr int kVectors = kChunk / kLanes<T>;
  Texels<T> texels[kVectors];
  Texels<T> target[kVectors];
  VectorOf<T> x_mm[kVectors];
  VectorOf<T> gradient[kVectors][kPlanes];
  // Of one view at a time, in the modes with a gradient.
  Directions<T> directions[kVectors];
  Shading<T> shading[kVectors];
  VectorOf<T> by_image[kVectors][3];
};

template <class T>
GLINT_INLINE Texels<T> LoadTexels(const T* planes, size_t stride, int count) {
  Texels<T> texels;
  for (int i = 0; i < 3; ++i) {
    texels.normal[i] = Load(planes + i * stride, count);
    texels.diffuse[i] = Load(planes + (3 + i) * stride, count);
    texels.specular[i] = Load(planes + (6 + i) * stride, count);
  }
  texels.roughness = Load(planes + 9 * stride, count);
  return texels;
}

// Radiance from what Shade gives.
template <class T>
GLINT_INLINE VectorOf<T> Radiance(const View<T>& view, const Directions<T>& d, const Shading<T>& s,
                                  int c) {
  const VectorOf<T> lit = s.channels[c].reflected * (d.falloff * view.exposed_light[c]);
  return Fma(s.channels[c].surrounding, Broadcast(view.exposed_ambient[c]), lit);
}

// The adjoint of Radiance: gradients of the texels, and of the view's light and ambient.
template <class T>
GLINT_INLINE void PullBack(const Job<T>& job, const View<T>& view, const Texels<T>& texels,
                           const Directions<T>& d, const Shading<T>& s, const VectorOf<T>* by_image,
                           VectorOf<T>* gradient, VectorOf<T>* sums) {
  VectorOf<T> by_reflected[3], by_surrounding[3];
  for (int c = 0; c < 3; ++c) {
    const VectorOf<T> by_light = by_image[c] * d.falloff;
    sums[2 + c] = Fma(by_light, s.channels[c].reflected, sums[2 + c]);
    sums[5 + c] = Fma(by_image[c], s.channels[c].surrounding, sums[5 + c]);
    by_reflected[c] = by_light * view.exposed_light[c];
    by_surrounding[c] = by_image[c] * view.exposed_ambient[c];
  }
  AddAdjoint<T>(texels, d, s, job.one_minus_specular, job.mix, by_reflected, by_surrounding,
                gradient);
}

// Σ |log(target + offset) − log(rendered + offset)| over channels, and its derivatives by rendered.
template <class T>
struct LogDifference {
  VectorOf<T> value, slope[3];
};

// One logarithm and two divisions for three channels: the sum of |log(x/y)| is the logarithm of
// Π max(x, y) / Π min(x, y), and all 1/y come from 1/Πy.
template <class T>
GLINT_INLINE LogDifference<T> Compare(const Job<T>& job, const VectorOf<T>* rendered,
                                      const VectorOf<T>* target) {
  using V = VectorOf<T>;
  const V zero = V{}, most = Broadcast(T(kMostRadiance));
  const V bound = job.clamp_rendered ? Broadcast(T(1)) : most;
  V wanted[3], shown[3];
  for (int c = 0; c < 3; ++c) {
    shown[c] = Min(Max(rendered[c], zero), bound) + job.log_offset;
    wanted[c] = Min(Max(target[c], zero), most) + job.log_offset;
  }
  V larger = Max(shown[0], wanted[0]), smaller = Min(shown[0], wanted[0]);
  for (int c = 1; c < 3; ++c) {
    larger *= Max(shown[c], wanted[c]);
    smaller *= Min(shown[c], wanted[c]);
  }
  LogDifference<T> difference;
  difference.value = Log(larger / smaller);
  const V first_two = shown[0] * shown[1];
  const V inverse = T(1) / (first_two * shown[2]);
  const V inverse_first_two = inverse * shown[2];
  const V inverses[3] = {inverse_first_two * shown[1], inverse_first_two * shown[0],
                         inverse * first_two};
  for (int c = 0; c < 3; ++c) {
    const V below = shown[c] < wanted[c] ? -inverses[c] : zero;
    const V slope = shown[c] > wanted[c] ? inverses[c] : below;
    // As torch's clamp: the derivative passes at the bounds themselves.
    const V under_bound = rendered[c] > bound ? zero : slope;
    difference.slope[c] = rendered[c] < zero ? zero : under_bound;
  }
  return difference;
}

// Where in a plane a vector of texels starts, and how many texels it holds (≤ kLanes<T>).
struct Place {
  size_t texel;
  int count;
};

// The j-th vector of a chunk of `columns` texels that starts at index `first`.
template <class T>
GLINT_INLINE Place PlaceOf(size_t first, int columns, int j) {
  const int offset = j * kLanes<T>;
  return {first + offset, columns - offset < kLanes<T> ? columns - offset : kLanes<T>};
}

template <class T>
GLINT_INLINE void LoadImage(const Job<T>& job, const T* image, const Place& place,
                            VectorOf<T>* channels) {
  for (int c = 0; c < 3; ++c) {
    channels[c] = Load(image + c * job.image_stride + place.texel, place.count);
  }
}

// Loss of one vector of texels into sums[0] and its weight into sums[1], and ∂loss/∂radiance.
template <bool kTargetMaps, class T>
GLINT_INLINE void CompareVector(const Job<T>& job, const View<T>& view, const Place& place,
                                const Texels<T>& target_texels, const Directions<T>& d,
                                const Shading<T>& s, VectorOf<T>* by_image, VectorOf<T>* sums) {
  using V = VectorOf<T>;
  V weight = Broadcast(T(1));
  if (view.mask != nullptr) {
    weight = Load(view.mask + place.texel, place.count);
  } else if (place.count < kLanes<T>) {
    for (int i = place.count; i < kLanes<T>; ++i) weight[i] = 0;
  }
  V target[3], rendered[3];
  if constexpr (kTargetMaps) {
    const Shading<T> shown = Shade(target_texels, d, job.one_minus_specular, job.mix);
    for (int c = 0; c < 3; ++c) {
      target[c] = Radiance(view, d, shown, c);
      if (job.clamp_rendered) target[c] = Min(target[c], Broadcast(T(1)));
    }
  } else {
    LoadImage(job, view.image, place, target);
    // Nothing is known where the image is not a number; Compare takes that as 0.
    for (int c = 0; c < 3; ++c) weight = target[c] == target[c] ? weight : V{};
  }
  for (int c = 0; c < 3; ++c) rendered[c] = Radiance(view, d, s, c);
  const LogDifference<T> difference = Compare(job, rendered, target);
  sums[0] += difference.value * weight;
  sums[1] += weight;
  for (int c = 0; c < 3; ++c) by_image[c] = difference.slope[c] * weight;
}

// Modes without a gradient, in one view of a chunk that starts at index `first` of the planes.
template <Mode kMode, bool kTargetMaps, class T>
GLINT_INLINE void VisitForward(const Job<T>& job, const View<T>& view, size_t first, int columns,
                               T y_mm, const Chunk<T>& chunk, VectorOf<T>* sums) {
  for (int j = 0; j * kLanes<T> < columns; ++j) {
    const Place place = PlaceOf<T>(first, columns, j);
    const Directions<T> d = Direct(view, job.inverse_square, chunk.x_mm[j], y_mm);
    const Shading<T> s = Shade(chunk.texels[j], d, job.one_minus_specular, job.mix);
    if constexpr (kMode == Mode::kRender) {
      for (int c = 0; c < 3; ++c) {
        Store(view.rendered + c * job.image_stride + place.texel, Radiance(view, d, s, c),
              place.count);
      }
    } else {
      VectorOf<T> unused[3];
      CompareVector<kTargetMaps>(job, view, place, chunk.target[j], d, s, unused, sums);
    }
  }
}

// Modes with a gradient. A pass over all vectors for each step, rather than all steps for each
// vector, lets the processor overlap the long chains of roots and divisions of several vectors, and
// needs fewer registers: faster, though results between the steps go through memory.
template <Mode kMode, bool kTargetMaps, class T>
GLINT_INLINE void VisitWithGradient(const Job<T>& job, const View<T>& view, size_t first,
                                    int columns, T y_mm, Chunk<T>& chunk, VectorOf<T>* sums) {
  const int vectors = (columns + kLanes<T> - 1) / kLanes<T>;
  for (int j = 0; j < vectors; ++j) {
    chunk.directions[j] = Direct(view, job.inverse_square, chunk.x_mm[j], y_mm);
  }
  for (int j = 0; j < vectors; ++j) {
    chunk.shading[j] = Shade(chunk.texels[j], chunk.directions[j], job.one_minus_specular, job.mix);
  }
  for (int j = 0; j < vectors; ++j) {
    const Place place = PlaceOf<T>(first, columns, j);
    if constexpr (kMode == Mode::kAdjoint) {
      LoadImage(job, view.image, place, chunk.by_image[j]);
    } else {
      CompareVector<kTargetMaps>(job, view, place, chunk.target[j], chunk.directions[j],
                                 chunk.shading[j], chunk.by_image[j], sums);
    }
  }
  for (int j = 0; j < vectors; ++j) {
    PullBack<T>(job, view, chunk.texels[j], chunk.directions[j], chunk.shading[j],
                chunk.by_image[j], chunk.gradient[j], sums);
  }
}

template <bool kTargetMaps, class T>
void LoadChunk(const Job<T>& job, size_t first, int column, int columns, Chunk<T>& chunk) {
  for (int j = 0; j * kLanes<T> < columns; ++j) {
    const int offset = j * kLanes<T>, count = columns - offset;
    chunk.texels[j] = LoadTexels(job.planes + first + offset, job.plane_stride, count);
    if constexpr (kTargetMaps) {
      chunk.target[j] = LoadTexels(job.target_planes + first + offset, job.target_stride, count);
    }
    chunk.x_mm[j] = Load(job.x_mm + column + offset, count);
    for (int p = 0; p < kPlanes; ++p) chunk.gradient[j][p] = VectorOf<T>{};
  }
}

template <class T>
void StoreGradient(const Job<T>& job, size_t first, int columns, const Chunk<T>& chunk) {
  for (int j = 0; j * kLanes<T> < columns; ++j) {
    const int offset = j * kLanes<T>;
    for (int p = 0; p < kPlanes; ++p) {
      Store(job.gradient + p * job.gradient_stride + first + offset, chunk.gradient[j][p],
            columns - offset);
    }
  }
}

template <class T>
void FlushSums(VectorOf<T>* vectors, int view_count, ViewSums* sums) {
  for (int v = 0; v < view_count; ++v) {
    for (int i = 0; i < ViewSums::kCount; ++i) {
      VectorOf<T>& vector = vectors[v * ViewSums::kCount + i];
      double sum = 0;
      for (int lane = 0; lane < kLanes<T>; ++lane) sum += static_cast<double>(vector[lane]);
      sums[v].values[i] += sum;
      vector = VectorOf<T>{};
    }
  }
}

// Images lie far apart, and a chunk is too short for the processor to see their pattern by itself.
template <class T>
GLINT_INLINE void Prefetch(const Job<T>& job, const View<T>& view, size_t first, int columns) {
  constexpr int kTexelsPerLine = 64 / sizeof(T);
  for (int i = 0; i < columns; i += kTexelsPerLine) {
    if (view.mask != nullptr) __builtin_prefetch(view.mask + first + i);
    if (view.image == nullptr) continue;
    for (int c = 0; c < 3; ++c) __builtin_prefetch(view.image + c * job.image_stride + first + i);
  }
}

// All views of one chunk. `vector_sums` is [views][kCount].
template <Mode kMode, bool kTargetMaps, class T>
void VisitChunk(const Job<T>& job, int row, int column, int columns, Chunk<T>& chunk,
                VectorOf<T>* vector_sums) {
  constexpr bool kGradient = kMode == Mode::kAdjoint || kMode == Mode::kLossGradient;
  const size_t first = static_cast<size_t>(row) * job.width + column;
  const T y_mm = job.y_mm[row];
  LoadChunk<kTargetMaps>(job, first, column, columns, chunk);
  for (int v = 0; v < job.view_count; ++v) {
    if (v + 1 < job.view_count) Prefetch(job, job.views[v + 1], first, columns);
    VectorOf<T> sums[ViewSums::kCount] = {};
    if constexpr (kGradient) {
      VisitWithGradient<kMode, kTargetMaps>(job, job.views[v], first, columns, y_mm, chunk, sums);
    } else {
      VisitForward<kMode, kTargetMaps>(job, job.views[v], first, columns, y_mm, chunk, sums);
    }
    for (int i = 0; i < ViewSums::kCount; ++i) vector_sums[v * ViewSums::kCount + i] += sums[i];
  }
  if constexpr (kGradient) StoreGradient(job, first, columns, chunk);
}

template <Mode kMode, bool kTargetMaps, class T>
void VisitRows(const Job<T>& job, int row_begin, int row_end, void* scratch, ViewSums* sums) {
  using V = VectorOf<T>;
  constexpr int kTexelsPerFlush = 4096;  // single-precision sums stay short, so stay accurate
  Chunk<T> chunk;
  V* vector_sums = static_cast<V*>(scratch);
  for (int i = 0; i < job.view_count * ViewSums::kCount; ++i) vector_sums[i] = V{};
  int since_flush = 0;
  for (int row = row_begin; row < row_end; ++row) {
    for (int column = 0; column < job.width; column += kChunk) {
      const int columns = job.width - column < kChunk ? job.width - column : kChunk;
      VisitChunk<kMode, kTargetMaps>(job, row, column, columns, chunk, vector_sums);
      since_flush += columns;
      if (since_flush >= kTexelsPerFlush) {
        FlushSums<T>(vector_sums, job.view_count, sums);
        since_flush = 0;
      }
    }
  }
  FlushSums<T>(vector_sums, job.view_count, sums);
}

template <class T>
void RunRowsHere(const Job<T>& job, Mode mode, int row_begin, int row_end, void* scratch,
                 ViewSums* sums) {
  const bool target_maps = job.target_planes != nullptr;
  switch (mode) {
    case Mode::kRender:
      return VisitRows<Mode::kRender, false>(job, row_begin, row_end, scratch, sums);
    case Mode::kAdjoint:
      return VisitRows<Mode::kAdjoint, false>(job, row_begin, row_end, scratch, sums);
    case Mode::kLoss:
      return target_maps ? VisitRows<Mode::kLoss, true>(job, row_begin, row_end, scratch, sums)
                         : VisitRows<Mode::kLoss, false>(job, row_begin, row_end, scratch, sums);
    case Mode::kLossGradient:
      return target_maps
                 ? VisitRows<Mode::kLossGradient, true>(job, row_begin, row_end, scratch, sums)
                 : VisitRows<Mode::kLossGradient, false>(job, row_begin, row_end, scratch, sums);
  }
}

}  // namespace

RunRowsFunction<float> GLINT_KERNEL_NAME(Float)() { return &RunRowsHere<float>; }
RunRowsFunction<double> GLINT_KERNEL_NAME(Double)() { return &RunRowsHere<double>; }

}  // namespace glint::kernel
