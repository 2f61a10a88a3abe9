// The fused kernel. Included by kernel_<set>.cc, each compiled for its instruction set, after it
// has defined GLINT_VECTOR_BYTES and GLINT_KERNEL_NAME.
//
// Loop order: rows, chunks of kChunk columns, views, vectors. A chunk's texels and gradients stay
// in the first-level cache while all views pass over them; images are read once, in order.

#if GLINT_VECTOR_BYTES > 16
#include <immintrin.h>
#endif

#include "fitting/reflectance/brdf_constants.h"
#include "fitting/render/kernel.h"

namespace glint::kernel {
namespace {

#include "fitting/render/kernel_vector.inl"

#include "fitting/render/kernel_shade.inl"

template <bool kFull, class T>
GLINT_INLINE Texels<T> LoadTexels(const T* planes, size_t stride, int count) {
  Texels<T> texels;
  for (int i = 0; i < 3; ++i) {
    texels.normal[i] = Load<kFull>(planes + i * stride, count);
    texels.diffuse[i] = Load<kFull>(planes + (3 + i) * stride, count);
    texels.specular[i] = Load<kFull>(planes + (6 + i) * stride, count);
  }
  texels.roughness = Load<kFull>(planes + 9 * stride, count);
  return texels;
}

// One vector of texels in one view.
template <class T>
struct Place {
  size_t texel;  // index of the first in a plane
  int count;     // of texels, ≤ kLanes<T>
  VectorOf<T> x_mm;
  T y_mm;
};

// Radiance from what Shade gives: exposure·(light_rgb·falloff·(…) + ambient·lobe/π).
template <class T>
GLINT_INLINE VectorOf<T> Radiance(const View<T>& view, const Directions<T>& d, const Shading<T>& s,
                                  int c) {
  const VectorOf<T> lit = d.falloff * s.radiance[c] * view.light_rgb[c];
  return Fma(s.lobe[c], Broadcast(view.ambient_over_pi[c]), lit) * view.exposure;
}

// The adjoint of Radiance: gradients of the texels, and of the view's light and ambient.
template <class T>
GLINT_INLINE void PullBack(const Job<T>& job, const View<T>& view, const Texels<T>& texels,
                           const Directions<T>& d, const Shading<T>& s, const VectorOf<T>* by_image,
                           VectorOf<T>* gradient, VectorOf<T>* sums) {
  VectorOf<T> by_radiance[3], by_ambient_lobe[3];
  for (int c = 0; c < 3; ++c) {
    const VectorOf<T> exposed = by_image[c] * view.exposure;
    const VectorOf<T> by_power = exposed * d.falloff;
    sums[2 + c] = Fma(by_power, s.radiance[c], sums[2 + c]);
    sums[5 + c] = Fma(exposed, s.lobe[c] * T(kInversePi), sums[5 + c]);
    by_radiance[c] = by_power * view.light_rgb[c];
    by_ambient_lobe[c] = exposed * (view.ambient_over_pi[c] * T(1 / kInversePi));
  }
  AddAdjoint<T>(texels, d, s, job.one_minus_specular, by_radiance, by_ambient_lobe, gradient);
}

// |log(target + offset) − log(rendered + offset)| of one channel, and its derivative by rendered.
template <class T>
struct LogDifference {
  VectorOf<T> value, slope;
};

template <class T>
GLINT_INLINE LogDifference<T> Compare(const Job<T>& job, const VectorOf<T>& rendered,
                                      const VectorOf<T>& target) {
  using V = VectorOf<T>;
  const V zero = V{};
  // Without a clamp the bound is beyond any radiance.
  const V bound = Broadcast(job.clamp_rendered ? T(1) : T(3e38));
  const V shown = Min(Max(rendered, zero), bound);
  const V inverse = T(1) / (shown + job.log_offset);
  const V log = Log((Max(target, zero) + job.log_offset) * inverse);
  LogDifference<T> difference;
  difference.value = Abs(log);
  const V slope = log > zero ? -inverse : (log < zero ? inverse : zero);
  // As torch's clamp: the derivative passes at the bounds themselves.
  difference.slope = rendered > bound ? zero : (rendered < zero ? zero : slope);
  return difference;
}

template <Mode kMode, bool kTargetMaps, bool kFull, class T>
GLINT_INLINE void Visit(const Job<T>& job, const View<T>& view, const Place<T>& place,
                        VectorOf<T>* gradient, VectorOf<T>* sums) {
  using V = VectorOf<T>;
  const V zero = V{};
  const Texels<T> texels =
      LoadTexels<kFull>(job.planes + place.texel, job.plane_stride, place.count);
  const Directions<T> d = Direct(view, job.inverse_square, place.x_mm, place.y_mm);
  const Shading<T> s = Shade(texels, d, job.one_minus_specular);
  V by_image[3];
  if constexpr (kMode == Mode::kRender) {
    for (int c = 0; c < 3; ++c) {
      Store<kFull>(view.rendered + c * job.image_stride + place.texel, Radiance(view, d, s, c),
                   place.count);
    }
    return;
  } else if constexpr (kMode == Mode::kAdjoint) {
    for (int c = 0; c < 3; ++c) {
      by_image[c] = Load<kFull>(view.image + c * job.image_stride + place.texel, place.count);
    }
  } else {
    V weight = Broadcast(T(1));
    if (view.mask != nullptr) {
      weight = Load<kFull>(view.mask + place.texel, place.count);
    } else if constexpr (!kFull) {
      for (int i = place.count; i < kLanes<T>; ++i) weight[i] = 0;
    }
    V target[3];
    if constexpr (kTargetMaps) {
      const Texels<T> other =
          LoadTexels<kFull>(job.target_planes + place.texel, job.target_stride, place.count);
      const Shading<T> shown = Shade(other, d, job.one_minus_specular);
      for (int c = 0; c < 3; ++c) {
        const V radiance = Radiance(view, d, shown, c);
        target[c] = job.clamp_rendered ? Min(radiance, Broadcast(T(1))) : radiance;
      }
    } else {
      for (int c = 0; c < 3; ++c) {
        target[c] = Load<kFull>(view.image + c * job.image_stride + place.texel, place.count);
      }
    }
    V loss = zero;
    for (int c = 0; c < 3; ++c) {
      const LogDifference<T> difference = Compare(job, Radiance(view, d, s, c), target[c]);
      loss += difference.value;
      by_image[c] = weight > zero ? difference.slope * weight : zero;
    }
    sums[0] += weight > zero ? loss * weight : zero;  // a choice, as the image may hold NaN there
    sums[1] += weight;
  }
  if constexpr (kMode == Mode::kAdjoint || kMode == Mode::kLossGradient) {
    PullBack<T>(job, view, texels, d, s, by_image, gradient, sums);
  }
}

// Views of one chunk of a row. `gradient` is [kPlanes][kChunk / kLanes], `sums` [views][kCount].
template <Mode kMode, bool kTargetMaps, class T>
void VisitChunk(const Job<T>& job, int row, int column, int columns, VectorOf<T>* gradient,
                VectorOf<T>* sums) {
  constexpr int kVectors = kChunk / kLanes<T>;
  const size_t first = static_cast<size_t>(row) * job.width + column;
  for (int v = 0; v < job.view_count; ++v) {
    VectorOf<T> local[ViewSums::kCount] = {};
    for (int j = 0; j * kLanes<T> < columns; ++j) {
      const int offset = j * kLanes<T>;
      VectorOf<T> adjoint[kPlanes] = {};
      Place<T> place{first + offset, columns - offset, {}, job.y_mm[row]};
      if (place.count >= kLanes<T>) {
        place.x_mm = Load<true>(job.x_mm + column + offset, place.count);
        Visit<kMode, kTargetMaps, true>(job, job.views[v], place, adjoint, local);
      } else {
        place.x_mm = Load<false>(job.x_mm + column + offset, place.count);
        Visit<kMode, kTargetMaps, false>(job, job.views[v], place, adjoint, local);
      }
      if constexpr (kMode == Mode::kAdjoint || kMode == Mode::kLossGradient) {
        for (int p = 0; p < kPlanes; ++p) gradient[p * kVectors + j] += adjoint[p];
      }
    }
    for (int i = 0; i < ViewSums::kCount; ++i) sums[v * ViewSums::kCount + i] += local[i];
  }
}

template <class T>
void StoreGradient(const Job<T>& job, int row, int column, int columns,
                   const VectorOf<T>* gradient) {
  const size_t first = static_cast<size_t>(row) * job.width + column;
  for (int p = 0; p < kPlanes; ++p) {
    __builtin_memcpy(job.gradient + p * job.gradient_stride + first,
                     gradient + p * (kChunk / kLanes<T>), columns * sizeof(T));
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

template <Mode kMode, bool kTargetMaps, class T>
void VisitRows(const Job<T>& job, int row_begin, int row_end, void* scratch, ViewSums* sums) {
  using V = VectorOf<T>;
  constexpr bool kGradient = kMode == Mode::kAdjoint || kMode == Mode::kLossGradient;
  constexpr int kTexelsPerFlush = 4096;  // single-precision sums stay short, so stay accurate
  V* gradient = static_cast<V*>(scratch);
  V* vector_sums = gradient + kPlanes * (kChunk / kLanes<T>);
  for (int i = 0; i < job.view_count * ViewSums::kCount; ++i) vector_sums[i] = V{};
  int since_flush = 0;
  for (int row = row_begin; row < row_end; ++row) {
    for (int column = 0; column < job.width; column += kChunk) {
      const int columns = job.width - column < kChunk ? job.width - column : kChunk;
      if constexpr (kGradient) {
        for (int i = 0; i < kPlanes * (kChunk / kLanes<T>); ++i) gradient[i] = V{};
      }
      VisitChunk<kMode, kTargetMaps>(job, row, column, columns, gradient, vector_sums);
      if constexpr (kGradient) StoreGradient(job, row, column, columns, gradient);
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
