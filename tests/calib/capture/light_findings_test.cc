// Why a photograph is left out by what the board's paper says, and when it is not.
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

}  // namespace
}  // namespace glint
