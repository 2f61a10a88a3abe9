// What the paper and the corners contradict, in words.
#include "calib/capture/light_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glint {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Contradiction : public ::testing::Test {
 protected:
  Contradiction() {
    for (int i = 0; i < 5; ++i) {
      LightOfPhoto& photo = light_.photos.emplace_back();
      photo.used = true;
      photo.exif_exposure = 1;
      photo.samples = photo.inliers = 1000;
    }
  }
  std::string Reason(bool flash_off = false) const {
    return ContradictionOf(light_, light_.photos[2], flash_off);
  }
  LightOfPhoto& photo() { return light_.photos[2]; }
  void Contradict(double factor, double zoom = 1) {
    photo().contradicts = true;
    photo().used = false;
    photo().exposure.value = factor;
    photo().zoom = zoom;
  }

  LightEstimate light_;
};

TEST_F(Contradiction, APhotographLikeTheOthersStays) { EXPECT_EQ(Reason(), ""); }

TEST_F(Contradiction, PaperThatNoFlashLitLeaves) {
  photo().inliers = 200;
  photo().unlit = 800;
  EXPECT_THAT(Reason(), HasSubstr("only 20 % of its white paper is lit"));
}

TEST_F(Contradiction, PaperThatIsNearlyClippedIsLit) {
  photo().inliers = 200;
  EXPECT_EQ(Reason(), "");
}

TEST_F(Contradiction, AnotherPowerStaysAndAZoomLeaves) {
  Contradict(0.8);
  EXPECT_EQ(Reason(), "");
  Contradict(0.59, 1.3);
  EXPECT_THAT(Reason(), HasSubstr("a zoom of about 1.3"));
}

TEST_F(Contradiction, AMissingFlashIsNamed) {
  Contradict(0.08, 3.5);
  EXPECT_THAT(Reason(), HasSubstr("the flash did not fire"));
  EXPECT_THAT(Reason(), Not(HasSubstr("zoom")));
  Contradict(0.5);
  EXPECT_EQ(Reason(), "");
  EXPECT_THAT(Reason(true), HasSubstr("the flash did not fire, as EXIF reports"));
}

std::vector<std::string> FindingsUnder(const std::array<double, 3>& power_rgb) {
  CalibSummary summary;
  summary.light.known = true;
  for (size_t c = 0; c < 3; ++c) summary.light.power_rgb[c].value = power_rgb[c];
  return LightFindings({}, summary);
}

TEST(LightFindings, TintedPaperIsNamedAndAFaintCastIsNot) {
  EXPECT_TRUE(FindingsUnder({1e5, 0.95e5, 0.9e5}).empty());
  const std::vector<std::string> words = FindingsUnder({1.33e5, 1e5, 0.66e5});
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("red, green and blue as 1.33 : 1 : 0.66"));
  EXPECT_THAT(words[0], HasSubstr("white paper"));
}

TEST(Misfit, IsNamedWhereItMovesTexels) {
  CrossValidation validation;
  EXPECT_EQ(MisfitInWords(validation), "");
  CameraDifference& camera = validation.cameras.emplace_back();
  camera.rms_px = 0.47;
  camera.predicted_px = 0.034;
  EXPECT_THAT(MisfitInWords(validation), HasSubstr("differ by 0.47 px where noise predicts 0.034"));
  EXPECT_THAT(MisfitInWords(validation), HasSubstr("stabilisation"));
  camera.predicted_px = 0.4;  // noise explains it
  EXPECT_EQ(MisfitInWords(validation), "");
  camera.rms_px = 0.15;
  camera.predicted_px = 0.01;  // no texel is moved
  EXPECT_EQ(MisfitInWords(validation), "");
}

}  // namespace
}  // namespace glint
