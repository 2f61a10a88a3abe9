#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "fitting/reflectance/svbrdf_maps.h"
#include "fitting/render/kernel.h"

namespace glint::kernel {

static_assert(kPlanes == kSvbrdfPlanes);

RunRowsFunction<float> BaselineKernelFloat();
RunRowsFunction<double> BaselineKernelDouble();
RunRowsFunction<float> Avx2KernelFloat();
RunRowsFunction<double> Avx2KernelDouble();
RunRowsFunction<float> Avx512KernelFloat();
RunRowsFunction<double> Avx512KernelDouble();

bool Available(InstructionSet set) {
#ifdef GLINT_X86_KERNELS
  switch (set) {
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::kBaseline:
      return true;
  }
#endif
  return set == InstructionSet::kBaseline;
}

namespace {

InstructionSet ChooseInstructionSet() {
  constexpr InstructionSet kBestFirst[] = {InstructionSet::kAvx512, InstructionSet::kAvx2,
                                           InstructionSet::kBaseline};
  const char* wanted = std::getenv("GLINT_KERNEL");
  for (const InstructionSet set : kBestFirst) {
    if (Available(set) && (wanted == nullptr || std::strcmp(wanted, Name(set)) == 0)) return set;
  }
  throw std::runtime_error(std::string("GLINT_KERNEL: found '") + wanted +
                           "'; use avx512, avx2 or baseline, as far as this processor has them");
}

}  // namespace

InstructionSet BestInstructionSet() {
  static const InstructionSet best = ChooseInstructionSet();
  return best;
}

const char* Name(InstructionSet set) {
  switch (set) {
    case InstructionSet::kAvx512:
      return "avx512";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kBaseline:
      break;
  }
  return "baseline";
}

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
