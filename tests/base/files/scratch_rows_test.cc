#include "base/files/scratch_rows.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <numeric>

#include "base/errors/errors.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 5, kPlanes = 3;

std::vector<float> Numbers(int rows, float first) {
  std::vector<float> numbers(static_cast<size_t>(kPlanes * rows * kWidth));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

// In memory, or in a folder of the test's.
class ScratchRowsTest : public ::testing::TestWithParam<bool> {
 protected:
  ScratchRowsTest() {
    if (!GetParam()) return;
    folder_ = fs::path(::testing::TempDir()) / "scratch_rows_test";
    fs::create_directories(folder_);
  }
  ~ScratchRowsTest() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }
  fs::path folder_;
};

TEST_P(ScratchRowsTest, RowsAreReadAsTheyWereWritten) {
  ScratchRows scratch(folder_, kWidth, kPlanes);
  const std::vector<float> below = Numbers(3, 100), above = Numbers(2, 7);
  scratch.Write(2, below);
  scratch.Write(0, above);
  EXPECT_EQ(scratch.Read(2, 3), below);
  EXPECT_EQ(scratch.Read(0, 2), above);
  scratch.Write(2, above);
  EXPECT_EQ(scratch.Read(2, 2), above);
}

TEST_P(ScratchRowsTest, RowsMayBeCutElsewhereWhenTheyAreRead) {
  ScratchRows scratch(folder_, kWidth, kPlanes);
  scratch.Write(0, Numbers(4, 0));
  const std::vector<float> rows = scratch.Read(1, 2);
  for (int plane = 0; plane < kPlanes; ++plane) {
    for (int i = 0; i < 2 * kWidth; ++i) {
      EXPECT_EQ(rows[static_cast<size_t>(plane * 2 * kWidth + i)],
                static_cast<float>((plane * 4 + 1) * kWidth + i));
    }
  }
}

TEST_P(ScratchRowsTest, WhatWasNeverWrittenIsZero) {
  ScratchRows scratch(folder_, kWidth, kPlanes);
  scratch.Write(3, Numbers(1, 1));
  EXPECT_EQ(scratch.Read(0, 3), std::vector<float>(3 * kPlanes * kWidth, 0.0f));
  EXPECT_EQ(scratch.Read(4, 1), std::vector<float>(kPlanes * kWidth, 0.0f));
}

INSTANTIATE_TEST_SUITE_P(Places, ScratchRowsTest, ::testing::Bool());

TEST(ScratchRows, NothingIsToBeSeenInTheFolder) {
  const fs::path folder = fs::path(::testing::TempDir()) / "scratch_rows_unseen";
  fs::create_directories(folder);
  {
    ScratchRows scratch(folder, kWidth, kPlanes);
    scratch.Write(0, Numbers(4, 0));
    EXPECT_TRUE(fs::is_empty(folder));
  }
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(ScratchRows, AFolderThatIsNotThereIsNamed) {
  try {
    const ScratchRows scratch("/no/such/folder", kWidth, kPlanes);
    FAIL() << "a file was made";
  } catch (const EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder: cannot make scratch rows"),
              std::string::npos)
        << error.what();
  }
}

// A file that must not grow stands for a disk that is full.
TEST(ScratchRows, AFullDiskIsAnErrorOfTheEnvironment) {
  ScratchRows scratch(::testing::TempDir(), kWidth, kPlanes);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{64, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(scratch.Write(0, Numbers(4, 0)), EnvironmentError);
  setrlimit(RLIMIT_FSIZE, &before);
}

}  // namespace
}  // namespace glint
