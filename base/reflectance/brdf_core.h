// The formulas of the reflectance model (brdf.h) with their partial derivatives, once for all that
// evaluate it: numbers, automatic differentiation (ceres::Jet), and vectors of texels or views.
// fitting/render/render_reference.cc writes them a second time, to check these.
//
// A texel in a view has a specular lobe S = D·G·NoL/(4·NoL·NoV) (SpecularTerms, SpecularSlopes), a
// diffuse one w·k_d/π (DiffuseTerms) and, by channel,
//
//   radiance = E·(w·k_d/π·NoL + S·F + C·F_c) + A·w·k_d/π + A_s·(m·k_s + (1 − m)·f_c)/π
//
// with E = exposure·irradiance, and A and A_s what the diffuse and the specular lobe reflect of the
// surroundings (ChannelTerms, ChannelSlopes). S of a sample with two specular lobes
// (convention.h) is their sum; where the second is a coat's, C is its part and m the first one's
// share, and F_c the Fresnel term of its F0 f_c (Coat): EvaluateMix, DifferentiateMix. To add
// another kind of lobe: its
// terms and slopes here, its sum with S where S is used (what includes this file), and the same in
// the viewer's GLSL (pipeline/viewer/src/shading.glsl); tests/base/reflectance compares slopes
// with automatic differentiation, tests/fitting/render and tests/fitting/texel the vector code with
// brdf.h.
//
// No standard library here: the vector kernels are compiled once for each instruction set and may
// contain no function that the linker could take from another (base/cpu/vectors.inl).
#pragma once

#include "base/reflectance/brdf_constants.h"
#include "base/reflectance/lobe_mix.h"

#define GLINT_BRDF [[gnu::always_inline]] inline

