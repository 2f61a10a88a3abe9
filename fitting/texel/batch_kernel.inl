// The functions of batch_kernel.h. Included by batch_kernel_<set>.cc, each compiled for its
// instruction set, after it has defined GLINT_VECTOR_BYTES and GLINT_KERNEL_NAME. Calls nothing
// that the linker could take from code compiled for another set (base/cpu/vectors.inl).
//
// A batch is worked on vector by vector: the lanes of one that have converged wait for the others.

#if GLINT_VECTOR_BYTES > 16
#include <immintrin.h>
#endif

#include "base/model/solver.h"
#include "base/reflectance/brdf_core.h"
#include "base/reflectance/characteristic_curve.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/texel/batch_kernel.h"
#include "fitting/texel/texel_bounds.h"

namespace glint::kernel {
namespace {

#include "base/cpu/vectors.inl"

}  // namespace
}  // namespace glint::kernel

#include "base/reflectance/brdf_vectors.inl"

namespace glint::kernel {
namespace {

typedef BatchObservations Obs;

// The lanes of one vector, the first of which is `first`.
GLINT_INLINE Floats At(const BatchRow& row, int first) {
  Floats v;
  __builtin_memcpy(&v, row.lane + first, sizeof v);
  return v;
}

GLINT_INLINE void Put(const Floats& v, int first, BatchRow* row) {
  __builtin_memcpy(row->lane + first, &v, sizeof v);
}

GLINT_INLINE Floats Where(const Ints& mask, const Floats& a, const Floats& b) {
  return mask ? a : b;
}

GLINT_INLINE Ints MaskOf(LaneBits bits, int first) {
  Ints mask;
  for (int i = 0; i < kLanes<float>; ++i) mask[i] = (bits >> (first + i)) & 1 ? -1 : 0;
  return mask;
}

GLINT_INLINE LaneBits BitsOf(const Ints& mask, int first) {
  LaneBits bits = 0;
  for (int i = 0; i < kLanes<float>; ++i) bits |= mask[i] ? 1u << (first + i) : 0u;
  return bits;
}

// How many lanes are on.
GLINT_INLINE int Count(const Ints& mask) {
#if GLINT_VECTOR_BYTES == 64
  return __builtin_popcount(_mm512_test_epi32_mask((__m512i)mask, (__m512i)mask));
#elif GLINT_VECTOR_BYTES == 32
  return __builtin_popcount(unsigned(_mm256_movemask_ps((__m256)mask)));
#else
  int count = 0;
  for (int i = 0; i < kLanes<float>; ++i) count -= mask[i];
  return count;
#endif
}

GLINT_INLINE bool Any(const Ints& mask) { return Count(mask) != 0; }

struct VectorValues {
  Floats of[kTexelParameters];
};

GLINT_INLINE VectorValues LoadValues(const BatchValues& values, int first) {
  VectorValues v;
  for (int i = 0; i < kTexelParameters; ++i) v.of[i] = At(values.of[i], first);
  return v;
}

// The normal of slopes and its derivatives by them.
struct Tilt {
  Floats n[3];
  Floats by_x[3], by_y[3];
};

GLINT_INLINE Tilt TiltOf(const Floats& slope_x, const Floats& slope_y) {
  Tilt t;
  const Floats length = 1.0f / Sqrt(Fma(slope_x, slope_x, Fma(slope_y, slope_y, Broadcast(1.0f))));
  t.n[0] = slope_x * length;
  t.n[1] = slope_y * length;
  t.n[2] = length;
  // ∂n/∂slope = length·(axis − n·n_axis)
  t.by_x[0] = length * (1.0f - t.n[0] * t.n[0]);
  t.by_x[1] = t.by_y[0] = -length * t.n[0] * t.n[1];
  t.by_x[2] = -length * t.n[0] * t.n[2];
  t.by_y[1] = length * (1.0f - t.n[1] * t.n[1]);
  t.by_y[2] = -length * t.n[1] * t.n[2];
  return t;
}

GLINT_INLINE Floats Dot3(const Floats* a, const Floats* b) {
  return Fma(a[2], b[2], Fma(a[1], b[1], a[0] * b[0]));
}

// n·l, S and C·F_c of brdf_core.h and their derivatives by slope_x, slope_y and roughness.
enum Lobe {
  kNormalLight,
  kByXNormalLight,
  kByYNormalLight,
  kLobe,
  kByXLobe,
  kByYLobe,
  kByRLobe,
  kCoat,
  kByXCoat,
  kByYCoat,
  kByRCoat
};
static_assert(kByRCoat + 1 == BatchViews::kScratchRows);

// Of a view: what its lobes' derivatives by a texel need.
struct InView {
  const Tilt& tilt;
  const LobeShape<float>& shape;
  Floats half_inverse;
  Floats n_dot_l[2], n_dot_v[2];  // derivatives by slope_x and slope_y
};

// Derivatives by slope_x, slope_y and roughness of what has the slopes `by`.
struct ByTexel {
  Floats x, y, r;
};
GLINT_INLINE ByTexel Chained(const SpecularSlopes<Floats>& by, const InView& view) {
  const Floats by_half = by.by_n_dot_h * view.half_inverse;
  const Floats by_light = by.by_n_dot_l + by_half, by_camera = by.by_n_dot_v + by_half;
  ByTexel chained = {Fma(by_light, view.n_dot_l[0], by_camera * view.n_dot_v[0]),
                     Fma(by_light, view.n_dot_l[1], by_camera * view.n_dot_v[1]), by.by_roughness};
  if (view.shape.anisotropic) {
    const float* g = view.shape.direction;
    const Tilt& tilt = view.tilt;
    chained.x = Fma(by.by_n_dot_g, tilt.by_x[0] * g[0] + tilt.by_x[1] * g[1], chained.x);
    chained.y = Fma(by.by_n_dot_g, tilt.by_y[0] * g[0] + tilt.by_y[1] * g[1], chained.y);
  }
  return chained;
}

// Of every view into the scratch memory, as vectors.
template <bool kSlopes>
GLINT_INLINE Floats* EvaluateLobes(const KernelOptions& options, const BatchViews& views,
                                   const VectorValues& x, int first) {
  const Tilt tilt = TiltOf(x.of[kSlopeX], x.of[kSlopeY]);
  const Floats roughness = x.of[kRough];
  Floats* lobes = reinterpret_cast<Floats*>(views.scratch);
  for (int v = 0; v < views.count; ++v) {
    const BatchRow* rows = views.rows + v * Obs::kPlanes;
    Floats light[3], camera[3], sum[3];
    for (int i = 0; i < 3; ++i) {
      light[i] = At(rows[Obs::kLightX + i], first);
      camera[i] = At(rows[Obs::kCameraX + i], first);
      sum[i] = light[i] + camera[i];
    }
    const Floats half_inverse = At(rows[Obs::kHalfInverse], first);
    Cosines<Floats> cosines;
    cosines.n_dot_l = Dot3(tilt.n, light);
    cosines.n_dot_v = Dot3(tilt.n, camera);
    cosines.n_dot_h = (cosines.n_dot_l + cosines.n_dot_v) * half_inverse;
    const Floats scale = cosines.n_dot_h * half_inverse;
    Floats across[3];
    for (int i = 0; i < 3; ++i) across[i] = Fma(-scale, sum[i], tilt.n[i]);
    cosines.sine_squared = Dot3(across, across);
    if (options.mix.shape.anisotropic) {
      const float* g = options.mix.shape.direction;
      cosines.n_dot_g = Fma(tilt.n[1], Broadcast(g[1]), tilt.n[0] * g[0]);
      cosines.h_dot_g = half_inverse * Fma(sum[1], Broadcast(g[1]), sum[0] * g[0]);
    }
    const MixTerms<Floats> lobe = EvaluateMix(cosines, roughness, options.mix);
    Floats* out = lobes + v * BatchViews::kScratchRows;
    out[kNormalLight] = lobe.n_dot_l;
    out[kLobe] = lobe.value;
    const Floats fresnel = At(rows[Obs::kFresnel], first);
    out[kCoat] = EvaluateCoat(lobe.coat, fresnel, options.mix).reflected;
    if constexpr (kSlopes) {
      const InView in = {tilt,
                         options.mix.shape,
                         half_inverse,
                         {Dot3(tilt.by_x, light), Dot3(tilt.by_y, light)},
                         {Dot3(tilt.by_x, camera), Dot3(tilt.by_y, camera)}};
      const Ints lit = cosines.n_dot_l > float(kDotClamp);
      out[kByXNormalLight] = Where(lit, in.n_dot_l[0], Floats{});
      out[kByYNormalLight] = Where(lit, in.n_dot_l[1], Floats{});
      const ByTexel by = Chained(DifferentiateMix(lobe, roughness, options.mix), in);
      out[kByXLobe] = by.x;
      out[kByYLobe] = by.y;
      out[kByRLobe] = by.r;
      if (options.mix.coat()) {
        const Floats weight = Fresnel(Broadcast(options.mix.coat_f0), fresnel);
        const ByTexel coat = Chained(DifferentiateCoat(lobe, roughness, options.mix, weight), in);
        out[kByXCoat] = coat.x;
        out[kByYCoat] = coat.y;
        out[kByRCoat] = coat.r;
      }
    }
  }
  return lobes;
}

// What a coat adds in a view.
GLINT_INLINE Coat<Floats> CoatIn(const Floats* lobe, const LobeMix<float>& mix) {
  if (!mix.coat()) return {};
  return {lobe[kCoat], Broadcast(mix.share[1] * mix.coat_f0 * float(kInversePi)), mix.mapped()};
}

// I + 0.01 of a rendered radiance as photographs record it, and what its derivatives are divided by
// to be those of the logarithm: a curve leaves a thousandth of them at least. Below 0, where the
// harmonics of environment lighting may reach, there is no curve.
struct Photographed {
  Floats value, divisor;
};
GLINT_INLINE Photographed PhotographedAs(const Floats& radiance, const CharacteristicCurve& curve) {
  const RecordedRadiance<Floats> seen = Recorded(radiance, float(curve.toe), float(curve.shoulder));
  const Ints lit = radiance > 0.0f;
  const Floats value = Where(lit, seen.value, radiance) + float(kLogOffset);
  const Floats slope = Where(lit, Max(seen.slope, Broadcast(1e-3f)), Broadcast(1.0f));
  return {value, value / slope};
}

// The normal equations: BatchGram's products, of one vector.
struct Normal {
  Floats own[3][BatchGram::kOwn];
  Floats shared[BatchGram::kShared];
  Floats squares() const { return shared[BatchGram::kShared - 1]; }
};
// Where they stand. Own: diffuse with (diffuse, specular, roughness, slopes, residual), then
// specular with the others.
enum Own { kDD, kDS, kDR, kDX, kDY, kDF, kSS, kSR, kSX, kSY, kSF };
enum Shared { kRR, kRX, kRY, kRF, kXX, kXY, kXF, kYY, kYF, kFF };

// Residuals are g of batch_kernel.h, but only their products are formed, which need no root of
// 2/(1 + root): with e_x = ∂e/∂x,  g'² = (1 + root)/(2·root²),  g·g' = e/root,  g² = 2e²/(1 +
// root).
template <bool kRows>
GLINT_INLINE Normal EvaluateProducts(const KernelOptions& options, const BatchViews& views,
                                     const VectorValues& x, int first, BatchRow* residuals) {
  const Floats* lobes = EvaluateLobes<true>(options, views, x, first);
  const bool one_minus_specular = options.diffuse_weight == DiffuseWeight::kOneMinusSpecular;
  const float inverse_scale = 1.0f / float(options.robust_scale);
  Normal sums;
  for (Floats& sum : sums.shared) sum = Floats{};
  for (int c = 0; c < 3; ++c) {
    const Floats specular = x.of[kAlbedos + 2 * c + 1];
    const DiffuseTerms<Floats> diffuse =
        EvaluateDiffuse(x.of[kAlbedos + 2 * c], specular, one_minus_specular);
    Floats* own = sums.own[c];
    for (int i = 0; i < BatchGram::kOwn; ++i) own[i] = Floats{};
    for (int v = 0; v < views.count; ++v) {
      const BatchRow* rows = views.rows + v * Obs::kPlanes;
      const Floats* lobe = lobes + v * BatchViews::kScratchRows;
      const Floats fresnel = At(rows[Obs::kFresnel], first);
      const Floats irradiance = At(rows[Obs::kIrradiance + c], first);
      const Floats ambient = At(rows[Obs::kAmbient + c], first);
      const Floats ambient_specular = At(rows[Obs::kAmbientSpecular + c], first);
      const Coat<Floats> coat = CoatIn(lobe, options.mix);
      const ChannelTerms<Floats> terms =
          EvaluateChannel(diffuse, specular, fresnel, lobe[kNormalLight], lobe[kLobe], coat);
      Floats mirrored = ambient_specular * specular * float(kInversePi);
      if (options.mix.coat()) {
        mirrored = Fma(mirrored, Broadcast(coat.mapped), ambient_specular * coat.surrounding);
      }
      const Floats surroundings = Fma(ambient, diffuse.value, mirrored);
      const Floats radiance = Fma(irradiance, terms.reflected, surroundings);
      Photographed seen = {radiance + float(kLogOffset), radiance + float(kLogOffset)};
      if (!options.curve.straight()) seen = PhotographedAs(radiance, options.curve);

      const Floats free = Log(seen.value) - At(rows[Obs::kLogTarget + c], first);
      const Floats ceiling = At(rows[Obs::kCeiling + c], first);
      const Floats error = Min(free, ceiling);
      const Floats weight = At(rows[Obs::kWeight], first);
      const Floats on = Where(free < ceiling, weight, Floats{});
      const Floats scaled = error * inverse_scale;
      const Floats root = Sqrt(Fma(scaled, scaled, Broadcast(1.0f)));
      const Floats above = 1.0f + root, below = root * seen.divisor;
      const Floats inverse = 1.0f / (below * above);
      const Floats inverse_below = inverse * above;
      const Floats by_error = error * inverse_below * on;
      const Floats by_both = 0.5f * above * inverse_below * inverse_below * on;
      const Floats squares = weight * error * error * 2.0f * inverse * below;

      const ChannelSlopes<Floats> by =
          DifferentiateChannel(diffuse, terms, fresnel, lobe[kNormalLight], lobe[kLobe], irradiance,
                               ambient, ambient_specular, coat.mapped);
      const Floats d = by.by_diffuse, s = by.by_specular;
      Floats r = by.by_lobe * lobe[kByRLobe];
      Floats px = Fma(by.by_n_dot_l, lobe[kByXNormalLight], by.by_lobe * lobe[kByXLobe]);
      Floats py = Fma(by.by_n_dot_l, lobe[kByYNormalLight], by.by_lobe * lobe[kByYLobe]);
      if (options.mix.coat()) {
        r = Fma(irradiance, lobe[kByRCoat], r);
        px = Fma(irradiance, lobe[kByXCoat], px);
        py = Fma(irradiance, lobe[kByYCoat], py);
      }
      if constexpr (kRows) {
        const Floats slope = Sqrt(by_both);
        const Floats all[BatchResiduals::kRows] = {
            slope * d,  slope * s,  slope * r,
            slope * px, slope * py, Where(by_both > 0.0f, by_error / slope, Floats{}),
            error};
        BatchRow* row = residuals + (3 * v + c) * BatchResiduals::kRows;
        for (int i = 0; i < BatchResiduals::kRows; ++i) Put(all[i], first, row + i);
      }
      const Floats wd = by_both * d, ws = by_both * s, wr = by_both * r, wx = by_both * px;
      own[kDD] = Fma(wd, d, own[kDD]);
      own[kDS] = Fma(wd, s, own[kDS]);
      own[kDR] = Fma(wd, r, own[kDR]);
      own[kDX] = Fma(wd, px, own[kDX]);
      own[kDY] = Fma(wd, py, own[kDY]);
      own[kDF] = Fma(by_error, d, own[kDF]);
      own[kSS] = Fma(ws, s, own[kSS]);
      own[kSR] = Fma(ws, r, own[kSR]);
      own[kSX] = Fma(ws, px, own[kSX]);
      own[kSY] = Fma(ws, py, own[kSY]);
      own[kSF] = Fma(by_error, s, own[kSF]);
      sums.shared[kRR] = Fma(wr, r, sums.shared[kRR]);
      sums.shared[kRX] = Fma(wr, px, sums.shared[kRX]);
      sums.shared[kRY] = Fma(wr, py, sums.shared[kRY]);
      sums.shared[kRF] = Fma(by_error, r, sums.shared[kRF]);
      sums.shared[kXX] = Fma(wx, px, sums.shared[kXX]);
      sums.shared[kXY] = Fma(wx, py, sums.shared[kXY]);
      sums.shared[kXF] = Fma(by_error, px, sums.shared[kXF]);
      sums.shared[kYY] = Fma(by_both * py, py, sums.shared[kYY]);
      sums.shared[kYF] = Fma(by_error, py, sums.shared[kYF]);
      sums.shared[kFF] += squares;
    }
  }
  return sums;
}

// The variables of texel_parameters.h, and the values they stand for with their derivatives.
GLINT_INLINE Floats ExpOfNegative(const Floats& x) {
  return Exp2OfNegative(x * float(1.4426950408889634));
}

GLINT_INLINE Floats BoundedValue(const ValueBounds& bounds, const Floats& u, Floats* derivative) {
  const float low = float(bounds.low), high = float(bounds.high), tail = float(bounds.tail);
  const Floats below = (low + tail) - u, above = u - (high - tail);
  const Floats depth =
      Min(Max(Max(below, above), Floats{}) * (1.0f / tail), Broadcast(float(kFarthestTail)));
  *derivative = ExpOfNegative(-depth);
  const Floats at_high = Where(above > 0.0f, high - tail * *derivative, u);
  return Where(below > 0.0f, low + tail * *derivative, at_high);
}

GLINT_INLINE Floats UnboundedVariable(const ValueBounds& bounds, const Floats& value) {
  const float low = float(bounds.low), high = float(bounds.high), tail = float(bounds.tail);
  const float nearest = float(kNearestToBound) * tail;
  const Floats x = Min(Max(value, Broadcast(low + nearest)), Broadcast(high - nearest));
  const Floats above = Log(Max((x - low) * (1.0f / tail), Broadcast(1e-6f)));
  const Floats below = Log(Max((high - x) * (1.0f / tail), Broadcast(1e-6f)));
  const Floats at_high = Where(x > high - tail, high - tail * (1.0f + below), x);
  return Where(x < low + tail, low + tail * (1.0f + above), at_high);
}

struct Moved {
  VectorValues values, derivatives;
};

GLINT_INLINE Moved ValuesOf(const VectorValues& variables) {
  Moved moved;
  for (int i = 0; i < kSlopeX; ++i) {
    moved.values.of[i] = BoundedValue(i == kRough ? kRoughnessBounds : kAlbedoBounds,
                                      variables.of[i], &moved.derivatives.of[i]);
  }
  for (int i = kSlopeX; i < kTexelParameters; ++i) {
    moved.values.of[i] = variables.of[i];
    moved.derivatives.of[i] = Broadcast(1.0f);
  }
  return moved;
}

GLINT_INLINE VectorValues VariablesOf(const VectorValues& values) {
  VectorValues variables = values;
  for (int i = 0; i < kSlopeX; ++i) {
    variables.of[i] =
        UnboundedVariable(i == kRough ? kRoughnessBounds : kAlbedoBounds, values.of[i]);
  }
  return variables;
}

// TexelPrior::AddTo.
GLINT_INLINE void AddPrior(const BatchPrior& prior, const VectorValues& x, int first,
                           Normal* normal) {
  Floats squares = normal->squares();
  const auto departure = [&](int i, const Floats& value) {
    return At(prior.weight.of[i], first) * (value - At(prior.mean.of[i], first));
  };
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 2; ++k) {
      const int i = kAlbedos + 2 * c + k;
      const Floats weight = At(prior.weight.of[i], first), f = departure(i, x.of[i]);
      Floats* own = normal->own[c];
      own[k == 0 ? kDD : kSS] += weight * weight;
      own[k == 0 ? kDF : kSF] += weight * f;
      squares += f * f;
    }
  }
  const Floats weight = At(prior.weight.of[kRough], first), f = departure(kRough, x.of[kRough]);
  Floats* shared = normal->shared;
  shared[kRR] += weight * weight;
  shared[kRF] += weight * f;
  squares += f * f;
  const Tilt tilt = TiltOf(x.of[kSlopeX], x.of[kSlopeY]);
  for (int axis = 0; axis < 2; ++axis) {
    const Floats w = At(prior.weight.of[kSlopeX + axis], first);
    const Floats g = departure(kSlopeX + axis, tilt.n[axis]);
    const Floats by_x = w * tilt.by_x[axis], by_y = w * tilt.by_y[axis];
    shared[kXX] += by_x * by_x;
    shared[kXY] += by_x * by_y;
    shared[kYY] += by_y * by_y;
    shared[kXF] += by_x * g;
    shared[kYF] += by_y * g;
    squares += g * g;
  }
  shared[kFF] = squares;
}

