#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/formats/manifest.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ManifestTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.Write("out.txt", "result");
    manifest_.stage = "demo";
    manifest_.stage_version = 3;
    manifest_.inputs = {{"../in.txt", HashBytes("in")}};
    manifest_.options = {{"alpha", 0.5}};
    manifest_.outputs = {{"out.txt", HashBytes("result"), 0, 0, {}}};
    json_ = ToJson(manifest_);
  }
  std::filesystem::path Write() { return folder_.Write("manifest.json", json_.dump()); }
  std::string Complaint() {
    const auto file = Write();
    return test::MessageOf<UserError>([&] { VerifyOutputs(file, ReadManifest(file, "demo")); });
  }
  test::TemporaryFolder folder_;
  Manifest manifest_;
  Json json_;
};

TEST_F(ManifestTest, RoundTripIsTheSameJson) {
  EXPECT_EQ(ToJson(ReadManifest(Write(), "demo")).dump(), json_.dump());
  EXPECT_EQ(Complaint(), "");
}

TEST_F(ManifestTest, AnotherVersionIsRefused) {
  json_["glint_manifest"] = 2;
  EXPECT_THAT(Complaint(), AllOf(HasSubstr("glint_manifest"), HasSubstr("found 2")));
}

TEST_F(ManifestTest, AMissingFieldIsNamed) {
  for (const char* field :
       {"stage", "stage_version", "inputs", "options", "outputs", "data", "metrics"}) {
    const Json whole = json_;
    json_.erase(field);
    EXPECT_THAT(Complaint(), AllOf(HasSubstr("manifest.json"), HasSubstr(field))) << field;
    json_ = whole;
  }
}

TEST_F(ManifestTest, APositiveNumberMayBeLeftOutAndIsRefusedOtherwise) {
  const auto read = [](const Json& data) {
    return PositiveNumberIfAny("manifest.json", data, "data", "light_sd_mm");
  };
  EXPECT_EQ(read(Json::object()), std::nullopt);
  EXPECT_EQ(read({{"light_sd_mm", 0.25}}), 0.25);
  for (const Json& wrong : {Json(0), Json(-1.5), Json("thin")}) {
    EXPECT_THAT(test::MessageOf<UserError>([&] {
                  read({{"light_sd_mm", wrong}});
                }),
                HasSubstr("manifest.json: data.light_sd_mm"));
  }
}

TEST_F(ManifestTest, AChangedOutputIsNoticed) {
  folder_.Write("out.txt", "another result");
  EXPECT_THAT(Complaint(), AllOf(HasSubstr("outputs[0].hash"), HasSubstr("out.txt")));
}

TEST_F(ManifestTest, AChangedDigitBreaksTheSeal) {
  json_["data"]["distance_mm"] = 1.5;
  EXPECT_THAT(Complaint(), AllOf(HasSubstr("seal"), HasSubstr("run the stage")));
  json_.erase("seal");  // as other programs write it
  EXPECT_EQ(Complaint(), "");
}

TEST_F(ManifestTest, NamesThatAreNoUtf8KeepTheirSeal) {
  manifest_.data = {{"photo", "caf\xe9.jpg"}};
  json_ = ToJson(manifest_);
  const auto file =
      folder_.Write("manifest.json", json_.dump(1, ' ', false, Json::error_handler_t::replace));
  EXPECT_EQ(ReadManifest(file, "demo").stage, "demo");
}

TEST_F(ManifestTest, OutputsElsewhereAreRefused) {
  json_["outputs"][0]["path"] = "../../out.txt";
  EXPECT_THAT(Complaint(),
              AllOf(HasSubstr("outputs[0].path"), HasSubstr("in the manifest's folder")));
}

TEST_F(ManifestTest, BracketsNestedVeryDeepAreRefused) {
  const std::string text = std::string(100000, '[') + std::string(100000, ']');
  const auto file = folder_.Write("manifest.json", text);
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadManifest(file, "demo"); }),
              HasSubstr("nested 100000 deep"));
}

// They have no end, or wait for someone to write.
TEST_F(ManifestTest, DevicesAndPipesAreRefusedWithoutReadingThem) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::filesystem::path& file : {pipe, std::filesystem::path("/dev/zero")}) {
    EXPECT_THAT(test::MessageOf<UserError>([&] { HashFile(file); }),
                HasSubstr("something that is not a file"));
    EXPECT_THAT(test::MessageOf<UserError>([&] { ReadManifest(file, "demo"); }),
                HasSubstr("something that is not a file"));
  }
}

TEST_F(ManifestTest, AnotherStageIsRefused) {
  json_["stage"] = "other";
  EXPECT_THAT(Complaint(), AllOf(HasSubstr("'other'"), HasSubstr("'demo'")));
}

TEST_F(ManifestTest, AbsolutePathsAreRefused) {
  json_["outputs"][0]["path"] = "/etc/passwd";
  EXPECT_THAT(Complaint(), HasSubstr("outputs[0].path"));
}

TEST_F(ManifestTest, TextThatIsNoJsonIsRefused) {
  const auto file = folder_.Write("manifest.json", "{ not json");
  EXPECT_THAT(test::MessageOf<UserError>([&] { ReadManifest(file); }), HasSubstr("not JSON"));
}

}  // namespace
}  // namespace glint
