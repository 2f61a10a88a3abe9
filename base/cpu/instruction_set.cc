#include "base/cpu/instruction_set.h"

#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace glint {
namespace {

InstructionSet ChooseInstructionSet() {
  constexpr InstructionSet kBestFirst[] = {InstructionSet::kAvx512, InstructionSet::kAvx2,
                                           InstructionSet::kBaseline};
  const char* wanted = std::getenv("GLINT_KERNEL");
  for (const InstructionSet set : kBestFirst) {
    if (Available(set) && (wanted == nullptr || std::strcmp(wanted, Name(set)) == 0)) return set;
  }
  throw std::runtime_error(std::string("GLINT_KERNEL: found '") + wanted +
                           "'; use avx512, avx2 or baseline, whichever this processor supports");
}

}  // namespace

bool Available(InstructionSet set) {
#if defined(__x86_64__)
  __builtin_cpu_init();
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

InstructionSet BestInstructionSet() {
  static const InstructionSet best = ChooseInstructionSet();
  return best;
}

bool NativeBfloat16() {
#if defined(__x86_64__)
  return BestInstructionSet() == InstructionSet::kAvx512 && __builtin_cpu_supports("avx512bf16");
#else
  return false;
#endif
}

std::vector<std::string> InstructionSetNames() {
  std::vector<std::string> names{Name(BestInstructionSet())};
  if (NativeBfloat16()) names.emplace_back("bf16");
  return names;
}

}  // namespace glint
