// The kernel for Baseline (see batch_kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 16
#define GLINT_KERNEL_NAME BaselineBatchKernel
#include "fitting/texel/batch_kernel.inl"
