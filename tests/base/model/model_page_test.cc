// docs/model.md and the headers of base/model say the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "base/files/files.h"
#include "tests/base/model/constant_tables.h"
#include "tests/support/generated_block.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr char kPage[] = "docs/model.md";
const fs::path kHeaders = fs::path(GLINT_SOURCE_DIR) / "base/model";

// All subjects' texts, one after the other.
std::string AllHeaders() {
  std::string text;
  for (const auto& entry : fs::directory_iterator(kHeaders)) {
    const bool subject =
        entry.path().extension() == ".h" && entry.path().stem() != "model_constant";
    if (subject) text += ReadTextFile(entry.path());
  }
  return text;
}

std::string WithoutSpace(std::string text) {
  text.erase(
      std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); }),
      text.end());
  return text;
}

std::vector<std::string> AllMatches(const std::string& text, const std::regex& what, size_t group) {
  std::vector<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), what), end; i != end; ++i) {
    found.push_back((*i)[group]);
  }
  return found;
}

TEST(ModelPage, HoldsTheConstantsThatAreCompiledIn) {
  test::CompareOrUpdate(kPage, "constants of the model", test::ModelTable());
}

TEST(ModelPage, HoldsTheConstantsOfSolvers) {
  test::CompareOrUpdate(kPage, "constants of solvers", test::SolverTable());
}

TEST(ModelPage, RowsNameTheConstantsThatTheyShow) {
  const std::string header = AllHeaders();
  const std::regex row(R"re(Row\("([^"]*)",\s*\{([^}]*)\})re");
  const auto names = AllMatches(header, row, 1), values = AllMatches(header, row, 2);
  ASSERT_GT(names.size(), 100u);
  for (size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(WithoutSpace(names[i]), WithoutSpace(values[i]));
  }
}

TEST(ModelPage, EveryConstantHasOneRow) {
  const std::string header = AllHeaders();
  std::vector<std::string> defined;
  for (const std::string& definition :
       AllMatches(header, std::regex(R"(inline constexpr ((?!ModelConstant)[^;]*);)"), 1)) {
    for (std::string& name : AllMatches(definition, std::regex(R"re((k[A-Z]\w*) =)re"), 1)) {
      defined.push_back(std::move(name));
    }
  }
  std::multiset<std::string> shown;
  for (const std::string& names : AllMatches(header, std::regex(R"re(Row\("([^"]*)")re"), 1)) {
    for (std::string& name : AllMatches(names, std::regex(R"(\w+)"), 0)) {
      shown.insert(std::move(name));
    }
  }
  ASSERT_GT(defined.size(), 200u);
  for (const std::string& name : defined) EXPECT_EQ(shown.count(name), 1u) << name;
  EXPECT_EQ(shown.size(), defined.size());
}

TEST(NumberText, IsShortAndExact) {
  EXPECT_EQ(test::NumberText(0.1), "0.1");
  EXPECT_EQ(test::NumberText(0.2f), "0.2");
  EXPECT_EQ(test::NumberText(1e-9f), "1e-9");
  EXPECT_EQ(test::NumberText(2048), "2048");
  EXPECT_EQ(test::NumberText(3.0 / 512), "3/512");
  EXPECT_EQ(test::NumberText(-4), "-4");
  EXPECT_EQ(test::NumberText(1e6), "1e6");
}

}  // namespace
}  // namespace glint
