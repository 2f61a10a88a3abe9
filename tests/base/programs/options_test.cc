#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "base/errors/errors.h"
#include "base/programs/options.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Sample {
  int iterations = 10;
  double weight = 0.5;
  bool verbose = false;
  std::string method = "latent";
  std::vector<std::string> views;
};

class OptionsTest : public ::testing::Test {
 protected:
  OptionsTest() {
    options_.AddRange("iterations", &sample_.iterations, 1, 100, "steps");
    options_.Add("weight", &sample_.weight, "weight of the prior");
    options_.Add("verbose", &sample_.verbose, "talk", Invalidates::kNo);
    options_.AddChoice("method", &sample_.method, {"latent", "classic"}, "method");
    options_.Add("views", &sample_.views, "views");
    options_.Register(&app_);
  }
  void Parse(const std::string& line) { app_.parse(line, false); }
  void Load(const std::string& table) {
    options_.LoadToml(folder_.Write("capture.toml", "[fit]\n" + table), "fit");
  }
  std::string Complaint(const std::string& table) {
    return test::MessageOf<UserError>([&] { Load(table); });
  }
  Sample sample_;
  OptionSet options_;
  CLI::App app_;
  test::TemporaryFolder folder_;
};

TEST_F(OptionsTest, CommandLineWinsOverTheFile) {
  Parse("--iterations 7 --views a,b");
  Load("iterations = 3\nweight = 2\n");
  EXPECT_EQ(sample_.iterations, 7);
  EXPECT_EQ(sample_.weight, 2);
  EXPECT_THAT(sample_.views, ElementsAre("a", "b"));
}

TEST_F(OptionsTest, OnlyInvalidatingOptionsEnterTheManifest) {
  Parse("--verbose");
  EXPECT_FALSE(options_.ManifestEcho().contains("verbose"));
  EXPECT_TRUE(options_.RunEcho()["verbose"].get<bool>());
  EXPECT_EQ(options_.ManifestEcho()["method"], "latent");
}

TEST_F(OptionsTest, ErrorsNameTheKeyAndTheMend) {
  Parse("");
  EXPECT_THAT(Complaint("iteration = 3"),
              AllOf(HasSubstr("fit.iteration"), HasSubstr("iterations")));
  EXPECT_THAT(Complaint("iterations = \"many\""),
              AllOf(HasSubstr("'many'"), HasSubstr("whole number")));
  EXPECT_THAT(Complaint("iterations = 1000"), AllOf(HasSubstr("1000"), HasSubstr("from 1 to 100")));
  EXPECT_THAT(Complaint("method = \"magic\""), AllOf(HasSubstr("'magic'"), HasSubstr("classic")));
  EXPECT_THAT(Complaint("views = 3"), HasSubstr("list"));
}

}  // namespace
}  // namespace glint
