// The kernel for Baseline (see outer_products_kernel.inl, and CMakeLists.txt for its compiler
// flags).
#define GLINT_VECTOR_BYTES 16
#define GLINT_KERNEL_NAME BaselineAddProducts
#include "fitting/view_correction/outer_products_kernel.inl"
