// Compiles a kernel for several vector widths and picks one at load time. Contraction is off
// everywhere, so that all of them give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GLINT_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GLINT_VECTOR_CLONES
#endif
