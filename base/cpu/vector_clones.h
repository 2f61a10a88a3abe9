// Compiles a function for several vector units and picks one when the program is loaded.
// Contraction is off everywhere, so that all of them give the same bits.
//
// Not under sanitizers: the functions that pick run before a sanitizer has started, and crash.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GLINT_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GLINT_VECTOR_CLONES
#endif