// To derivatives by the variables.
GLINT_INLINE void ChainByVariables(const VectorValues& by, Normal* normal) {
  const Floats r = by.of[kRough];
  for (int c = 0; c < 3; ++c) {
    const Floats d = by.of[kAlbedos + 2 * c], s = by.of[kAlbedos + 2 * c + 1];
    Floats* own = normal->own[c];
    own[kDD] *= d * d;
    own[kDS] *= d * s;
    own[kDR] *= d * r;
    for (const int i : {kDX, kDY, kDF}) own[i] *= d;
    own[kSS] *= s * s;
    own[kSR] *= s * r;
    for (const int i : {kSX, kSY, kSF}) own[i] *= s;
  }
  normal->shared[kRR] *= r * r;
  for (const int i : {kRX, kRY, kRF}) normal->shared[i] *= r;
}

GLINT_INLINE Floats DiagonalOf(const Normal& normal, int i) {
  if (i < kRough) return normal.own[i / 2][i % 2 == 0 ? kDD : kSS];
  return normal.shared[i == kRough ? kRR : i == kSlopeX ? kXX : kYY];
}

GLINT_INLINE Floats GradientOf(const Normal& normal, int i) {
  if (i < kRough) return normal.own[i / 2][i % 2 == 0 ? kDF : kSF];
  return normal.shared[i == kRough ? kRF : i == kSlopeX ? kXF : kYF];
}

