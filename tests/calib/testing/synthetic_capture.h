// A capture by glint-synth that a suite's tests share, and a copy of it for each to change.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace glint::testing {

inline std::string Program(const std::string& name) {
  return std::string(GLINT_BIN_DIR) + "/" + name;
}

class SyntheticCapture : public ::testing::Test {
 protected:
  // To be called in SetUpTestSuite; `options` of glint-synth capture.
  static void Make(const std::vector<std::string>& options) {
    shared_ = std::make_unique<test::TemporaryFolder>();
    std::vector<std::string> command = {Program("glint-synth"), "capture", Shared().string()};
    command.insert(command.end(), options.begin(), options.end());
    const test::Outcome made = test::RunProgram(command);
    ASSERT_EQ(made.code, 0) << made.err;
  }
  static void TearDownTestSuite() { shared_.reset(); }
  static std::filesystem::path Shared() { return shared_->path() / "capture"; }

  SyntheticCapture() : capture_(folder_.path() / "capture") {
    std::filesystem::copy(Shared(), capture_, std::filesystem::copy_options::recursive);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path capture_;

 private:
  static inline std::unique_ptr<test::TemporaryFolder> shared_;
};

}  // namespace glint::testing
