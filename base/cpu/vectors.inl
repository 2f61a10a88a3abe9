// Vectors of GLINT_VECTOR_BYTES and the few functions on them that kernels need. Included by
// kernels inside an anonymous namespace of glint::kernel, once per instruction set: nothing here
// may be a function that the linker could share with code compiled for another set, so nothing
// comes from std.

#define GLINT_INLINE inline __attribute__((always_inline))

template <class T>
struct Lanes;
template <>
struct Lanes<float> {
  typedef float Vector __attribute__((vector_size(GLINT_VECTOR_BYTES)));
  typedef int Integers __attribute__((vector_size(GLINT_VECTOR_BYTES)));
};
template <>
struct Lanes<double> {
  typedef double Vector __attribute__((vector_size(GLINT_VECTOR_BYTES)));
  typedef long long Integers __attribute__((vector_size(GLINT_VECTOR_BYTES)));
};
template <class T>
inline constexpr int kLanes = GLINT_VECTOR_BYTES / sizeof(T);

typedef Lanes<float>::Vector Floats;
typedef Lanes<float>::Integers Ints;
typedef Lanes<double>::Vector Doubles;

template <class T>
GLINT_INLINE typename Lanes<T>::Vector Broadcast(T x) {
  return x - typename Lanes<T>::Vector{};
}

// b where a is not a number, as the processors' own instructions.
GLINT_INLINE Floats Max(const Floats& a, const Floats& b) {
#if GLINT_VECTOR_BYTES == 64
  return (Floats)_mm512_maskz_max_ps(0xffff, (__m512)a, (__m512)b);
#elif GLINT_VECTOR_BYTES == 32
  return (Floats)_mm256_max_ps((__m256)a, (__m256)b);
#else
  return a > b ? a : b;
#endif
}

GLINT_INLINE Floats Min(const Floats& a, const Floats& b) {
#if GLINT_VECTOR_BYTES == 64
  return (Floats)_mm512_maskz_min_ps(0xffff, (__m512)a, (__m512)b);
#elif GLINT_VECTOR_BYTES == 32
  return (Floats)_mm256_min_ps((__m256)a, (__m256)b);
#else
  return a < b ? a : b;
#endif
}

GLINT_INLINE Doubles Max(const Doubles& a, const Doubles& b) { return a > b ? a : b; }

GLINT_INLINE Doubles Min(const Doubles& a, const Doubles& b) { return a < b ? a : b; }

// a·b + c, rounded once where the instruction set can.
GLINT_INLINE Floats Fma(const Floats& a, const Floats& b, const Floats& c) {
#if GLINT_VECTOR_BYTES == 64
  return (Floats)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif GLINT_VECTOR_BYTES == 32
  return (Floats)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
  return a * b + c;
#endif
}

GLINT_INLINE Doubles Fma(const Doubles& a, const Doubles& b, const Doubles& c) { return a * b + c; }

GLINT_INLINE Floats Sqrt(const Floats& x) {
#if GLINT_VECTOR_BYTES == 64
  // The masked form, as the plain one reads an undefined register in g++ 12's header.
  return (Floats)_mm512_maskz_sqrt_ps(0xffff, (__m512)x);
#elif GLINT_VECTOR_BYTES == 32
  return (Floats)_mm256_sqrt_ps((__m256)x);
#else
  Floats root;
  for (int i = 0; i < kLanes<float>; ++i) root[i] = __builtin_sqrtf(x[i]);
  return root;
#endif
}

GLINT_INLINE Doubles Sqrt(const Doubles& x) {
  Doubles root;
  for (int i = 0; i < kLanes<double>; ++i) root[i] = __builtin_sqrt(x[i]);
  return root;
}

// 2^x for −126 < x ≤ 0: nearest integer and a Taylor polynomial of the rest; relative error < 1e-7.
GLINT_INLINE Floats Exp2OfNegative(const Floats& x) {
  const Ints whole = __builtin_convertvector(x - 0.5f, Ints);
  const Floats rest = x - __builtin_convertvector(whole, Floats);
  Floats p = Broadcast(1.52527338e-5f);  // ln(2)^n / n!, n from 7 down
  p = Fma(p, rest, Broadcast(1.54035304e-4f));
  p = Fma(p, rest, Broadcast(1.33335581e-3f));
  p = Fma(p, rest, Broadcast(9.61812911e-3f));
  p = Fma(p, rest, Broadcast(5.55041087e-2f));
  p = Fma(p, rest, Broadcast(2.40226507e-1f));
  p = Fma(p, rest, Broadcast(6.93147181e-1f));
  p = Fma(p, rest, Broadcast(1.0f));
  return (Floats)((Ints)p + (whole << 23));
}

GLINT_INLINE Doubles Exp2OfNegative(const Doubles& x) {
  Doubles power{};
  for (int i = 0; i < kLanes<double>; ++i) power[i] = __builtin_exp2(x[i]);
  return power;
}

// ln x for normal x > 0: x = m·2^e with m in [√½, √2), and a minimax polynomial (Remez, relative
// error 6e-9 before rounding) in m − 1.
GLINT_INLINE Floats Log(const Floats& x) {
  const Ints exponent = ((Ints)x - 0x3f3504f3) >> 23;
  const Floats m = (Floats)((Ints)x - (exponent << 23)) - 1.0f;
  const Floats e = __builtin_convertvector(exponent, Floats);
  Floats p = Broadcast(-7.63441946e-2f);
  p = Fma(p, m, Broadcast(1.27615505e-1f));
  p = Fma(p, m, Broadcast(-1.31601929e-1f));
  p = Fma(p, m, Broadcast(1.42017614e-1f));
  p = Fma(p, m, Broadcast(-1.66233574e-1f));
  p = Fma(p, m, Broadcast(2.00012268e-1f));
  p = Fma(p, m, Broadcast(-2.50008210e-1f));
  p = Fma(p, m, Broadcast(3.33333317e-1f));
  const Floats square = m * m;
  // ln 2 in two parts, so that e·ln 2 costs no accuracy near 1.
  Floats low = Fma(p * m, square, e * -2.12194440e-4f);
  low = Fma(square, Broadcast(-0.5f), low);
  return Fma(e, Broadcast(0.693359375f), m + low);
}

GLINT_INLINE Doubles Log(const Doubles& x) {
  Doubles log{};
  for (int i = 0; i < kLanes<double>; ++i) log[i] = __builtin_log(x[i]);
  return log;
}

GLINT_INLINE Floats Abs(const Floats& x) { return (Floats)((Ints)x & 0x7fffffff); }

GLINT_INLINE Doubles Abs(const Doubles& x) { return x < 0 ? -x : x; }

// Loads and stores a vector, or only its first `count` lanes (the others then read as 0).
template <class T>
GLINT_INLINE typename Lanes<T>::Vector Load(const T* from, int count) {
  typename Lanes<T>::Vector v = {};
  if (count >= kLanes<T>) {
    __builtin_memcpy(&v, from, sizeof(v));
  } else {
    for (int i = 0; i < count; ++i) v[i] = from[i];
  }
  return v;
}

template <class T>
GLINT_INLINE void Store(T* to, const typename Lanes<T>::Vector& v, int count) {
  if (count >= kLanes<T>) {
    __builtin_memcpy(to, &v, sizeof(v));
  } else {
    for (int i = 0; i < count; ++i) to[i] = v[i];
  }
}
