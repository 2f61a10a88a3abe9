// The kernel for Avx512 (see outer_products_kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 64
#define GLINT_KERNEL_NAME Avx512AddProducts
#include "fitting/view_correction/outer_products_kernel.inl"
