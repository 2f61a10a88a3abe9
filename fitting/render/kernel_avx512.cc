// The kernel for Avx512 (see kernel.inl, and CMakeLists.txt for its compiler flags).
#define GLINT_VECTOR_BYTES 64
#define GLINT_KERNEL_NAME(type) Avx512Kernel##type
#include "fitting/render/kernel.inl"
