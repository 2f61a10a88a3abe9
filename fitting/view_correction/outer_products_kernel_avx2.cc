// The kernel for Avx2 (see outer_products_kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 32
#define GLINT_KERNEL_NAME Avx2AddProducts
#include "fitting/view_correction/outer_products_kernel.inl"
