#include "datasets/evaluation/held_out_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"
#include "base/images/image.h"
#include "datasets/evaluation/predicted_deviation.h"
#include "datasets/procedural/material.h"
#include "datasets/synth/view_set.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParseSplits, GroupsAreApartBySemicolons) {
  const auto splits = ParseSplits("2,6; 7", false);
  ASSERT_EQ(splits.size(), 2u);
  EXPECT_THAT(splits[0].listed, ElementsAre("2", "6"));
  EXPECT_EQ(splits[0].name, "2,6 held out");
  EXPECT_EQ(splits[0].folder, "out_2_6");
  EXPECT_EQ(ParseSplits("0", true)[0].name, "0 fitted");
  EXPECT_TRUE(ParseSplits("", false).empty());
  EXPECT_THROW(ParseSplits("2,,6", false), UserError);
}

HoldoutEntry Entry(const std::string& set, double held_out) {
  HoldoutEntry entry;
  entry.set = set;
  entry.split = "0 fitted";
  entry.method = "refined";
  entry.fitted.log_l1 = 0.25;
  entry.held_out.log_l1 = held_out;
  entry.held_out.standardised = 1;
  entry.fitted.looks.ssim = 0.875;
  entry.held_out.looks.ssim = held_out;
  entry.held_out.looks.contrast[1] = 2 * held_out;
  return entry;
}

TEST(HoldoutResult, TablesHoldEverySetAndTheMean) {
  const HoldoutResult result{{Entry("a", 0.2), Entry("b", 0.4)}};
  ASSERT_EQ(result.Means().size(), 1u);
  EXPECT_NEAR(result.Means()[0].held_out.log_l1, 0.3, 1e-12);
  EXPECT_NEAR(result.Means()[0].held_out.standardised, 1, 1e-12);
  EXPECT_THAT(result.Markdown(), HasSubstr("0.3000"));
  EXPECT_THAT(result.Csv(), HasSubstr("mean,\"0 fitted\",refined"));
  EXPECT_EQ(result.ToJson()["entries"].size(), 2u);
}

TEST(HoldoutResult, LooksAreInEveryTable) {
  const HoldoutResult result{{Entry("a", 0.25), Entry("b", 0.5)}};
  EXPECT_NEAR(result.Means()[0].held_out.looks.ssim, 0.375, 1e-12);
  const std::string table = result.Markdown();
  EXPECT_THAT(table, HasSubstr("looks of held-out views, refined"));
  EXPECT_THAT(table, HasSubstr("0.250 |         – |\n"));
  EXPECT_THAT(table, HasSubstr("mean of fitted views"));
  EXPECT_THAT(table, HasSubstr("0.875 |"));
  EXPECT_THAT(result.Csv(), HasSubstr(",fitted_ssim,held_out_ssim,"));
  EXPECT_THAT(result.Csv(), HasSubstr(",0.875,0.375,,\n"));
  const Json json = result.ToJson();
  EXPECT_EQ(json["entries"][1]["held_out"]["contrast"][1], 1.0);
  EXPECT_EQ(json["means"][0]["fitted"]["ssim"], 0.875);
  EXPECT_TRUE(json["means"][0]["fitted"]["free"].is_null());
}

// The views of a capture as pictures with a list, which glint-import reads.
void WriteImportableSet(const fs::path& capture, const fs::path& set) {
  const RectifiedSet views = ReadRectifiedSet(capture / "glint/rectify/manifest.json");
  Json list = {{"glint_views", 1},
               {"size_mm", {views.plane.width_mm, views.plane.height_mm}},
               {"light_power", "estimate"},
               {"views", Json::array()}};
  fs::create_directories(set);
  for (const RectifiedView& view : views.views) {
    const RectifiedImage from = ReadRectifiedImage(views, view);
    Image picture(from.width, from.height, {"R", "G", "B"});
    for (size_t i = 0; i < from.rgb.size(); ++i) {
      picture.samples[i] = std::pow(std::clamp(from.rgb[i], 0.0f, 1.0f), 1 / 2.2f);
    }
    WritePng(set / (view.name + ".png"), picture);
    list["views"].push_back({{"image", view.name + ".png"},
                             {"camera_in_sample_mm", view.view.camera_in_sample_mm},
                             {"light_in_sample_mm", view.view.light_in_sample_mm}});
  }
  test::WriteAll(set / "views.json", list.dump());
}

class HoldoutRuns : public testing::Test {
 protected:
  HoldoutRuns() {
    ViewSetOptions views;
    views.count = 4;
    views.rule = "photo";
    common_.threads = 2;
    WriteViewSet(folder_ / "sample", {"m", MakeMaterial(77, 32, 32)}, views, common_);
    experiment_.sets = {folder_ / "sample"};
    experiment_.work = folder_ / "work";
    experiment_.methods = {"initial", "refined"};
    experiment_.fit_arguments = {"--iterations", "20"};
    experiment_.splits = ParseSplits("1", false);
  }
  HoldoutResult Run() {
    return RunHoldout(experiment_, common_, [](const std::string&) {});
  }

  test::TemporaryFolder folder_;
  CommonOptions common_;
  HoldoutExperiment experiment_;
};