// The factor of N + diag(added): channels' albedos have nothing in common, so that each pair is
// eliminated on its own. Where a pivot is lost to rounding solutions are wrong or not numbers:
// judge them.
struct Factor {
  struct Pair {  // a channel's rows; its specular one after the diffuse one was eliminated
    Floats ds, dr, dx, dy, sr, sx, sy, inverse_d, inverse_s;
  } pairs[3];
  Floats rx, ry, xy, inverse_r, inverse_x, inverse_y;

  GLINT_INLINE Factor(const Normal& normal, const VectorValues& added) {
    const Floats* shared = normal.shared;
    Floats rr = shared[kRR] + added.of[kRough];
    Floats xx = shared[kXX] + added.of[kSlopeX], yy = shared[kYY] + added.of[kSlopeY];
    rx = shared[kRX];
    ry = shared[kRY];
    xy = shared[kXY];
    for (int c = 0; c < 3; ++c) {
      const Floats* own = normal.own[c];
      Pair& p = pairs[c];
      p.inverse_d = 1.0f / (own[kDD] + added.of[kAlbedos + 2 * c]);
      p.ds = own[kDS];
      p.dr = own[kDR];
      p.dx = own[kDX];
      p.dy = own[kDY];
      const Floats l = p.ds * p.inverse_d;
      p.inverse_s = 1.0f / (own[kSS] + added.of[kAlbedos + 2 * c + 1] - l * p.ds);
      p.sr = own[kSR] - l * p.dr;
      p.sx = own[kSX] - l * p.dx;
      p.sy = own[kSY] - l * p.dy;
      const Floats dr = p.dr * p.inverse_d, dx = p.dx * p.inverse_d, dy = p.dy * p.inverse_d;
      const Floats sr = p.sr * p.inverse_s, sx = p.sx * p.inverse_s, sy = p.sy * p.inverse_s;
      rr -= dr * p.dr + sr * p.sr;
      rx -= dr * p.dx + sr * p.sx;
      ry -= dr * p.dy + sr * p.sy;
      xx -= dx * p.dx + sx * p.sx;
      xy -= dx * p.dy + sx * p.sy;
      yy -= dy * p.dy + sy * p.sy;
    }
    inverse_r = 1.0f / rr;
    xx -= rx * inverse_r * rx;
    xy -= rx * inverse_r * ry;
    yy -= ry * inverse_r * ry;
    inverse_x = 1.0f / xx;
    inverse_y = 1.0f / (yy - xy * inverse_x * xy);
  }