namespace glint {

// What the formulas need of T beside + − · /. Vectors have their own.
template <class T>
struct Arithmetic {
  using Scalar = T;  // of constants
  GLINT_BRDF static T Constant(Scalar x) { return x; }
  GLINT_BRDF static T MultiplyAdd(const T& a, const T& b, const T& c) { return a * b + c; }
  GLINT_BRDF static T AtLeast(const T& x, Scalar bound) { return x > bound ? x : T(bound); }
  // a where x > bound, else b.
  GLINT_BRDF static T WhereAbove(const T& x, Scalar bound, const T& a, const T& b) {
    return x > bound ? a : b;
  }
};
template <class T>
requires requires { typename T::Scalar; }
struct Arithmetic<T> {  // ceres::Jet
  using Scalar = typename T::Scalar;
  static T Constant(Scalar x) { return T(x); }
  static T MultiplyAdd(const T& a, const T& b, const T& c) { return a * b + c; }
  static T AtLeast(const T& x, Scalar bound) { return x > bound ? x : T(bound); }
  static T WhereAbove(const T& x, Scalar bound, const T& a, const T& b) {
    return x > bound ? a : b;
  }
};
template <class T>
using ScalarOf = typename Arithmetic<T>::Scalar;

// The exponent of two in F's weight.
template <class T>
GLINT_BRDF T FresnelExponent(const T& v_dot_h) {
  using S = ScalarOf<T>;
  return v_dot_h * (v_dot_h * S(kFresnelSquare) + S(kFresnelLinear));
}

// Cosines of a texel in a view, not clamped. sine_squared = |n − (n·h)h|², which is 1 − (n·h)² for
// a unit normal; formed directly it keeps a narrow highlight's digits in single precision.
template <class T>
struct Cosines {
  T n_dot_l, n_dot_v, n_dot_h, sine_squared;
  T n_dot_g{}, h_dot_g{};  // g: LobeShape::direction; where lobes are anisotropic
};

// S and what its slopes need again.
template <class T>
struct SpecularTerms {
  Cosines<T> free;
  T n_dot_l, n_dot_v, n_dot_h;  // clamped
  T alpha, k;
  T wide;       // α·√(γ−1), of GGX α
  T t;          // D = (wide/t)²/π · tail, before t's clamp
  T ratio;      // wide/t
  T inverse_t;  // of the clamped t
  T inverse_a;  // G1(NoL) = NoL/a
  T inverse_b;  // G1(NoV) = NoV/b
  T masking;  // G/(4π·NoL·NoV) = 1/(4π·a·b), times tail = (γ−1)·(NoH²·wide²/t)^(γ−2)
  T over_cosine;  // S/NoL = D·G/(4·NoL·NoV)
  T value;        // S
  // Of anisotropic lobes. With g' the tangent that n leaves of g, a unit vector, h·g' = p/√m,
  // p = h·g − (n·h)(n·g), m = 1 − (n·g)²: p/m.
  T along_by_m;
};

// Of m: a normal within 2° of the sample's plane leaves no tangent.
inline constexpr double kLeastTangent = 1e-3;

template <class T>
GLINT_BRDF SpecularTerms<T> EvaluateSpecular(const Cosines<T>& cosines, const T& roughness,
                                             const LobeShape<ScalarOf<T>>& shape = {}) {
  using A = Arithmetic<T>;
  using S = ScalarOf<T>;
  SpecularTerms<T> s;
  s.free = cosines;
  s.n_dot_l = A::AtLeast(cosines.n_dot_l, S(kDotClamp));
  s.n_dot_v = A::AtLeast(cosines.n_dot_v, S(kDotClamp));
  s.n_dot_h = A::AtLeast(cosines.n_dot_h, S(kDotClamp));
  s.alpha = roughness * roughness;
  s.wide = s.alpha * shape.stretch;
  s.k = A::AtLeast(s.alpha * S(0.5), S(kDenominatorClamp));
  T sine = cosines.sine_squared;
  if (shape.anisotropic) {
    const T along = cosines.h_dot_g - cosines.n_dot_h * cosines.n_dot_g;
    s.along_by_m =
        along / A::AtLeast(T(S(1) - cosines.n_dot_g * cosines.n_dot_g), S(kLeastTangent));
    sine =
        A::MultiplyAdd(s.along_by_m * along, A::Constant(shape.along_weight()), sine * shape.ratio);
  }
  const T sine_squared =
      A::WhereAbove(cosines.n_dot_h, S(kDotClamp), sine, A::Constant(S(1 - kDotClamp * kDotClamp)));
  const T projected = s.n_dot_h * s.wide;
  s.t = A::MultiplyAdd(projected, projected, sine_squared);

  // One division for the reciprocals of t, a and b: t·a·b ≥ 1e-24.
  const T t = A::AtLeast(s.t, S(kDenominatorClamp));
  const T a = A::MultiplyAdd(s.n_dot_l, S(1) - s.k, s.k);
  const T b = A::MultiplyAdd(s.n_dot_v, S(1) - s.k, s.k);
  const T ab = a * b;
  const T inverse = S(1) / (ab * t);
  const T inverse_ab = inverse * t;
  s.inverse_t = inverse * ab;
  s.inverse_a = inverse_ab * b;
  s.inverse_b = inverse_ab * a;
  s.ratio = s.wide * s.inverse_t;
  s.masking = inverse_ab * S(0.25 * kInversePi);
  if (shape.exponent > 2) {
    const T share = projected * projected * s.inverse_t;  // at most 1
    s.masking = s.masking * S(shape.exponent - 1);
    for (int i = 2; i < shape.exponent; ++i) s.masking = s.masking * share;
  }
  s.over_cosine = s.ratio * s.ratio * s.masking;
  s.value = s.over_cosine * s.n_dot_l;
  return s;
}

// ∂(weight·S) by roughness and the normal's products, each with the others fixed; sine_squared
// counts as n·n − (n·h)², so that the derivative by n is
// by_n_dot_l·l + by_n_dot_v·v + by_n_dot_h·h + by_n_dot_g·g + 2·by_n_dot_n·n.
template <class T>
struct SpecularSlopes {
  T by_roughness, by_n_dot_l, by_n_dot_v, by_n_dot_h, by_n_dot_n;
  T by_n_dot_g{};  // of anisotropic lobes

