// Small synthetic captures.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/process.h"

namespace glint::test {

// `board`: a board.json for round the sample; empty: glint-synth's own.
inline void MakeSynthetic(const std::filesystem::path& to, int photos,
                          const std::filesystem::path& board = {}) {
  std::vector<std::string> command = {std::string(GLINT_BIN_DIR) + "/glint-synth",
                                      "capture",
                                      to.string(),
                                      "--photos",
                                      std::to_string(photos),
                                      "--megapixels",
                                      "1.5",
                                      "--family",
                                      "leather",
                                      "--texels",
                                      "128",
                                      "--seed",
                                      "3"};
  if (!board.empty()) command.insert(command.end(), {"--board", board.string()});
  const TemporaryFolder scratch;
  const pid_t pid = Start(command, scratch / "out", scratch / "err");
  ASSERT_EQ(WaitFor(pid), 0) << ReadAll(scratch / "err");
}

}  // namespace glint::test