TEST_F(HoldoutRuns, WhatIsHeldOutIsNotFitted) {
  const HoldoutResult result = Run();
  ASSERT_EQ(result.entries.size(), 2u);
  for (const HoldoutEntry& entry : result.entries) {
    EXPECT_EQ(entry.fitted_views, 3);
    EXPECT_THAT(entry.held_out_names, ElementsAre("view_001"));
    const Manifest manifest = ReadManifest(entry.manifest);
    EXPECT_THAT(manifest.data["views"].get<std::vector<std::string>>(),
                ElementsAre("view_000", "view_002", "view_003"));
  }
  const HoldoutEntry& start = result.entries[0];
  const HoldoutEntry& refined = result.entries[1];
  EXPECT_LT(refined.held_out.log_l1, start.held_out.log_l1);
  EXPECT_LT(start.held_out.standardised, 0);
  EXPECT_GT(refined.held_out.standardised, 0);
  EXPECT_LT(refined.held_out.looks.free, start.held_out.looks.free);
  EXPECT_GT(refined.fitted.looks.ssim, start.fitted.looks.ssim);
}

TEST_F(HoldoutRuns, GoesOnWhereItWas) {
  const std::string first = Run().ToJson().dump();
  const fs::path manifest = Run().entries[1].manifest;
  const auto written = fs::last_write_time(manifest);
  EXPECT_EQ(Run().ToJson().dump(), first);
  EXPECT_EQ(fs::last_write_time(manifest), written);
}

TEST_F(HoldoutRuns, SplitsThatCannotBeAreUserErrors) {
  experiment_.splits = ParseSplits("9", false);
  EXPECT_THROW(Run(), UserError);
  experiment_.splits = ParseSplits("0,1,2,3", false);
  EXPECT_THROW(Run(), UserError);
  experiment_.splits.clear();
  EXPECT_THROW(Run(), UserError);
}

TEST_F(HoldoutRuns, RectifiedViewsHaveTheirSize) {
  experiment_.size = 16;
  try {
    Run();
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("sample: size: found 16; its views are rectified already"));
  }
}

// Pictures that glint-import reads.
TEST_F(HoldoutRuns, SizesOfASetAreKeptApart) {
  const fs::path set = folder_ / "pictures";
  WriteImportableSet(folder_ / "sample", set);
  experiment_.sets = {set};
  experiment_.methods = {"initial"};
  const HoldoutResult whole = Run();
  experiment_.size = 16;
  const HoldoutResult small = Run();
  for (const auto& [result, width] : {std::pair{&whole, 32}, {&small, 16}}) {
    const HoldoutEntry& entry = result->entries[0];
    EXPECT_EQ(ReadRectifiedSet(entry.views).plane.width, width);
    EXPECT_EQ(ReadFittedMaps(entry.manifest).maps.width, width);
  }
}

class StatedDeviationsTest : public testing::Test {
 protected:
  StatedDeviationsTest() {
    fit_.maps = MakeMaterial(77, 16, 16);
    stated_ = {16, 16, std::vector<float>(9 * 256, 0.0f), 0.04};
    set_.plane = {16, 16, 2, 2, TexelSampling::kPixelCentres};
    set_.convention = fit_.convention = ReflectanceConvention::Dir2019();
    view_.view = DirView(0.3, 0.2);
    view_.ldr = false;
  }
  std::vector<float> Deviation() const { return PredictedDeviation(fit_, stated_, set_, view_, 1); }
  FittedMaps fit_;
  StatedDeviations stated_;
  RectifiedSet set_;
  RectifiedView view_;
};

TEST_F(StatedDeviationsTest, KnownMapsLeaveTheResidualsOwn) {
  for (const float deviation : Deviation()) EXPECT_NEAR(deviation, 0.04, 1e-6);
}

TEST_F(StatedDeviationsTest, IndependentDeviationsAddAsSquares) {
  std::fill_n(stated_.planes.begin() + 8 * 256, 256, 0.05f);  // roughness
  const std::vector<float> by_roughness = Deviation();
  std::fill_n(stated_.planes.begin() + 2 * 256, 256, 0.01f);  // red diffuse
  const std::vector<float> by_both = Deviation();
  std::fill_n(stated_.planes.begin() + 8 * 256, 256, 0.0f);
  const std::vector<float> by_diffuse = Deviation();
  for (size_t k = 0; k < 256; ++k) {
    const double sum = std::pow(by_roughness[k], 2) + std::pow(by_diffuse[k], 2) - 0.04 * 0.04;
    EXPECT_NEAR(by_both[k], std::sqrt(sum), 1e-5);
    EXPECT_GT(by_diffuse[k], 0.04);
  }
}

TEST_F(StatedDeviationsTest, CoverageCountsTexelsWithinTheWidth) {
  SvbrdfMaps truth = fit_.maps;
  for (size_t t = 0; t < 128; ++t) truth.plane(kRoughness)[t] += 0.1f;
  std::fill(stated_.planes.begin(), stated_.planes.end(), 0.06f);
  const Coverage one = CoverageOf(fit_.maps, truth, stated_, 1);
  EXPECT_NEAR(one.roughness, 0.5, 1e-9);
  EXPECT_NEAR(one.normal, 1, 1e-9);
  EXPECT_NEAR(CoverageOf(fit_.maps, truth, stated_, 2).roughness, 1, 1e-9);
}

}  // namespace
}  // namespace glint