  GLINT_INLINE VectorValues Solve(const VectorValues& right) const {
    Floats r = right.of[kRough], x = right.of[kSlopeX], y = right.of[kSlopeY];
    Floats specular[3];
    for (int c = 0; c < 3; ++c) {
      const Pair& p = pairs[c];
      const Floats d = right.of[kAlbedos + 2 * c] * p.inverse_d;
      specular[c] = (right.of[kAlbedos + 2 * c + 1] - p.ds * d) * p.inverse_s;
      r -= p.dr * d + p.sr * specular[c];
      x -= p.dx * d + p.sx * specular[c];
      y -= p.dy * d + p.sy * specular[c];
    }
    r *= inverse_r;
    x = (x - rx * r) * inverse_x;
    y = (y - ry * r - xy * x) * inverse_y;
    x -= xy * inverse_x * y;
    r -= (rx * x + ry * y) * inverse_r;
    VectorValues solution;
    for (int c = 0; c < 3; ++c) {
      const Pair& p = pairs[c];
      const Floats s = specular[c] - (p.sr * r + p.sx * x + p.sy * y) * p.inverse_s;
      solution.of[kAlbedos + 2 * c + 1] = s;
      solution.of[kAlbedos + 2 * c] =
          (right.of[kAlbedos + 2 * c] - p.ds * s - p.dr * r - p.dx * x - p.dy * y) * p.inverse_d;
    }
    solution.of[kRough] = r;
    solution.of[kSlopeX] = x;
    solution.of[kSlopeY] = y;
    return solution;
  }
};

