// The instruction sets that results may differ by in their last bits (docs/conventions.md), and
// which of them this process computes with.
#pragma once

#include <string>
#include <vector>

namespace glint {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

// Whether this processor has the set.
bool Available(InstructionSet set);

// "baseline", "avx2", "avx512".
const char* Name(InstructionSet set);

// The best set of this processor, or the one that the environment variable GLINT_KERNEL names (one
// that the processor has). Throws std::runtime_error if it names another.
InstructionSet BestInstructionSet();

// Whether bfloat16 products are the processor's own; no where GLINT_KERNEL names less than avx512.
bool NativeBfloat16();

// What the above say, for the record of a run: "avx512", "bf16".
std::vector<std::string> InstructionSetNames();

}  // namespace glint
