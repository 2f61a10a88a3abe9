#include "fitting/texel/batch_kernel.h"

namespace glint::kernel {

const BatchKernel& BaselineBatchKernel();
const BatchKernel& Avx2BatchKernel();
const BatchKernel& Avx512BatchKernel();

const BatchKernel& BatchKernelFor(InstructionSet set) {
#ifdef GLINT_X86_KERNELS
  if (set == InstructionSet::kAvx512) return Avx512BatchKernel();
  if (set == InstructionSet::kAvx2) return Avx2BatchKernel();
#endif
  (void)set;
  return BaselineBatchKernel();
}

}  // namespace glint::kernel
