// The kernel for Avx2 (see kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 32
#define GLINT_KERNEL_NAME(type) Avx2Kernel##type
#include "fitting/render/kernel.inl"
