#include "pipeline/studio/captures/option_form.h"

#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "pipeline/studio/captures/program_message.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {
namespace {

const Json kForm = Json::parse(R"({"stages": [
  {"name": "fit", "options": [
    {"name": "metals", "type": "choice", "choices": ["rare", "possible"]},
    {"name": "iterations", "type": "integer", "low": 0, "high": 100},
    {"name": "flag", "type": "flag"}]},
  {"name": "sample", "options": [{"name": "resolution_px", "type": "integer", "low": 8, "high": 16384}]},
  {"name": "run", "options": [{"name": "exclude", "type": "text"}]},
  {"name": "tile", "options": [{"name": "enabled", "type": "flag"}]}]})");
constexpr char kSampleOnly[] = "[sample]\nsize_mm = [10, 10]\nresolution_px = 64\n";

std::string With(const char* changes) {
  Capture capture;
  capture.file = "capture.toml";
  return WithOptions(capture, kSampleOnly, Json::parse(changes), kForm);
}

TEST(OptionForm, ChangesGoWhereTheProgramsReadThem) {
  EXPECT_NE(With(R"({"fit": {"metals": "possible", "iterations": 3, "flag": true}})")
                .find("[fit]\nmetals = \"possible\""),
            std::string::npos);
  EXPECT_NE(With(R"({"sample": {"resolution_px": 32}})").find("resolution_px = 32"),
            std::string::npos);
  EXPECT_NE(With(R"({"tile": {"enabled": true}})").find("[tile]"), std::string::npos);
  const std::string held_out = With(R"({"run": {"exclude": "a.jpg,  b.jpg"}})");
  EXPECT_NE(held_out.find("[fit]\nexclude = [\"a.jpg\", \"b.jpg\"]"), std::string::npos);
  EXPECT_NE(held_out.find("[refine]\nexclude = [\"a.jpg\", \"b.jpg\"]"), std::string::npos);
}

TEST(OptionForm, WrongChangesAreRefusedByName) {
  for (const char* changes : {R"({"fit": {"nothing": 1}})", R"({"poses": {"photo": "x"}})",
                              R"({"fit": {"metals": "no"}})", R"({"fit": {"iterations": 101}})",
                              R"({"fit": {"iterations": 1.5}})", R"({"fit": {"iterations": "1"}})",
                              R"({"fit": {"flag": 1}})", R"({"fit": 3})", R"([1])",
                              R"({"sample": {"resolution_px": 1}})"}) {
    EXPECT_THROW(With(changes), HttpError) << changes;
  }
}

TEST(ProgramMessage, TheLastErrorIsSplitIntoMessageAndRemedy) {
  const ProgramMessage said = MessageIn(
      "corners ...\nglint-calib: error: wood/capture.toml: board: found no board; check [board]\n"
      "  a.jpg: nothing\n");
  EXPECT_EQ(said.message, "wood/capture.toml: board: found no board");
  EXPECT_EQ(said.remedy, "check [board]\n  a.jpg: nothing");
  EXPECT_EQ(MessageIn("killed\n").message, "killed");
  EXPECT_EQ(MessageIn("").message, "");
}

}  // namespace
}  // namespace glint
