// The kernel for Avx2 (see batch_kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 32
#define GLINT_KERNEL_NAME Avx2BatchKernel
#include "fitting/texel/batch_kernel.inl"
