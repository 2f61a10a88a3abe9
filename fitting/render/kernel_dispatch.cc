#include "base/reflectance/svbrdf_maps.h"
#include "fitting/render/kernel.h"

namespace glint::kernel {

static_assert(kPlanes == kSvbrdfPlanes);

RunRowsFunction<float> BaselineKernelFloat();
RunRowsFunction<double> BaselineKernelDouble();
RunRowsFunction<float> Avx2KernelFloat();
RunRowsFunction<double> Avx2KernelDouble();
RunRowsFunction<float> Avx512KernelFloat();
RunRowsFunction<double> Avx512KernelDouble();

template <>
RunRowsFunction<float> RunRows<float>(InstructionSet set) {
#ifdef GLINT_X86_KERNELS
  if (set == InstructionSet::kAvx512) return Avx512KernelFloat();
  if (set == InstructionSet::kAvx2) return Avx2KernelFloat();
#endif
  (void)set;
  return BaselineKernelFloat();
}

template <>
RunRowsFunction<double> RunRows<double>(InstructionSet set) {
#ifdef GLINT_X86_KERNELS
  if (set == InstructionSet::kAvx512) return Avx512KernelDouble();
  if (set == InstructionSet::kAvx2) return Avx2KernelDouble();
#endif
  (void)set;
  return BaselineKernelDouble();
}

}  // namespace glint::kernel