GLINT_INLINE void Select(const Ints& where, const Normal& from, Normal* to) {
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < BatchGram::kOwn; ++i) {
      to->own[c][i] = Where(where, from.own[c][i], to->own[c][i]);
    }
  }
  for (int i = 0; i < BatchGram::kShared; ++i) {
    to->shared[i] = Where(where, from.shared[i], to->shared[i]);
  }
}

// Where the lanes of one vector stand.
struct SolverState {
  VectorValues variables, least;
  Floats damping, growth, iterations, start_squares, squares;
  Ints active, converged;
};

// Levenberg–Marquardt with Nielsen's update of the damping (Madsen, Nielsen and Tingleff, "Methods
// for non-linear least squares problems", 2004, algorithm 3.16) and a fixed least diagonal of each
// variable, by 1 + |column of J| at the start.
struct VectorSolver {
  const KernelOptions& options;
  const SolveOptions& solve;
  const BatchViews& views;
  const BatchPrior& prior;
  int first;

  GLINT_INLINE Normal Evaluate(const VectorValues& variables) const {
    const Moved moved = ValuesOf(variables);
    Normal normal = EvaluateProducts<false>(options, views, moved.values, first, nullptr);
    AddPrior(prior, moved.values, first, &normal);
    ChainByVariables(moved.derivatives, &normal);
    return normal;
  }

