// The reflectance model on vectors of texels: the same formulas and clamps as
// fitting/reflectance/brdf.h and brdf_derivatives.h, arranged for speed. Included by kernel.inl.

template <class T>
using VectorOf = typename Lanes<T>::Vector;

template <class T>
GLINT_INLINE VectorOf<T> Dot3(const VectorOf<T>* a, const VectorOf<T>* b) {
  return Fma(a[2], b[2], Fma(a[1], b[1], a[0] * b[0]));
}

template <class T>
struct Texels {
  VectorOf<T> normal[3], diffuse[3], specular[3], roughness;
};

template <class T>
struct Directions {
  VectorOf<T> light[3], camera[3];  // unit
  VectorOf<T> half_inverse;         // 1/|l+v|: the half vector is half_inverse·(l+v)
  VectorOf<T> fresnel;              // the power of two in F
  VectorOf<T> falloff;              // 1 or 1/d²
};

// Values the adjoint needs again, in the notation of brdf_derivatives.h.
template <class T>
struct Shading {
  VectorOf<T> n_dot_l, n_dot_v, n_dot_h;  // clamped
  VectorOf<T> n_dot_l_free, n_dot_v_free, n_dot_h_free;
  VectorOf<T> alpha, k, t_free, inverse_t, inverse_a, inverse_b, inverse_ab;
  VectorOf<T> ratio;            // α/t
  VectorOf<T> specular;         // the factor of F
  VectorOf<T> cosine_over_pi;   // NoL/π
  VectorOf<T> lobe[3];          // w·k_d
  VectorOf<T> ambient_lobe[3];  // w·k_d + k_s
  VectorOf<T> fresnel[3];
  VectorOf<T> radiance[3];  // for irradiance 1 and no ambient
};

template <class T>
GLINT_INLINE Directions<T> Direct(const View<T>& view, bool inverse_square, const VectorOf<T>& x,
                                  T y) {
  using V = VectorOf<T>;
  const V one = Broadcast(T(1));
  Directions<T> d;
  d.light[0] = view.light_mm[0] - x;
  d.light[1] = Broadcast(view.light_mm[1] - y);
  d.light[2] = Broadcast(view.light_mm[2]);
  d.camera[0] = view.camera_mm[0] - x;
  d.camera[1] = Broadcast(view.camera_mm[1] - y);
  d.camera[2] = Broadcast(view.camera_mm[2]);
  const V light_inverse = one / Sqrt(Dot3<T>(d.light, d.light));
  const V camera_inverse = one / Sqrt(Dot3<T>(d.camera, d.camera));
  V sum[3];
  for (int i = 0; i < 3; ++i) {
    d.light[i] *= light_inverse;
    d.camera[i] *= camera_inverse;
    sum[i] = d.light[i] + d.camera[i];
  }
  const V length = Sqrt(Dot3<T>(sum, sum));
  d.half_inverse = one / Max(length, Broadcast(T(1e-10)));
  // v·h = |l+v|/2 for unit l and v.
  const V v_dot_h = Max(length * T(0.5), Broadcast(T(kDotClamp)));
  d.fresnel = Exp2OfNegative(v_dot_h * (v_dot_h * T(kFresnelSquare) + T(kFresnelLinear)));
  d.falloff = inverse_square ? light_inverse * light_inverse : one;
  return d;
}

template <class T>
GLINT_INLINE Shading<T> Shade(const Texels<T>& texels, const Directions<T>& d,
                              bool one_minus_specular) {
  using V = VectorOf<T>;
  const V one = Broadcast(T(1)), clamp = Broadcast(T(kDotClamp));
  const V denominator_clamp = Broadcast(T(kDenominatorClamp));
  Shading<T> s;
  s.n_dot_l_free = Dot3<T>(texels.normal, d.light);
  s.n_dot_v_free = Dot3<T>(texels.normal, d.camera);
  s.n_dot_h_free = (s.n_dot_l_free + s.n_dot_v_free) * d.half_inverse;
  s.n_dot_l = Max(s.n_dot_l_free, clamp);
  s.n_dot_v = Max(s.n_dot_v_free, clamp);
  s.n_dot_h = Max(s.n_dot_h_free, clamp);
  s.alpha = texels.roughness * texels.roughness;
  s.k = Max(s.alpha * T(0.5), denominator_clamp);

  // |n − (n·h)h|², exact where 1 − (n·h)² has no digits left.
  const V scale = s.n_dot_h_free * d.half_inverse;
  V across[3];
  for (int i = 0; i < 3; ++i) {
    across[i] = Fma(-scale, d.light[i] + d.camera[i], texels.normal[i]);
  }
  const V sine_squared =
      s.n_dot_h_free > clamp ? Dot3<T>(across, across) : Broadcast(T(1 - kDotClamp * kDotClamp));
  const V projected = s.n_dot_h * s.alpha;
  s.t_free = Fma(projected, projected, sine_squared);

  // One division for the reciprocals of t, a and b: t·a·b ≥ 1e-24.
  const V t = Max(s.t_free, denominator_clamp);
  const V a = Fma(s.n_dot_l, one - s.k, s.k), b = Fma(s.n_dot_v, one - s.k, s.k);
  const V ab = a * b;
  const V inverse = one / (ab * t);
  s.inverse_t = inverse * ab;
  s.inverse_ab = inverse * t;
  s.inverse_a = s.inverse_ab * b;
  s.inverse_b = s.inverse_ab * a;
  s.ratio = s.alpha * s.inverse_t;
  s.cosine_over_pi = s.n_dot_l * T(kInversePi);
  s.specular = s.ratio * s.ratio * s.inverse_ab * (s.cosine_over_pi * T(0.25));
  for (int c = 0; c < 3; ++c) {
    s.lobe[c] = texels.diffuse[c];
    if (one_minus_specular) s.lobe[c] *= one - texels.specular[c];
    s.ambient_lobe[c] = s.lobe[c] + texels.specular[c];
    s.fresnel[c] = Fma(texels.specular[c], one - d.fresnel, d.fresnel);
    s.radiance[c] = Fma(s.specular, s.fresnel[c], s.lobe[c] * s.cosine_over_pi);
  }
  return s;
}

