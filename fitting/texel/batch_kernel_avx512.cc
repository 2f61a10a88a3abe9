// The kernel for Avx512 (see batch_kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 64
#define GLINT_KERNEL_NAME Avx512BatchKernel
#include "fitting/texel/batch_kernel.inl"
