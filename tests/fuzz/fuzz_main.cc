// libFuzzer's entry: GLINT_FUZZ_TARGET in the environment names the target.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.h"
#include "tests/support/process.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const glint::test::TemporaryFolder folder;
  static const glint::fuzz::FuzzTarget& target = [] {
    const char* name = std::getenv("GLINT_FUZZ_TARGET");
    return glint::fuzz::FindFuzzTarget(name == nullptr ? "" : name);
  }();
  glint::fuzz::Accepts(target, folder.path(), {reinterpret_cast<const char*>(data), size});
  return 0;
}
