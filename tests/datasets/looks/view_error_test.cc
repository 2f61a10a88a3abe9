#include "datasets/looks/view_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash.h"
#include "base/formats/svbrdf_file.h"
#include "datasets/procedural/material.h"
#include "datasets/synth/view_set.h"
#include "fitting/render/render_environment.h"
#include "fitting/render/render_lit.h"
#include "fitting/view_correction/corrections_json.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

RectifiedImage Uniform(float value, int width = 4, int height = 3) {
  const size_t texels = static_cast<size_t>(width) * height;
  return {width, height, std::vector<float>(3 * texels, value), std::vector<float>(texels, 1.0f)};
}

TEST(CompareView, KnownDifference) {
  const ViewError error = CompareView(Uniform(0.3f).rgb, Uniform(0.5f), true);
  EXPECT_NEAR(error.mse, 0.04, 1e-7);
  EXPECT_NEAR(error.rmse, 0.2, 1e-7);
  EXPECT_NEAR(error.log_l1, std::log(0.51 / 0.31), 1e-6);
  EXPECT_EQ(error.texels, 12u);
}

TEST(CompareView, ClipsForLdrOnly) {
  EXPECT_EQ(CompareView(Uniform(3).rgb, Uniform(1), true).mse, 0);
  EXPECT_NEAR(CompareView(Uniform(3).rgb, Uniform(1), false).mse, 4, 1e-6);
}

TEST(CompareView, MaskedTexelsDoNotCount) {
  RectifiedImage photograph = Uniform(0.5f);
  std::vector<float> rendered = photograph.rgb;
  photograph.mask[5] = 0;
  for (size_t c = 0; c < 3; ++c) rendered[c * 12 + 5] = 100;
  EXPECT_EQ(CompareView(rendered, photograph, false).mse, 0);
  EXPECT_EQ(CompareView(rendered, photograph, false).texels, 11u);
  for (float& m : photograph.mask) m = 0;
  EXPECT_EQ(CompareView(rendered, photograph, false).texels, 0u);
}

TEST(CompareView, SizesMustAgree) {
  EXPECT_THROW(CompareView(Uniform(1, 2, 2).rgb, Uniform(1), true), std::invalid_argument);
}

class FittedMapsTest : public testing::Test {
 protected:
  void SetUp() override {
    options_.count = 2;
    options_.bits = "float";
    options_.rule = "photo";
    common_.threads = 1;
    WriteViewSet(capture(), material_, options_, common_);
    set_ = ReadRectifiedSet(capture() / "glint/rectify/manifest.json");
  }
  fs::path capture() const { return folder_.path() / "capture"; }

  // What fit would leave behind: maps and the scale of the light.
  fs::path WriteFit(const std::string& stage, const Json& data) {
    fs::path fit = folder_.path() / stage;
    fs::create_directories(fit);
    WriteSvbrdf(fit / "svbrdf.exr", material_.maps, set_.convention);
    Manifest manifest;
    manifest.stage = stage;
    manifest.outputs = {{"svbrdf.exr", HashFile(fit / "svbrdf.exr"), 0, 0, {}}};
    manifest.data = data;
    WriteFileAtomically(fit / "manifest.json", ToJson(manifest).dump());
    return fit;
  }
  ViewError ErrorOf(const FittedMaps& fit) const {
    return CompareView(RenderFit(fit, set_, set_.views[1], 1),
                       ReadRectifiedImage(set_, set_.views[1]), false);
  }

  test::TemporaryFolder folder_;
  const MaterialSource material_{"m", MakeMaterial(77, 24, 24)};
  ViewSetOptions options_;
  CommonOptions common_;
  RectifiedSet set_;
};

TEST_F(FittedMapsTest, TrueMapsReRenderTheViewsExactly) {
  EXPECT_EQ(ErrorOf(ReadFittedMaps(capture() / "truth/svbrdf.exr")).mse, 0);
  EXPECT_EQ(ErrorOf(ReadFittedMaps(WriteFit("fit", Json::object()))).mse, 0);
}

TEST_F(FittedMapsTest, LightScaleMultipliesTheRendering) {
  const FittedMaps fit = ReadFittedMaps(WriteFit("refine", {{"light_scale_rgb", {2, 2, 2}}}));
  const auto doubled = RenderFit(fit, set_, set_.views[0], 1);
  const auto image = ReadRectifiedImage(set_, set_.views[0]);
  for (size_t i = 0; i < doubled.size(); ++i) {
    ASSERT_NEAR(doubled[i], 2 * image.rgb[i], 1e-5 * (1 + image.rgb[i]));
  }
}

