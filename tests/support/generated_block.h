// Tables in the documentation that are generated: a test compares them with what is compiled in,
// and writes them anew where GLINT_UPDATE is set.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/files/files.h"

namespace glint::test {

// Expects `table` between <!-- begin NAME --> and <!-- end NAME --> of the page, a path relative to
// the sources; throws unless both are there.
inline void CompareOrUpdate(const std::string& page, const std::string& name,
                            const std::string& table) {
  const std::filesystem::path file = std::filesystem::path(GLINT_SOURCE_DIR) / page;
  std::string text = ReadTextFile(file);
  const std::string opening = "<!-- begin " + name + " -->\n", closing = "<!-- end " + name;
  const size_t before = text.find(opening), end = text.find(closing);
  if (before == std::string::npos || end == std::string::npos) {
    throw std::runtime_error(page + ": no block named " + name);
  }
  const size_t begin = before + opening.size();
  if (std::getenv("GLINT_UPDATE") != nullptr) {
    text.replace(begin, end - begin, "\n" + table + "\n");
    WriteFileAtomically(file, text);
    return;
  }
  EXPECT_EQ(text.substr(begin, end - begin), "\n" + table + "\n")
      << page << " is stale; run GLINT_UPDATE=1 ctest -R page in the build folder";
}

}  // namespace glint::test
