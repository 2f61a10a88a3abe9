#include "fitting/layers/threads.h"

#include <dlfcn.h>
#include <torch/torch.h>

namespace glint {

void UseThreads(int threads) {
  // To set it makes libtorch's other pool of threads anew, which then wait spinning.
  if (torch::get_num_threads() != threads) torch::set_num_threads(threads);
  // libtorch does not say which BLAS is behind it.
  using SetThreads = void (*)(int);
  static const auto of_openblas =
      reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (of_openblas != nullptr) of_openblas(1);
}

}  // namespace glint