  // The damped step, and by how much the sum of squares of the linear model falls with it:
  // 2·gᵀs − sᵀJᵀJs with (JᵀJ + D)s = g.
  GLINT_INLINE VectorValues Step(const Normal& normal, const Floats& damping,
                                 const VectorValues& least, Floats* gain) const {
    VectorValues added, descent;
    for (int i = 0; i < kTexelParameters; ++i) {
      added.of[i] = damping * Max(DiagonalOf(normal, i), least.of[i]);
      descent.of[i] = -GradientOf(normal, i);
    }
    const VectorValues step = Factor(normal, added).Solve(descent);
    *gain = Floats{};
    for (int i = 0; i < kTexelParameters; ++i) {
      *gain = Fma(step.of[i], Fma(added.of[i], step.of[i], descent.of[i]), *gain);
    }
    return step;
  }

  GLINT_INLINE void Begin(const Normal& normal, SolverState* state) const {
    state->start_squares = normal.squares();
    for (int i = 0; i < kTexelParameters; ++i) {
      const Floats scale = 1.0f + Sqrt(DiagonalOf(normal, i));
      state->least.of[i] = scale * scale * constants::kLeastDiagonal;
    }
    state->damping = Broadcast(solve.damping);
    state->growth = Broadcast(2.0f);
    state->iterations = Floats{};
  }

  // Until at most `left` lanes are active.
  GLINT_INLINE void Run(bool begin, int left, SolverState* state) const {
    VectorValues& variables = state->variables;
    Normal normal = Evaluate(variables);
    if (begin) Begin(normal, state);
    // Not a number, or infinite: left alone.
    Ints active = state->active & (normal.squares() < __builtin_inff());
    Ints converged = Ints{};
    Floats damping = state->damping, growth = state->growth;
    for (;;) {
      const Ints exact = normal.squares() < 2 * constants::kExactCost;
      converged |= active & exact;
      active &= ~exact;
      VectorValues at;
      Floats expected;
      const VectorValues step = Step(normal, damping, state->least, &expected);
      Floats step_squares = Floats{}, length = Floats{};
      for (int i = 0; i < kTexelParameters; ++i) {
        step_squares = Fma(step.of[i], step.of[i], step_squares);
        length = Fma(variables.of[i], variables.of[i], length);
        at.of[i] = variables.of[i] + step.of[i];
      }
      const Floats least_gain =
          Max(Broadcast(solve.squares_tolerance), normal.squares() * constants::kSquaresRounding);
      const Floats least_step =
          (Sqrt(length) + constants::kStepTolerance) * constants::kStepTolerance;
      // Where no more is promised, however far the step, the search ends.
      Ints last = active & (expected >= 0.0f) & (expected < least_gain);
      if (Any(last)) {
        Floats most;
        Step(normal, Broadcast(constants::kLeastDamping), state->least, &most);
        last &= (most >= 0.0f) & (most < least_gain);
      }
      last |= active & (step_squares < least_step * least_step);
      converged |= last;
      active &= ~last & (state->iterations + 1.0f < float(solve.most_iterations));
      if (Count(active) <= left) break;

      const Normal tried = Evaluate(at);
      state->iterations += Where(active, Broadcast(1.0f), Floats{});
      const Floats gain = normal.squares() - tried.squares();
      const Ints better = active & (gain > 0.0f) & (expected > 0.0f);
      const Ints worse = active & ~better;  // or not a number
      for (int i = 0; i < kTexelParameters; ++i) {
        variables.of[i] = Where(better, at.of[i], variables.of[i]);
      }
      Select(better, tried, &normal);
      const Floats beyond = 2.0f * gain / expected - 1.0f;
      const Floats shrink = Max(Broadcast(1.0f / 3.0f), 1.0f - beyond * beyond * beyond);
      damping *= Where(better, shrink, Where(worse, growth, Broadcast(1.0f)));
      growth = Where(better, Broadcast(2.0f), Where(worse, growth + growth, growth));
    }
    state->squares = normal.squares();
    state->damping = damping;
    state->growth = growth;
    state->active = active;
    state->converged = converged;
  }
};

