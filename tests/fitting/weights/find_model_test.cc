#include "fitting/weights/find_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "tests/support/process.h"

namespace glint {
namespace {

TEST(Models, AreFoundByEnvironmentAndNamedWhenMissing) {
  const test::TemporaryFolder folder;
  test::WriteAll(folder.path() / "some.safetensors", "x");
  setenv("GLINT_MODELS", folder.path().c_str(), 1);
  EXPECT_EQ(FindModel("some.safetensors"), folder.path() / "some.safetensors");
  try {
    FindModel("other.safetensors");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("other.safetensors"),
                                             testing::HasSubstr(folder.path().string())));
  }
  unsetenv("GLINT_MODELS");
  EXPECT_THROW(FindModel("some.safetensors", folder.path() / "none"), std::runtime_error);
}

}  // namespace
}  // namespace glint
