// A small synthetic capture on which every stage has run, made once for all tests; each test works
// on copies.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace glint::test {

// Contents of files by their path relative to a folder.
using Tree = std::map<std::string, std::string>;

// What a person put into a capture: everything but glint/.
Tree Sources(const std::filesystem::path& capture);
// What the stages made and promise to keep: manifests and outputs of all stages, without run.json,
// locks and Ninja's own files.
Tree Results(const std::filesystem::path& capture);

// Paths that differ, for messages; empty: equal.
std::string Differences(const Tree& a, const Tree& b);

// A copy with the times of all files kept, as Ninja needs them.
void CopyCapture(const std::filesystem::path& from, const std::filesystem::path& to);

std::string Program(const std::string& name);

// Whether the trained weights are in this checkout.
bool HasWeights();

class CaptureTest : public testing::Test {
 protected:
  static void SetUpTestSuite();

  // The capture after an uninterrupted run, and that run's duration. Never changed.
  static const std::filesystem::path& finished();
  static double run_seconds();

  // A fresh copy of the finished capture; `capture()` names it.
  CaptureTest();
  const std::filesystem::path& capture() const { return capture_; }
  const std::filesystem::path& folder() const { return folder_.path(); }

  Outcome Glint(std::vector<std::string> words) const;
  Outcome RunCapture(std::vector<std::string> more = {}) const;
  // Replaces the first `from` in capture.toml; the test fails where there is none.
  void EditToml(const std::string& from, const std::string& to) const;
  std::vector<std::filesystem::path> Photos() const;

 private:
  TemporaryFolder folder_;
  std::filesystem::path capture_;
};

}  // namespace glint::test