void Gram(const KernelOptions& options, const BatchViews& views, const BatchValues& values,
          BatchGram* gram, BatchRow* residuals) {
  for (int first = 0; first < kBatch; first += kLanes<float>) {
    const VectorValues x = LoadValues(values, first);
    const Normal normal = residuals != nullptr
                              ? EvaluateProducts<true>(options, views, x, first, residuals)
                              : EvaluateProducts<false>(options, views, x, first, nullptr);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < BatchGram::kOwn; ++i) Put(normal.own[c][i], first, &gram->own[c][i]);
    }
    for (int i = 0; i < BatchGram::kShared; ++i) Put(normal.shared[i], first, &gram->shared[i]);
  }
}

GLINT_INLINE Normal LoadNormal(const BatchGram& gram, int first) {
  Normal normal;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < BatchGram::kOwn; ++i) normal.own[c][i] = At(gram.own[c][i], first);
  }
  for (int i = 0; i < BatchGram::kShared; ++i) normal.shared[i] = At(gram.shared[i], first);
  return normal;
}

void Inverse(const BatchGram& photographs, const BatchPrior& prior, const BatchValues& values,
             float least, BatchInverse* inverse) {
  for (int first = 0; first < kBatch; first += kLanes<float>) {
    Normal normal = LoadNormal(photographs, first);
    AddPrior(prior, LoadValues(values, first), first, &normal);
    VectorValues added;
    for (Floats& value : added.of) value = Broadcast(least);
    const Factor factor(normal, added);
    for (int j = 0; j < kTexelParameters; ++j) {
      VectorValues unit;
      for (int i = 0; i < kTexelParameters; ++i) unit.of[i] = Broadcast(i == j ? 1.0f : 0.0f);
      const VectorValues column = factor.Solve(unit);
      for (int i = 0; i < kTexelParameters; ++i) Put(column.of[i], first, &inverse->of[j][i]);
    }
  }
}

// Where a vector of `solution` stands, and back.
GLINT_INLINE SolverState LoadState(const BatchSolution& solution, bool begin, int first) {
  SolverState state;
  if (begin) {
    state.variables = VariablesOf(LoadValues(solution.values, first));
    return state;
  }
  state.variables = LoadValues(solution.variables, first);
  state.least = LoadValues(solution.least_diagonal, first);
  state.damping = At(solution.damping, first);
  state.growth = At(solution.growth, first);
  state.iterations = At(solution.iterations, first);
  state.start_squares = 2.0f * At(solution.start_cost, first);
  return state;
}

// Of the lanes in `wanted`.
GLINT_INLINE void StoreState(const SolverState& state, const Ints& wanted, int first,
                             BatchSolution* solution) {
  const auto put = [&](const Floats& value, BatchRow* row) {
    Put(Where(wanted, value, At(*row, first)), first, row);
  };
  const Moved moved = ValuesOf(state.variables);
  for (int i = 0; i < kTexelParameters; ++i) {
    put(moved.values.of[i], &solution->values.of[i]);
    put(state.variables.of[i], &solution->variables.of[i]);
    put(state.least.of[i], &solution->least_diagonal.of[i]);
  }
  put(state.damping, &solution->damping);
  put(state.growth, &solution->growth);
  put(state.iterations, &solution->iterations);
  put(0.5f * state.start_squares, &solution->start_cost);
  put(0.5f * state.squares, &solution->cost);
  const LaneBits group = BitsOf(wanted, first);
  solution->converged = (solution->converged & ~group) | BitsOf(state.converged, first);
  solution->finished = (solution->finished & ~group) | BitsOf(wanted & ~state.active, first);
}

void Solve(const KernelOptions& options, const SolveOptions& solve, const BatchViews& views,
           const BatchPrior& prior, LaneBits active, Solving how, BatchSolution* solution) {
  for (int first = 0; first < kBatch; first += kLanes<float>) {
    const Ints wanted = MaskOf(active, first);
    if (!Any(wanted)) continue;
    const bool begin = how == Solving::kBegin;
    SolverState state = LoadState(*solution, begin, first);
    state.active = wanted;
    const VectorSolver solver{options, solve, views, prior, first};
    solver.Run(begin, how == Solving::kFinish ? 0 : kLanes<float> / 2, &state);
    StoreState(state, wanted, first, solution);
  }
}

// A photographed I + 0.01, and by what radiances are multiplied to be compared with it.
struct Relative {
  Floats target, unit;
};
// The same of the radiance that is recorded so, to first order: two of Newton's steps from it.
GLINT_INLINE Relative OfRadiance(const Relative& seen, const CharacteristicCurve& curve) {
  const float toe = float(curve.toe), shoulder = float(curve.shoulder);
  const Floats recorded =
      Max(seen.target / Max(seen.unit, Broadcast(1e-30f)) - float(kLogOffset), Broadcast(0.0f));
  Floats radiance = recorded + (toe > 0 ? toe : 0.0f);
  RecordedRadiance<Floats> of = Recorded(radiance, toe, shoulder);
  for (int step = 0; step < 2; ++step) {
    radiance += (recorded - of.value) / Max(of.slope, Broadcast(0.1f));
    radiance = Max(radiance, Broadcast(0.0f));
    of = Recorded(radiance, toe, shoulder);
  }
  const Floats unit = seen.unit * of.slope;
  return {unit * (radiance + float(kLogOffset)), unit};
}

