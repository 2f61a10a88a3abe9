#include "pipeline/studio/captures/toml_edit.h"

#include <gtest/gtest.h>

#include "base/errors/errors.h"

namespace glint {
namespace {

constexpr char kText[] = R"(# mine
kind = "moved camera"

[sample]                # the sample
size_mm = [100, 100]    # width, height
resolution_px = 1024  # texels

[photos]
files = [
  "photos/*.jpg",  # from the phone
  "photos/*.png",
]

# [fit]
# metals = "possible"
[export]
name = "wood"
)";

std::string Set(const std::string& text, const std::string& table, const std::string& key,
                const std::optional<Json>& value) {
  return WithTomlValue("capture.toml", text, table, key, value);
}

TEST(TomlEdit, AChangedValueLeavesEverythingElseAsItIs) {
  std::string wanted = kText;
  wanted.replace(wanted.find("1024"), 4, "512");
  EXPECT_EQ(Set(kText, "sample", "resolution_px", Json(512)), wanted);
}

TEST(TomlEdit, ANewKeyGoesToTheEndOfItsTable) {
  const std::string text = Set(kText, "sample", "height_mm", Json("auto"));
  EXPECT_NE(text.find("# texels\nheight_mm = \"auto\"\n\n[photos]"), std::string::npos) << text;
}

TEST(TomlEdit, ANewTableStandsWhereItsRemarkStood) {
  const std::string text = Set(kText, "fit", "iterations", Json(3));
  EXPECT_NE(text.find("\n[fit]\niterations = 3\n# metals"), std::string::npos) << text;
  EXPECT_EQ(text.find("# [fit]"), std::string::npos);
}

TEST(TomlEdit, AKeyThatIsTakenAwayAndOneThatWasNeverThere) {
  EXPECT_EQ(Set(Set(kText, "sample", "height_mm", Json(1)), "sample", "height_mm", std::nullopt),
            kText);
  EXPECT_EQ(Set(kText, "fit", "iterations", std::nullopt), kText);
}

TEST(TomlEdit, AListOverSeveralLinesIsReplacedWhole) {
  const std::string text = Set(kText, "photos", "files", Json({"a.jpg"}));
  EXPECT_NE(text.find("[photos]\nfiles = [\"a.jpg\"]\n"), std::string::npos) << text;
}

TEST(TomlEdit, AnItemIsAddedOnce) {
  const std::string text =
      WithTomlListItem("capture.toml", kText, "photos", "files", "photos/*.heic");
  EXPECT_NE(text.find(R"(files = ["photos/*.jpg", "photos/*.png", "photos/*.heic"])"),
            std::string::npos);
  EXPECT_EQ(WithTomlListItem("capture.toml", text, "photos", "files", "photos/*.png"), text);
}

TEST(TomlEdit, TablesComeAndGo) {
  const std::string with = WithTomlTable("capture.toml", kText, "tile", true);
  EXPECT_NE(with.find("\n[tile]\n"), std::string::npos);
  EXPECT_EQ(WithTomlTable("capture.toml", with, "tile", true), with);
  const std::string without = WithTomlTable("capture.toml", with, "tile", false);
  EXPECT_EQ(without.find("[tile]"), std::string::npos);
  EXPECT_NE(without.find("name = \"wood\""), std::string::npos);
}

TEST(TomlEdit, TextsAreEscapedSoThatTheyStayOneValue) {
  const std::string evil = "a\"\n[export]\nname = \"x\\";
  const std::string text = Set(kText, "fit", "note", Json(evil));
  EXPECT_NE(text.find("name = \"wood\""), std::string::npos);
  EXPECT_NO_THROW(Set(text, "fit", "note", Json("b")));
}

TEST(TomlEdit, WhatALineCannotChangeIsLeftToAPerson) {
  for (const char* text : {"sample = { size_mm = [1, 2] }\n", "sample.size_mm = 1\n",
                           "[sample\nsize_mm = 1\n", "[sample]\nsize_mm = 1\nsize_mm = 2\n"}) {
    EXPECT_THROW(Set(text, "sample", "size_mm", Json(3)), UserError) << text;
  }
  EXPECT_THROW(Set(kText, "sample", "size mm", Json(3)), UserError);
  EXPECT_THROW(Set(kText, "sample", "size_mm", Json::object()), UserError);
}

}  // namespace
}  // namespace glint
