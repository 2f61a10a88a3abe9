// What is said of a camera that stood still: of its lights alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "calib/guidance/verdict.h"
#include "tests/calib/moving_light/lights_on_a_dome.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

GuidanceInput LitFromDirections(const std::vector<Eigen::Vector3d>& lights) {
  GuidanceInput input;
  input.fixed_camera = true;
  input.sample_size_mm = {100, 100};
  input.resolution_px = {512, 512};
  for (size_t i = 0; i < lights.size(); ++i) {
    GuidancePhoto photo;
    photo.name = "light" + std::to_string(i) + ".jpg";
    photo.camera_in_sample_mm = {0, 0, 1000};
    photo.light_in_sample_mm = 1000 * lights[i];
    input.photos.push_back(photo);
  }
  return input;
}

GuidanceInput WholeDome(int lights = 40) {
  return LitFromDirections(testing::LightsOnADome(lights));
}

std::set<std::string> Topics(const GuidanceInput& input) {
  std::set<std::string> topics;
  for (const Advice& advice : Judge(input).advice) topics.insert(advice.topic);
  return topics;
}

Advice On(const GuidanceInput& input, const std::string& topic) {
  for (const Advice& advice : Judge(input).advice) {
    if (advice.topic == topic) return advice;
  }
  return {};
}

TEST(LightAdvice, NothingIsMissingInADome) {
  const Verdict verdict = Judge(WholeDome());
  EXPECT_EQ(verdict.advice.size(), 0u) << TextOf(verdict);
  EXPECT_EQ(verdict.Word(), "good");
  EXPECT_THAT(verdict.Summary(),
              AllOf(HasSubstr("camera fixed, 40 lights, 16 to 77° above the sample's plane")));
}

// One camera from the top is what such a capture has, and no lack.
TEST(LightAdvice, NothingIsSaidOfWhereTheCameraStood) {
  GuidanceInput input = WholeDome();
  for (GuidancePhoto& photo : input.photos) photo.camera_in_sample_mm = {600, 0, 700};
  EXPECT_EQ(Topics(input), std::set<std::string>());
}

TEST(LightAdvice, FewLightsAreAHintAndVeryFewAreMore) {
  EXPECT_EQ(On(WholeDome(24), "few_lights").text, "");
  const Advice few = On(WholeDome(20), "few_lights");
  EXPECT_THAT(few.text, HasSubstr("20 lights: 24 or more"));
  EXPECT_EQ(few.importance, Importance::kHint);
  EXPECT_EQ(On(WholeDome(6), "few_lights").importance, Importance::kUseful);
  EXPECT_THAT(On(WholeDome(1), "few_lights").text, HasSubstr("1 light: "));
}

TEST(LightAdvice, SideWithoutALightIsNamed) {
  GuidanceInput input = WholeDome(60);
  std::erase_if(input.photos, [](const GuidancePhoto& photo) {
    return photo.light_in_sample_mm.x() < -std::abs(photo.light_in_sample_mm.y());
  });
  EXPECT_THAT(On(input, "light_sides").text, HasSubstr("no light from the left"));
  GuidancePhoto added = input.photos[0];
  added.light_in_sample_mm = {-800, 0, 600};
  input.photos.push_back(added);
  EXPECT_EQ(On(input, "light_sides").text, "");
}

TEST(LightAdvice, HighLightsAreMissed) {
  const GuidanceInput low = LitFromDirections(testing::LightsOnADome(40, 15, 45));
  EXPECT_EQ(Topics(low), std::set<std::string>{"high_lights"});
  EXPECT_THAT(On(low, "high_lights").text, HasSubstr("the highest light is 45° above"));
}

TEST(LightAdvice, RakingLightsAreMissed) {
  const GuidanceInput high = LitFromDirections(testing::LightsOnADome(40, 45, 80));
  EXPECT_EQ(Topics(high), std::set<std::string>{"low_lights"});
  EXPECT_THAT(On(high, "low_lights").text, HasSubstr("the lowest light is 45° above"));
}

TEST(LightAdvice, ClippedPhotographsAreNamed) {
  GuidanceInput input = WholeDome();
  input.photos[3].clipped_share = 0.15;
  EXPECT_EQ(On(input, "clipped").text, "");
  input.photos[3].clipped_share = 0.42;
  EXPECT_THAT(On(input, "clipped").text,
              AllOf(HasSubstr("42 %"), HasSubstr("1 photograph (light3.jpg)")));
}

TEST(LightAdvice, PhotographsThatAreLeftOutAreNamedWithTheirReason) {
  GuidanceInput input = WholeDome();
  input.left_out.push_back({"dark.jpg", "dirs.lp does not list it"});
  EXPECT_THAT(On(input, "left_out").text,
              HasSubstr("1 of 41 photographs is left out (dark.jpg: dirs.lp does not list it)"));
}

TEST(LightAdvice, WhatIsUsefulGoesBeforeHints) {
  GuidanceInput input = LitFromDirections(testing::LightsOnADome(20, 15, 45));
  const std::vector<Advice> advice = Judge(input).advice;
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].topic, "high_lights");
  EXPECT_EQ(advice[1].topic, "few_lights");
  EXPECT_EQ(Judge(input).Word(), "usable");
}

}  // namespace
}  // namespace glint
