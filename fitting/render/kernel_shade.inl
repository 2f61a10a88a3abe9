// The reflectance model (base/reflectance/brdf_core.h) on vectors of texels. Included by
// kernel.inl.

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

// What the adjoint needs again.
template <class T>
struct Shading {
  MixTerms<VectorOf<T>> specular;
  ChannelTerms<VectorOf<T>> channels[3];
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
  d.fresnel = Exp2OfNegative(FresnelExponent(v_dot_h));
  d.falloff = inverse_square ? light_inverse * light_inverse : one;
  return d;
}

template <class T>
GLINT_INLINE Cosines<VectorOf<T>> CosinesOf(const Texels<T>& texels, const Directions<T>& d,
                                            const LobeShape<T>& shape) {
  using V = VectorOf<T>;
  Cosines<V> cosines;
  cosines.n_dot_l = Dot3<T>(texels.normal, d.light);
  cosines.n_dot_v = Dot3<T>(texels.normal, d.camera);
  cosines.n_dot_h = (cosines.n_dot_l + cosines.n_dot_v) * d.half_inverse;
  const V scale = cosines.n_dot_h * d.half_inverse;
  V across[3];
  for (int i = 0; i < 3; ++i) {
    across[i] = Fma(-scale, d.light[i] + d.camera[i], texels.normal[i]);
  }
  cosines.sine_squared = Dot3<T>(across, across);
  if (shape.anisotropic) {
    const T* g = shape.direction;
    cosines.n_dot_g = Fma(texels.normal[1], Broadcast(g[1]), texels.normal[0] * g[0]);
    cosines.h_dot_g = d.half_inverse * Fma(d.light[1] + d.camera[1], Broadcast(g[1]),
                                           (d.light[0] + d.camera[0]) * g[0]);
  }
  return cosines;
}

template <class T>
GLINT_INLINE Shading<T> Shade(const Texels<T>& texels, const Directions<T>& d,
                              bool one_minus_specular, const LobeMix<T>& mix) {
  Shading<T> s;
  s.specular = EvaluateMix(CosinesOf<T>(texels, d, mix.shape), texels.roughness, mix);
  const Coat<VectorOf<T>> coat = EvaluateCoat(s.specular.coat, d.fresnel, mix);
  for (int c = 0; c < 3; ++c) {
    s.channels[c] =
        EvaluateChannel(EvaluateDiffuse(texels.diffuse[c], texels.specular[c], one_minus_specular),
                        texels.specular[c], d.fresnel, s.specular.n_dot_l, s.specular.value, coat);
  }
  return s;
}

// Adds to gradient[kPlanes], given for each channel ∂loss/∂reflected and ∂loss/∂surrounding of
// ChannelTerms.
template <class T>
GLINT_INLINE void AddAdjoint(const Texels<T>& texels, const Directions<T>& d, const Shading<T>& s,
                             bool one_minus_specular, const LobeMix<T>& mix,
                             const VectorOf<T>* by_reflected, const VectorOf<T>* by_surrounding,
                             VectorOf<T>* gradient) {
  using V = VectorOf<T>;
  const MixTerms<V>& lobe = s.specular;
  V by_lobe = V{}, by_cosine = V{}, by_coat = V{};
  for (int c = 0; c < 3; ++c) {
    // Slopes of the radiance are linear in what the texel receives: with the loss's own slopes in
    // its place they are the loss's.
    const ChannelSlopes<V> by = DifferentiateChannel(
        EvaluateDiffuse(texels.diffuse[c], texels.specular[c], one_minus_specular), s.channels[c],
        d.fresnel, lobe.n_dot_l, lobe.value, by_reflected[c], by_surrounding[c], by_surrounding[c],
        mix.mapped());
    by_coat += by_reflected[c];
    gradient[3 + c] += by.by_diffuse;
    gradient[6 + c] += by.by_specular;
    by_lobe += by.by_lobe;
    by_cosine += by.by_n_dot_l;
  }

  SpecularSlopes<V> by = DifferentiateMix(lobe, texels.roughness, mix, by_lobe);
  if (mix.coat()) {
    const V fresnel = Fresnel(Broadcast(mix.coat_f0), d.fresnel);
    by += DifferentiateCoat(lobe, texels.roughness, mix, V(by_coat * fresnel));
  }
  gradient[9] += by.by_roughness;
  const V by_normal = by.by_n_dot_n * T(2);
  const V by_half = by.by_n_dot_h * d.half_inverse;  // h in terms of l and v
  const V lit = lobe.lobes[0].free.n_dot_l > T(kDotClamp) ? by_cosine : V{};
  const V by_light = by.by_n_dot_l + lit + by_half;
  const V by_camera = by.by_n_dot_v + by_half;
  for (int i = 0; i < 3; ++i) {
    V sum = Fma(by_light, d.light[i], gradient[i]);
    sum = Fma(by_camera, d.camera[i], sum);
    if (i < 2 && mix.shape.anisotropic) {
      sum = Fma(by.by_n_dot_g, Broadcast(mix.shape.direction[i]), sum);
    }
    gradient[i] = Fma(by_normal, texels.normal[i], sum);
  }
}