  GLINT_BRDF void operator+=(const SpecularSlopes& other) {
    by_roughness += other.by_roughness;
    by_n_dot_l += other.by_n_dot_l;
    by_n_dot_v += other.by_n_dot_v;
    by_n_dot_h += other.by_n_dot_h;
    by_n_dot_n += other.by_n_dot_n;
    by_n_dot_g += other.by_n_dot_g;
  }
};

// `weight` comes first, so that what cancels between slopes by n·h and by n·n is rounded alike.
template <class T>
GLINT_BRDF SpecularSlopes<T> DifferentiateSpecular(
    const SpecularTerms<T>& s, const T& roughness, const LobeShape<ScalarOf<T>>& shape = {},
    const T& weight = Arithmetic<T>::Constant(ScalarOf<T>(1))) {
  using A = Arithmetic<T>;
  using S = ScalarOf<T>;
  const T zero = A::Constant(S(0));
  const T weighted = weight * s.value;
  const T by_t =
      A::WhereAbove(s.t, S(kDenominatorClamp), weighted * s.inverse_t * S(-shape.exponent), zero);
  // α directly, through t = sin² + (NoH·α)², and through k = α/2 in a and b.
  const T cosine_squared = s.n_dot_h * s.n_dot_h;
  const T direct = s.ratio * s.inverse_t * s.masking * s.n_dot_l;
  const T through_k =
      A::MultiplyAdd(S(1) - s.n_dot_l, s.inverse_a, (S(1) - s.n_dot_v) * s.inverse_b) * weighted;
  T by_alpha =
      A::MultiplyAdd(by_t * s.wide, cosine_squared, weight * direct * S(shape.exponent - 1)) *
      S(2) * shape.stretch;
  by_alpha -= A::WhereAbove(s.alpha * S(0.5), S(kDenominatorClamp), through_k * S(0.5), zero);

  SpecularSlopes<T> slopes;
  slopes.by_roughness = by_alpha * roughness * S(2);
  slopes.by_n_dot_l =
      A::WhereAbove(s.free.n_dot_l, S(kDotClamp), weight * s.over_cosine * s.k * s.inverse_a, zero);
  slopes.by_n_dot_v =
      A::WhereAbove(s.free.n_dot_v, S(kDotClamp), weighted * (s.k - S(1)) * s.inverse_b, zero);
  slopes.by_n_dot_n = A::WhereAbove(s.free.n_dot_h, S(kDotClamp), by_t, zero);
  slopes.by_n_dot_h = slopes.by_n_dot_n * s.n_dot_h * (s.wide * s.wide - shape.ratio) * S(2);
  if (shape.anisotropic) {
    const T by_p = slopes.by_n_dot_n * s.along_by_m * (shape.along_weight() * S(2));
    const T n_dot_g = s.free.n_dot_g;
    const T through_m = A::WhereAbove(T(S(1) - n_dot_g * n_dot_g), S(kLeastTangent),
                                      T(s.along_by_m * n_dot_g), zero);
    slopes.by_n_dot_h -= by_p * n_dot_g;
    slopes.by_n_dot_g = by_p * (through_m - s.free.n_dot_h);
    slopes.by_n_dot_n = slopes.by_n_dot_n * shape.ratio;
  }
  if (shape.exponent > 2) {
    slopes.by_n_dot_h += A::WhereAbove(s.free.n_dot_h, S(kDotClamp),
                                       weighted * S(2 * shape.exponent - 4) / s.n_dot_h, zero);
  }
  return slopes;
}

// S of a mix of lobes, and what its slopes need again.
template <class T>
struct MixTerms {
  SpecularTerms<T> lobes[2];
  T n_dot_l;                 // clamped
  T over_cosine;             // S/NoL
  T value;                   // S
  T coat_over_cosine, coat;  // C/NoL and C; 0 where no lobe is a coat's
};

template <class T, class S>
GLINT_BRDF T LobeRoughness(const T& roughness, const LobeMix<S>& mix, int lobe) {
  using A = Arithmetic<T>;
  const T scaled = roughness * mix.scale[lobe];
  return A::WhereAbove(scaled, S(1), A::Constant(S(1)), scaled);
}

template <class T, class S>
GLINT_BRDF MixTerms<T> EvaluateMix(const Cosines<T>& cosines, const T& roughness,
                                   const LobeMix<S>& mix) {
  MixTerms<T> s;
  s.coat_over_cosine = s.coat = Arithmetic<T>::Constant(S(0));
  if (!mix.two) {
    s.lobes[0] = EvaluateSpecular(cosines, roughness, mix.shape);
    s.n_dot_l = s.lobes[0].n_dot_l;
    s.over_cosine = s.lobes[0].over_cosine;
    s.value = s.lobes[0].value;
    return s;
  }
  for (int i = 0; i < 2; ++i) {
    s.lobes[i] = EvaluateSpecular(cosines, LobeRoughness(roughness, mix, i), mix.shape);
  }
  s.n_dot_l = s.lobes[0].n_dot_l;
  s.over_cosine = s.lobes[0].over_cosine * mix.share[0];
  s.value = s.lobes[0].value * mix.share[0];
  if (mix.coat()) {
    s.coat_over_cosine = s.lobes[1].over_cosine * mix.share[1];
    s.coat = s.lobes[1].value * mix.share[1];
    return s;
  }
  s.over_cosine = s.over_cosine + s.lobes[1].over_cosine * mix.share[1];
  s.value = s.value + s.lobes[1].value * mix.share[1];
  return s;
}

// ∂(weight·share·S_lobe).
template <class T, class S>
GLINT_BRDF SpecularSlopes<T> DifferentiateLobe(const MixTerms<T>& s, const T& roughness,
                                               const LobeMix<S>& mix, int lobe, const T& weight) {
  using A = Arithmetic<T>;
  SpecularSlopes<T> by = DifferentiateSpecular(s.lobes[lobe], LobeRoughness(roughness, mix, lobe),
                                               mix.shape, T(weight * mix.share[lobe]));
  // A lobe as rough as can be stays so.
  by.by_roughness = A::WhereAbove(T(roughness * mix.scale[lobe]), S(1), A::Constant(S(0)),
                                  T(by.by_roughness * mix.scale[lobe]));
  return by;
}

template <class T, class S>
GLINT_BRDF SpecularSlopes<T> DifferentiateMix(
    const MixTerms<T>& s, const T& roughness, const LobeMix<S>& mix,
    const T& weight = Arithmetic<T>::Constant(ScalarOf<T>(1))) {
  if (!mix.two) return DifferentiateSpecular(s.lobes[0], roughness, mix.shape, weight);
  SpecularSlopes<T> sum = DifferentiateLobe(s, roughness, mix, 0, weight);
  if (mix.coat()) return sum;
  sum += DifferentiateLobe(s, roughness, mix, 1, weight);
  return sum;
}

// ∂(weight·C).
template <class T, class S>
GLINT_BRDF SpecularSlopes<T> DifferentiateCoat(
    const MixTerms<T>& s, const T& roughness, const LobeMix<S>& mix,
    const T& weight = Arithmetic<T>::Constant(ScalarOf<T>(1))) {
  return DifferentiateLobe(s, roughness, mix, 1, weight);
}

// The diffuse lobe of one channel with its slopes by k_d and k_s: all that w does.
template <class T>
struct DiffuseTerms {
  T value;  // w·k_d/π
  T by_diffuse, by_specular;
};

// w = 1 − k_s or 1.
template <class T>
GLINT_BRDF DiffuseTerms<T> EvaluateDiffuse(const T& diffuse, const T& specular,
                                           bool one_minus_specular) {
  using A = Arithmetic<T>;
  using S = ScalarOf<T>;
  const T inverse_pi = A::Constant(S(kInversePi));
  if (!one_minus_specular) {
    return {diffuse * S(kInversePi), inverse_pi, A::Constant(S(0))};
  }
  const T by_diffuse = (S(1) - specular) * S(kInversePi);
  return {diffuse * by_diffuse, by_diffuse, -(diffuse * S(kInversePi))};
}

// One channel of a texel in a view.
template <class T>
struct ChannelTerms {
  T fresnel;      // F
  T reflected;    // for E = 1, without surroundings
  T surrounding;  // for A = A_s = 1, without light
};

template <class T>
GLINT_BRDF T Fresnel(const T& specular, const T& weight) {
  using A = Arithmetic<T>;
  using S = ScalarOf<T>;
  return A::MultiplyAdd(specular, S(1) - weight, weight);
}

// What a coat adds to every channel, and m.
template <class T>
struct Coat {
  T reflected = Arithmetic<T>::Constant(ScalarOf<T>(0));    // C·F_c
  T surrounding = Arithmetic<T>::Constant(ScalarOf<T>(0));  // (1 − m)·f_c/π
  ScalarOf<T> mapped = ScalarOf<T>(1);
};

// `c`: C, or C/NoL for the BRDF.
template <class T, class S>
GLINT_BRDF Coat<T> EvaluateCoat(const T& c, const T& fresnel_weight, const LobeMix<S>& mix) {
  using A = Arithmetic<T>;
  if (!mix.coat()) return {};
  return {c * Fresnel(A::Constant(mix.coat_f0), fresnel_weight),
          A::Constant(mix.share[1] * mix.coat_f0 * S(kInversePi)), mix.mapped()};
}

// `s`: the specular lobe S; `fresnel_weight`: 2 to the FresnelExponent.
template <class T>
GLINT_BRDF ChannelTerms<T> EvaluateChannel(const DiffuseTerms<T>& diffuse, const T& specular,
                                           const T& fresnel_weight, const T& n_dot_l, const T& s,
                                           const Coat<T>& coat = {}) {
  using A = Arithmetic<T>;
  using S = ScalarOf<T>;
  ChannelTerms<T> terms;
  terms.fresnel = Fresnel(specular, fresnel_weight);
  terms.reflected = A::MultiplyAdd(s, terms.fresnel, diffuse.value * n_dot_l) + coat.reflected;
  terms.surrounding =
      A::MultiplyAdd(specular, A::Constant(coat.mapped * S(kInversePi)), diffuse.value) +
      coat.surrounding;
  return terms;
}

// ∂radiance of one channel by its albedos, NoL and S, under E, A and A_s.
template <class T>
struct ChannelSlopes {
  T by_diffuse, by_specular, by_n_dot_l, by_lobe;
};

template <class T>
GLINT_BRDF ChannelSlopes<T> DifferentiateChannel(const DiffuseTerms<T>& diffuse,
                                                 const ChannelTerms<T>& channel,
                                                 const T& fresnel_weight, const T& n_dot_l,
                                                 const T& s, const T& irradiance, const T& ambient,
                                                 const T& ambient_specular,
                                                 ScalarOf<T> mapped = ScalarOf<T>(1)) {
  using A = Arithmetic<T>;
  using S = ScalarOf<T>;
  const T received = A::MultiplyAdd(irradiance, n_dot_l, ambient);
  const T by_f0 = A::MultiplyAdd(irradiance, s * (S(1) - fresnel_weight),
                                 ambient_specular * (mapped * S(kInversePi)));
  return {diffuse.by_diffuse * received, A::MultiplyAdd(diffuse.by_specular, received, by_f0),
          irradiance * diffuse.value, irradiance * channel.fresnel};
}

}  // namespace glint

#undef GLINT_BRDF
