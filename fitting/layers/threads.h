// How many threads Glint's networks are computed with.
#pragma once

namespace glint {

// libtorch's from now on. An OpenBLAS beneath it is told to use one: with several it adds up in an
// order that depends on their number, and results are to be the same bytes for any.
void UseThreads(int threads);

}  // namespace glint