// Adds to gradient[kPlanes], given for each channel ∂loss/∂(Shading::radiance) and
// ∂loss/∂(Shading::ambient_lobe).
template <class T>
GLINT_INLINE void AddAdjoint(const Texels<T>& texels, const Directions<T>& d, const Shading<T>& s,
                             bool one_minus_specular, const VectorOf<T>* by_radiance,
                             const VectorOf<T>* by_ambient_lobe, VectorOf<T>* gradient) {
  using V = VectorOf<T>;
  const V one = Broadcast(T(1)), zero = V{}, clamp = Broadcast(T(kDotClamp));
  const V denominator_clamp = Broadcast(T(kDenominatorClamp));
  V by_specular = zero, by_cosine = zero;
  const V by_f0 = s.specular * (one - d.fresnel);
  for (int c = 0; c < 3; ++c) {
    V by_lobe = Fma(by_radiance[c], s.cosine_over_pi, by_ambient_lobe[c]);
    gradient[6 + c] = Fma(by_radiance[c], by_f0, gradient[6 + c]) + by_ambient_lobe[c];
    if (one_minus_specular) {
      gradient[6 + c] = Fma(-by_lobe, texels.diffuse[c], gradient[6 + c]);
      by_lobe *= one - texels.specular[c];
    }
    gradient[3 + c] += by_lobe;
    by_specular = Fma(by_radiance[c], s.fresnel[c], by_specular);
    by_cosine = Fma(by_radiance[c], s.lobe[c], by_cosine);
  }

  const V weighted = by_specular * s.specular;
  const V by_t_free = weighted * s.inverse_t * T(-2);
  const V by_t = s.t_free > denominator_clamp ? by_t_free : zero;
  const V alpha_squared = s.alpha * s.alpha;

  // S = (α/t)²·NoL/(4π·a·b): α directly and through t, then through k = α/2 in a and b.
  const V slope = s.ratio * s.inverse_t * s.inverse_ab * (s.cosine_over_pi * T(0.25));
  const V shadowing = Fma(one - s.n_dot_l, s.inverse_a, (one - s.n_dot_v) * s.inverse_b) * weighted;
  V by_alpha = Fma(by_specular, slope, by_t * s.alpha * (s.n_dot_h * s.n_dot_h)) * T(2);
  by_alpha -= s.alpha * T(0.5) > denominator_clamp ? shadowing * T(0.5) : zero;
  gradient[9] = Fma(by_alpha, texels.roughness * T(2), gradient[9]);

  const V squared = s.ratio * s.ratio * s.k * (s.inverse_ab * s.inverse_a);
  V by_n_dot_l = Fma(by_specular * T(0.25), squared, by_cosine) * T(kInversePi);
  by_n_dot_l = s.n_dot_l_free > clamp ? by_n_dot_l : zero;
  V by_n_dot_v = weighted * (s.k - one) * s.inverse_b;
  by_n_dot_v = s.n_dot_v_free > clamp ? by_n_dot_v : zero;
  // ∂t/∂n = 2(n − (n·h)h) + 2(n·h)α²h, with h in terms of l and v.
  const V by_normal = s.n_dot_h_free > clamp ? by_t * T(2) : zero;
  const V by_half = by_normal * s.n_dot_h * (alpha_squared - one) * d.half_inverse;
  by_n_dot_l += by_half;
  by_n_dot_v += by_half;
  for (int i = 0; i < 3; ++i) {
    V sum = Fma(by_n_dot_l, d.light[i], gradient[i]);
    sum = Fma(by_n_dot_v, d.camera[i], sum);
    gradient[i] = Fma(by_normal, texels.normal[i], sum);
  }
}
