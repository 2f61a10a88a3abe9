// The kernel for Baseline (see kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 16
#define GLINT_KERNEL_NAME(type) BaselineKernel##type
#include "fitting/render/kernel.inl"
