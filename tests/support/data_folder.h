// Real data that is not part of the repository; tests that use it skip where it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace glint::test {

// $GLINT_DATA, or shared/data beside the repository.
inline std::filesystem::path DataFolder() {
  if (const char* data = std::getenv("GLINT_DATA")) return data;
  return std::filesystem::path(GLINT_SOURCE_DIR).parent_path() / "shared/data";
}

}  // namespace glint::test