// Weighted rows relative to I + 0.01, whose inverse is the exponential of −log.
void AlbedoSums(const KernelOptions& options, const BatchViews& views, const BatchValues& values,
                BatchAlbedoSums* sums) {
  for (int first = 0; first < kBatch; first += kLanes<float>) {
    const Floats* lobes = EvaluateLobes<false>(options, views, LoadValues(values, first), first);
    // The diffuse unknown is w·k_d: it has the slopes of w = 1.
    const DiffuseTerms<Floats> diffuse = EvaluateDiffuse(Floats{}, Floats{}, false);
    for (int c = 0; c < 3; ++c) {
      Floats aa{}, ab{}, bb{}, ay{}, by{}, yy{};
      for (int v = 0; v < views.count; ++v) {
        const BatchRow* rows = views.rows + v * Obs::kPlanes;
        const Floats* lobe = lobes + v * BatchViews::kScratchRows;
        const Floats fresnel = At(rows[Obs::kFresnel], first);
        const Floats irradiance = At(rows[Obs::kIrradiance + c], first);
        const Floats usable = Where(At(rows[Obs::kCeiling + c], first) > 0.0f,
                                    Sqrt(At(rows[Obs::kWeight], first)), Floats{});
        Relative seen = {usable, usable * At(rows[Obs::kInverseTarget + c], first)};
        if (!options.curve.straight()) seen = OfRadiance(seen, options.curve);
        const Floats relative = seen.unit;
        const Floats ambient_specular = At(rows[Obs::kAmbientSpecular + c], first);
        const Coat<Floats> coat = CoatIn(lobe, options.mix);
        const ChannelTerms<Floats> terms =
            EvaluateChannel(diffuse, Floats{}, fresnel, lobe[kNormalLight], lobe[kLobe], coat);
        const ChannelSlopes<Floats> slopes = DifferentiateChannel(
            diffuse, terms, fresnel, lobe[kNormalLight], lobe[kLobe], irradiance,
            At(rows[Obs::kAmbient + c], first), ambient_specular, coat.mapped);
        const Floats a = relative * slopes.by_diffuse, b = relative * slopes.by_specular;
        const Floats dark = Fma(ambient_specular, coat.surrounding, Broadcast(float(kLogOffset)));
        const Floats y = seen.target - relative * Fma(irradiance, terms.reflected, dark);
        aa = Fma(a, a, aa);
        ab = Fma(a, b, ab);
        bb = Fma(b, b, bb);
        ay = Fma(a, y, ay);
        by = Fma(b, y, by);
        yy = Fma(y, y, yy);
      }
      const Floats all[] = {aa, ab, bb, ay, by, yy};
      for (int i = 0; i < 6; ++i) Put(all[i], first, &sums->of[c][i]);
    }
  }
}

// TexelGeometryInView.
void Complete(const BatchView& view, const BatchRow place_mm[2], BatchRow* planes) {
  for (int first = 0; first < kBatch; first += kLanes<float>) {
    const Floats x = At(place_mm[0], first), y = At(place_mm[1], first);
    const float* lit_from = view.light_in_sample_mm;
    const float* seen_from = view.camera_in_sample_mm;
    Floats light[3] = {lit_from[0] - x, lit_from[1] - y, Broadcast(lit_from[2])};
    Floats camera[3] = {seen_from[0] - x, seen_from[1] - y, Broadcast(seen_from[2])};
    const Floats light_inverse = 1.0f / Sqrt(Dot3(light, light));
    const Floats camera_inverse = 1.0f / Sqrt(Dot3(camera, camera));
    Floats attenuation = view.inverse_square ? light_inverse * light_inverse : Broadcast(1.0f);
    if (view.beam[0] != 0 || view.beam[1] != 0) {
      const Floats fall = (view.beam[0] * light[0] + view.beam[1] * light[1]) / light[2];
      const Floats fallen = ExpOfNegative(-Min(Abs(fall), Broadcast(80.0f)));
      attenuation *= Where(fall > 0.0f, fallen, 1.0f / fallen);
    }
    Floats sum[3];
    for (int i = 0; i < 3; ++i) {
      light[i] *= light_inverse;
      camera[i] *= camera_inverse;
      sum[i] = light[i] + camera[i];
      Put(light[i], first, &planes[Obs::kLightX + i]);
      Put(camera[i], first, &planes[Obs::kCameraX + i]);
      Put(attenuation * view.exposed_light[i], first, &planes[Obs::kIrradiance + i]);
      const Floats ambient = Broadcast(view.exposed_ambient[i]);
      Put(ambient, first, &planes[Obs::kAmbient + i]);
      Put(ambient, first, &planes[Obs::kAmbientSpecular + i]);
      BatchRow* target = &planes[Obs::kInverseTarget + i];
      const Floats radiance = At(*target, first);
      Put(Log(radiance), first, &planes[Obs::kLogTarget + i]);
      Put(1.0f / radiance, first, target);
    }
    // v·h = |l+v|/2 for unit l and v; opposite ones have no half vector.
    const Floats length = Sqrt(Dot3(sum, sum));
    Put(1.0f / Max(length, Broadcast(1e-10f)), first, &planes[Obs::kHalfInverse]);
    const Floats v_dot_h = Max(0.5f * length, Broadcast(float(kDotClamp)));
    Put(Exp2OfNegative(FresnelExponent(v_dot_h)), first, &planes[Obs::kFresnel]);
  }
}

constexpr BatchKernel kBatchKernel{Complete, Gram, Inverse, Solve, AlbedoSums};

}  // namespace

const BatchKernel& GLINT_KERNEL_NAME();
const BatchKernel& GLINT_KERNEL_NAME() { return kBatchKernel; }

}  // namespace glint::kernel
