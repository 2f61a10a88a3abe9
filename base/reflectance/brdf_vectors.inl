// What brdf_core.h's formulas need of vectors (base/cpu/vectors.inl, included before this inside
// glint::kernel).

namespace glint {

// V is another type for each instruction set, and so are these classes: the linker shares none.
template <class V, class T>
struct VectorArithmetic {
  using Scalar = T;
  GLINT_INLINE static V Constant(T x) { return kernel::Broadcast(x); }
  GLINT_INLINE static V MultiplyAdd(const V& a, const V& b, const V& c) {
    return kernel::Fma(a, b, c);
  }
  GLINT_INLINE static V AtLeast(const V& x, T bound) {
    return kernel::Max(x, kernel::Broadcast(bound));
  }
  GLINT_INLINE static V WhereAbove(const V& x, T bound, const V& a, const V& b) {
    return x > bound ? a : b;
  }
};
template <>
struct Arithmetic<kernel::Floats> : VectorArithmetic<kernel::Floats, float> {};
template <>
struct Arithmetic<kernel::Doubles> : VectorArithmetic<kernel::Doubles, double> {};

}  // namespace glint