TEST_F(FittedMapsTest, ViewsAreComparedAsTheyWereCorrected) {
  ViewCorrection correction;
  correction.exposure = 2;
  std::fill_n(correction.shifts.column, 4, 1.0);  // one texel to the right
  const std::string& name = set_.views[0].name;
  const FittedMaps fit = ReadFittedMaps(
      WriteFit("refine", {{"corrections", Json::array({JsonOf(name, correction)})}}));
  const RectifiedImage seen = ReadRectifiedImage(set_, set_.views[0]);
  const auto doubled = RenderFit(fit, set_, set_.views[0], 1);
  const RectifiedImage moved = PhotographOfFit(fit, set_, set_.views[0]);
  for (size_t i = 0; i < doubled.size(); ++i) {
    ASSERT_NEAR(doubled[i], 2 * seen.rgb[i], 1e-5 * (1 + seen.rgb[i]));
    if (i % 24 == 23) continue;
    ASSERT_NEAR(moved.rgb[i], seen.rgb[i + 1], 1e-5 * (1 + seen.rgb[i + 1]));
  }
  EXPECT_EQ(ErrorOf(fit).mse, 0);  // the other view has no correction
  EXPECT_EQ(PhotographOfFit(fit, set_, set_.views[1]).rgb,
            ReadRectifiedImage(set_, set_.views[1]).rgb);
}

// What is found of the flash is known of views that were not fitted, too.
TEST_F(FittedMapsTest, EveryViewIsLitByTheFlashThatWasFound) {
  const SharedLight shared{{3. / 256, -2. / 256, 0.4, -0.3, 1.5}, 256};
  const FittedMaps fit = ReadFittedMaps(WriteFit("refine", {{"shared_light", JsonOf(shared)}}));
  for (const RectifiedView& view : set_.views) {
    std::vector<float> expected(3 * material_.maps.texels());
    RenderLit(material_.maps, set_.plane, WithSharedLight(view.view, shared), set_.convention,
              expected.data());
    EXPECT_EQ(RenderFit(fit, set_, view, 2), expected);
  }
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"shared_light", {{"offset_mm", {1, 2}}}}})),
               UserError);
  Json nowhere = JsonOf(shared);
  nowhere["distance_mm"] = 0;
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"shared_light", nowhere}})), UserError);
}

// The curve is the photographs', so that renderings are compared as they would be recorded.
TEST_F(FittedMapsTest, EveryViewIsRecordedByTheCurveThatWasFound) {
  SharedLight shared{.distance_mm = 256};
  shared.values[kSharedToe] = 0.02 / kToeUnit;
  shared.values[kSharedShoulder] = 0.2;
  Json json = JsonOf(shared);
  const FittedMaps fit = ReadFittedMaps(WriteFit("refine", {{"shared_light", json}}));
  json.erase("toe");
  json.erase("shoulder");
  const FittedMaps old = ReadFittedMaps(WriteFit("refine", {{"shared_light", json}}));
  for (RectifiedView view : set_.views) {
    view.ldr = true;
    const std::vector<float> straight = RenderFit(old, set_, view, 1);
    std::vector<float> expected = straight;
    Record({0.02, 0.2}, expected);
    const std::vector<float> recorded = RenderFit(fit, set_, view, 1);
    EXPECT_NE(recorded, straight);
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_FLOAT_EQ(recorded[i], expected[i]);
    view.linear = true;  // RAW of the same sample
    EXPECT_EQ(RenderFit(fit, set_, view, 1), straight);
  }
}

// Environment lighting reaches held-out views, too.
TEST_F(FittedMapsTest, EveryViewIsLitByTheEnvironmentThatWasFound) {
  EnvironmentLighting environment;
  environment.radiance_rgb = {{0.2, 0.1, 0.1}, {0, 0, 0}, {0.1, 0, 0}, {0, 0, 0}};
  const FittedMaps dark = ReadFittedMaps(WriteFit("refine", Json::object()));
  const FittedMaps fit = ReadFittedMaps(WriteFit("refine", {{"room_light", JsonOf(environment)}}));
  for (const RectifiedView& view : set_.views) {
    std::vector<float> expected = RenderFit(dark, set_, view, 1);
    AddEnvironmentLighting(environment, material_.maps, set_.plane, view.view, set_.convention,
                           expected.data());
    EXPECT_EQ(RenderFit(fit, set_, view, 2), expected);
    EXPECT_NE(expected, RenderFit(dark, set_, view, 1));
  }
}

TEST_F(FittedMapsTest, BrokenEnvironmentLightingIsAUserError) {
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"room_light", 3}})), UserError);
  const Json two_terms = {{"radiance_rgb", {{1, 1, 1}, {0, 0, 0}}}};
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"room_light", two_terms}})), UserError);
  const Json two_channels = {{"radiance_rgb", {{1, 1}}}};
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"room_light", two_channels}})), UserError);
}

TEST_F(FittedMapsTest, BrokenCorrectionsAreUserErrors) {
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"corrections", 3}})), UserError);
  Json entry = JsonOf("view_000", {});
  entry["light_offset_mm"] = "far";
  EXPECT_THROW(ReadFittedMaps(WriteFit("refine", {{"corrections", Json::array({entry})}})),
               UserError);
}

TEST_F(FittedMapsTest, OtherStagesAndBrokenScalesAreUserErrors) {
  EXPECT_THROW(ReadFittedMaps(capture() / "glint/rectify"), UserError);
  EXPECT_THROW(ReadFittedMaps(WriteFit("fit", {{"light_scale_rgb", "bright"}})), UserError);
  EXPECT_THROW(ReadFittedMaps(folder_.path() / "nothing"), UserError);
}

}  // namespace
}  // namespace glint
