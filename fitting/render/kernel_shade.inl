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
  VectorOf<T> light[3], camera[3], half[3];  // unit
  VectorOf<T> fresnel;                       // the power of two in F
  VectorOf<T> falloff;                       // 1 or 1/d²
};

// Values the adjoint needs again, in the notation of brdf_derivatives.h.
template <class T>
struct Shading {
  VectorOf<T> n_dot_l, n_dot_l_free, n_dot_v_free, n_dot_h, n_dot_h_free;
  VectorOf<T> across[3], alpha, k, inverse_t, t_free, inverse_a, inverse_b, n_dot_v;
  VectorOf<T> ratio, p_per_n_dot_l, specular;  // specular: the factor of F
  VectorOf<T> lobe[3], fresnel[3];             // lobe: w·k_d
  VectorOf<T> radiance[3];                     // for light_rgb = exposure = falloff = 1, no ambient
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
  for (int i = 0; i < 3; ++i) {
    d.light[i] *= light_inverse;
    d.camera[i] *= camera_inverse;
    d.half[i] = d.light[i] + d.camera[i];
  }
  const V length = Sqrt(Dot3<T>(d.half, d.half));
  const V half_inverse = one / Max(length, Broadcast(T(1e-10)));
  for (int i = 0; i < 3; ++i) d.half[i] *= half_inverse;
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
  s.n_dot_h_free = Dot3<T>(texels.normal, d.half);
  s.n_dot_l = Max(s.n_dot_l_free, clamp);
  s.n_dot_v = Max(s.n_dot_v_free, clamp);
  s.n_dot_h = Max(s.n_dot_h_free, clamp);
  s.alpha = texels.roughness * texels.roughness;
  s.k = Max(s.alpha * T(0.5), denominator_clamp);

  for (int i = 0; i < 3; ++i) s.across[i] = Fma(-s.n_dot_h_free, d.half[i], texels.normal[i]);
  const V sine_squared = s.n_dot_h_free > clamp ? Dot3<T>(s.across, s.across)
                                                : Broadcast(T(1 - kDotClamp * kDotClamp));
  const V projected = s.n_dot_h * s.alpha;
  s.t_free = Fma(projected, projected, sine_squared);
  s.inverse_t = one / Max(s.t_free, denominator_clamp);

  const V a = Fma(s.n_dot_l, one - s.k, s.k), b = Fma(s.n_dot_v, one - s.k, s.k);
  const V inverse_ab = one / (a * b);
  s.inverse_a = inverse_ab * b;
  s.inverse_b = inverse_ab * a;
  s.p_per_n_dot_l = inverse_ab * T(0.25 * kInversePi);
  s.ratio = s.alpha * s.inverse_t;
  s.specular = s.ratio * s.ratio * s.p_per_n_dot_l * s.n_dot_l;
  const V cosine_over_pi = s.n_dot_l * T(kInversePi);
  const T coupling = one_minus_specular ? T(1) : T(0);
  for (int c = 0; c < 3; ++c) {
    s.lobe[c] = texels.diffuse[c] * (one - texels.specular[c] * coupling);
    s.fresnel[c] = Fma(texels.specular[c], one - d.fresnel, d.fresnel);
    s.radiance[c] = Fma(s.specular, s.fresnel[c], s.lobe[c] * cosine_over_pi);
  }
  return s;
}

// Adds to gradient[kSvbrdfPlanes], given for each channel ∂loss/∂(Shading::radiance) and
// ∂loss/∂(lobe/π) through the ambient term.
template <class T>
GLINT_INLINE void AddAdjoint(const Texels<T>& texels, const Directions<T>& d, const Shading<T>& s,
                             bool one_minus_specular, const VectorOf<T>* by_radiance,
                             const VectorOf<T>* by_ambient_lobe, VectorOf<T>* gradient) {
  using V = VectorOf<T>;
  const V one = Broadcast(T(1)), zero = V{}, clamp = Broadcast(T(kDotClamp));
  const V denominator_clamp = Broadcast(T(kDenominatorClamp));
  const T coupling = one_minus_specular ? T(1) : T(0);
  V by_specular = zero, by_cosine = zero;
  for (int c = 0; c < 3; ++c) {
    const V by_lobe = Fma(by_radiance[c], s.n_dot_l, by_ambient_lobe[c]) * T(kInversePi);
    gradient[3 + c] += by_lobe * (one - texels.specular[c] * coupling);
    gradient[6 + c] +=
        by_radiance[c] * s.specular * (one - d.fresnel) - by_lobe * texels.diffuse[c] * coupling;
    by_specular = Fma(by_radiance[c], s.fresnel[c], by_specular);
    by_cosine = Fma(by_radiance[c], s.lobe[c], by_cosine);
  }
  const V weighted = by_specular * s.specular;
  const V by_t = s.t_free > denominator_clamp ? weighted * s.inverse_t * T(-2) : zero;
  const V p = s.p_per_n_dot_l * s.n_dot_l;
  const V cosine_squared = s.n_dot_h * s.n_dot_h;
  const V shadowing =
      Fma(one - s.n_dot_l, s.inverse_a, (one - s.n_dot_v) * s.inverse_b) * weighted * T(0.5);
  V by_alpha = (by_specular * s.ratio * s.inverse_t * p + by_t * s.alpha * cosine_squared) * T(2);
  by_alpha -= s.alpha * T(0.5) > denominator_clamp ? shadowing : zero;
  gradient[9] += by_alpha * texels.roughness * T(2);

  const V slope = s.ratio * s.ratio * s.p_per_n_dot_l * s.k * s.inverse_a;
  V by_n_dot_l = Fma(by_specular, slope, by_cosine * T(kInversePi));
  by_n_dot_l = s.n_dot_l_free > clamp ? by_n_dot_l : zero;
  const V by_n_dot_v = s.n_dot_v_free > clamp ? weighted * (s.k - one) * s.inverse_b : zero;
  const V by_across = s.n_dot_h_free > clamp ? by_t * T(2) : zero;
  const V by_half = by_across * s.n_dot_h * s.alpha * s.alpha;
  for (int i = 0; i < 3; ++i) {
    V sum = Fma(by_n_dot_l, d.light[i], gradient[i]);
    sum = Fma(by_n_dot_v, d.camera[i], sum);
    sum = Fma(by_across, s.across[i], sum);
    gradient[i] = Fma(by_half, d.half[i], sum);
  }
}
