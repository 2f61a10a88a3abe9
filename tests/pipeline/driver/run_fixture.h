// The real driver and stages that compute next to nothing.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/stages/stages.h"
#include "tests/support/process.h"

namespace glint {

inline constexpr char kCaptureToml[] =
    "[sample]\nsize_mm = [100, 100]\n[photos]\nfiles = [\"photos/*.jpg\"]\n"
    "[board]\nsquares = [12, 12]\nsquare_mm = 15\nmarker_mm = 11\n";

// A folder of programs (the real driver, fake stages) and a capture.
class RunTest : public testing::Test {
 protected:
  RunTest() {
    const std::filesystem::path bin = folder_.path() / "bin";
    std::filesystem::create_directory(bin);
    for (const char* name : {"glint", "glint-run", "glint-status", "glint-init", "glint-verify",
                             "glint-view", "glint-estimate"}) {
      std::filesystem::copy_file(std::filesystem::path(GLINT_BIN_DIR) / name, bin / name);
    }
    for (const StageKind& stage : Stages()) {
      std::filesystem::copy_file(std::filesystem::path(GLINT_BIN_DIR) / "fake_stage",
                                 bin / ("glint-" + std::string(stage.name)));
    }
    SetToml("");
    for (const char* photo : {"a.jpg", "b.jpg"})
      test::WriteAll(capture() / "photos" / photo, photo);
  }

  std::filesystem::path capture() const { return folder_.path() / "wood"; }
  std::filesystem::path manifest(const std::string& stage) const {
    return capture() / "glint" / stage / "manifest.json";
  }
  void SetToml(const std::string& more) const {
    test::WriteAll(capture() / "capture.toml", kCaptureToml + more);
  }
  test::Outcome Glint(std::vector<std::string> words) const {
    words.insert(words.begin(), (folder_.path() / "bin/glint").string());
    return test::RunProgram(words);
  }
  // Stages that a run with these further arguments computes, and that it starts.
  struct Ran {
    std::vector<std::string> computed, started;
  };
  Ran RunJson(std::vector<std::string> words = {}) const {
    words.insert(words.begin(), {"run", capture().string(), "--json"});
    const test::Outcome outcome = Glint(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    Ran ran;
    const Json json = Json::parse(outcome.out, nullptr, false);
    if (!json.is_object()) {
      ADD_FAILURE() << outcome.out << outcome.err;
      return ran;
    }
    for (const Json& stage : json["stages"]) {
      if (stage["state"] == "computed") ran.computed.push_back(stage["stage"]);
    }
    ran.started = json["started"].get<std::vector<std::string>>();
    return ran;
  }

  test::TemporaryFolder folder_;
};

}  // namespace glint
