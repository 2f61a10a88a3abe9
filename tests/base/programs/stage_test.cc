#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json.h"
#include "base/photos/decode_count.h"
#include "base/programs/stage.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::HasSubstr;

class StageTest : public ::testing::Test {
 protected:
  StageTest() {
    options_.Add("alpha", &alpha_, "a value");
    folder_.Write("photo.txt", "photo");
  }
  Stage Make(int version = 1) {
    return Stage(folder_ / "glint/demo", {"demo", version}, options_, common_,
                 {folder_ / "photo.txt"});
  }
  void Run(const std::string& text) {
    Stage stage = Make();
    folder_.Write(stage.Output("out.txt").lexically_relative(folder_.path()), text);
    stage.Commit(Json::object(), Json::object());
  }
  std::string Result() const { return ReadTextFile(folder_ / "glint/demo/out.txt"); }

  test::TemporaryFolder folder_;
  OptionSet options_;
  CommonOptions common_;
  double alpha_ = 1;
};

TEST_F(StageTest, IsUpToDateAfterCommitAndStaleAfterAnyChange) {
  EXPECT_FALSE(Make().UpToDate());
  Run("one");
  EXPECT_TRUE(Make().UpToDate());
  EXPECT_FALSE(Make(2).UpToDate()) << "another version of the stage";
  alpha_ = 2;
  EXPECT_FALSE(Make().UpToDate()) << "another option";
  alpha_ = 1;
  EXPECT_TRUE(Make().UpToDate());
  folder_.Write("photo.txt", "another photo");
  EXPECT_FALSE(Make().UpToDate()) << "another input";
  folder_.Write("photo.txt", "photo");
  EXPECT_TRUE(Make().UpToDate()) << "touched, not changed";
  folder_.Write("glint/demo/out.txt", "damaged");
  EXPECT_FALSE(Make().UpToDate()) << "a damaged output";
}

TEST_F(StageTest, UncommittedOutputsLeaveTheOldResult) {
  Run("one");
  {
    Stage stage = Make();
    folder_.Write(stage.Output("out.txt").lexically_relative(folder_.path()), "half");
  }
  EXPECT_EQ(Result(), "one");
  EXPECT_TRUE(Make().UpToDate());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "glint/.demo.new"));
}

TEST_F(StageTest, CommitReplacesTheWholeResult) {
  Run("one");
  folder_.Write("glint/demo/stray.txt", "from an older version");
  alpha_ = 3;
  Run("two");
  EXPECT_EQ(Result(), "two");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "glint/demo/stray.txt"));
}

TEST_F(StageTest, TwoAtOnceAreRefused) {
  const Stage first = Make();
  EXPECT_THAT(test::MessageOf<UserError>([&] { Make(); }), HasSubstr("another process"));
}

TEST_F(StageTest, ManifestIsFreeOfThePlace) {
  Run("one");
  const std::string manifest = ReadTextFile(folder_ / "glint/demo/manifest.json");
  EXPECT_EQ(manifest.find(folder_.path().string()), std::string::npos);
  EXPECT_THAT(manifest, HasSubstr("\"../../photo.txt\""));
}

TEST_F(StageTest, AnInputOutsideTheCaptureIsKnownByNameAndContent) {
  const test::TemporaryFolder elsewhere;
  elsewhere.Write("weights.bin", "1");
  const auto make = [&] {
    return Stage(folder_ / "wood/glint/demo", {"demo", 1}, options_, common_,
                 {elsewhere / "weights.bin"});
  };
  make().Commit(Json::object(), Json::object());
  const std::string manifest = ReadTextFile(folder_ / "wood/glint/demo/manifest.json");
  EXPECT_THAT(manifest, HasSubstr("\"outside:weights.bin\""));
  EXPECT_EQ(manifest.find(elsewhere.path().string()), std::string::npos);
  EXPECT_THAT(ReadTextFile(folder_ / "wood/glint/demo/run.json"),
              HasSubstr((elsewhere / "weights.bin").string()));
  EXPECT_TRUE(make().UpToDate());
  elsewhere.Write("weights.bin", "2");
  EXPECT_FALSE(make().UpToDate());
}

TEST_F(StageTest, RunFactsCountBytesAndPhotographs) {
  const auto facts = [&] { return Json::parse(ReadTextFile(folder_ / "glint/demo/run.json")); };
  Run("one");
  const Json small = facts();
  CountDecodedPhoto();
  CountReducedPhoto();
  CountReducedPhoto();
  alpha_ = 3;
  Run(std::string(1'000'000, 'x'));  // written here, and read for its hash
  const Json large = facts();
  const auto grown = [&](const char* field) {
    return large[field].get<double>() - small[field].get<double>();
  };
  EXPECT_EQ(grown("photographs_decoded"), 1);
  EXPECT_EQ(grown("photographs_decoded_reduced"), 2);
  EXPECT_GE(grown("bytes_written"), 1e6);
  EXPECT_GE(grown("bytes_read"), 1e6);
  EXPECT_GE(large["process_seconds"].get<double>() + 0.01, large["seconds"].get<double>());
}

}  // namespace
}  // namespace glint
