// capture.toml of a camera that stands still while the light moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class FixedCameraCapture : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.Write("a.jpg", "x");
    folder_.Write("b.jpg", "x");
    folder_.Write("dirs.lp", "x");
  }
  // With these lines in front of all tables and these tables at the end.
  Capture Read(const std::string& kind, const std::string& tables) {
    folder_.Write("capture.toml", kind +
                                      "\n[sample]\nsize_mm = [100, 50]\nresolution_px = 512\n"
                                      "[photos]\nfiles = [\"*.jpg\"]\n" +
                                      tables);
    return ReadCapture(folder_.path());
  }
  Capture Lit(const std::string& lights) { return Read(kFixed, "[lights]\n" + lights); }
  std::string Complaint(const std::string& kind, const std::string& tables) {
    return test::MessageOf<UserError>([&] { Read(kind, tables); });
  }
  std::string LightsComplaint(const std::string& lights) {
    return Complaint(kFixed, "[lights]\n" + lights);
  }

  static constexpr char kFixed[] = "kind = \"fixed camera\"";
  static constexpr char kBoard[] =
      "[board]\nkind = \"charuco\"\nsquares = [12, 10]\nsquare_mm = 15\nmarker_mm = 11\n"
      "window = [3, 3, 6, 4]\n";
  test::TemporaryFolder folder_;
};

TEST_F(FixedCameraCapture, ReadsWhatItsLightsTableSays) {
  const Capture capture =
      Lit("file = \"dirs.lp\"\nunit = \"cm\"\ndistance_mm = 700\ncamera_mm = 900\n"
          "[poses]\npicture_width_mm = 120\n");
  EXPECT_TRUE(capture.fixed_camera());
  EXPECT_FALSE(capture.has_board);
  EXPECT_EQ(capture.lights.file, "dirs.lp");
  EXPECT_EQ(capture.lights.unit, "cm");
  EXPECT_EQ(capture.lights.distance_mm, 700);
  EXPECT_EQ(capture.lights.camera_mm, 900);
  EXPECT_EQ(capture.poses.picture_width_mm, 120);
  EXPECT_THAT(capture.lights.balls_px, IsEmpty());
}

TEST_F(FixedCameraCapture, DistancesThatNobodyToldAreNotKnown) {
  const Capture capture = Lit("file = \"dirs.lp\"");
  EXPECT_EQ(capture.lights.unit, "");
  EXPECT_EQ(capture.lights.distance_mm, 0);
  EXPECT_EQ(capture.lights.camera_mm, 0);
}

TEST_F(FixedCameraCapture, OneBallOrTwoAreThreePointsEach) {
  EXPECT_THAT(Lit("balls_px = [[1, 2], [3, 4], [5, 6.5]]").lights.balls_px,
              ElementsAre(1, 2, 3, 4, 5, 6.5));
  EXPECT_THAT(
      Lit("balls_px = [[[1, 2], [3, 4], [5, 6]], [[7, 8], [9, 10], [11, 12]]]").lights.balls_px,
      ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
  EXPECT_THAT(Lit("balls_px = [[[1, 2], [3, 4], [5, 6]]]").lights.balls_px,
              ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(FixedCameraCapture, OtherShapesOfBallsAreRefused) {
  for (const std::string balls :
       {"[]", "7", "[[1, 2], [3, 4]]", "[[1, 2], [3, 4], [5]]", "[[1, 2], [3, 4], [5, \"six\"]]",
        "[[[1, 2], [3, 4]]]", "[[], [], []]", "[1, 2, 3, 4, 5, 6]",
        "[[[1,2],[3,4],[5,6]], [[1,2],[3,4],[5,6]], [[1,2],[3,4],[5,6]]]"}) {
    EXPECT_THAT(LightsComplaint("balls_px = " + balls),
                AllOf(HasSubstr("lights.balls_px"), HasSubstr("three points")))
        << balls;
  }
}

TEST_F(FixedCameraCapture, AFileOrBallsAreGivenAndNotBoth) {
  EXPECT_THAT(LightsComplaint("file = \"dirs.lp\"\nballs_px = [[1, 2], [3, 4], [5, 6]]"),
              AllOf(HasSubstr("lights: found both file and balls_px"), HasSubstr("dirs.lp")));
  EXPECT_THAT(LightsComplaint("distance_mm = 700"), HasSubstr("neither file nor balls_px"));
  EXPECT_THAT(Complaint(kFixed, ""), HasSubstr("neither file nor balls_px"));
}

TEST_F(FixedCameraCapture, LightsWithoutTheKindAreRefused) {
  EXPECT_THAT(Complaint("", "[lights]\nfile = \"dirs.lp\"\n[poses]\npicture_width_mm = 120\n"),
              AllOf(HasSubstr("lights"), HasSubstr("kind = \"fixed camera\"")));
  EXPECT_THAT(
      Complaint("kind = \"moved camera\"", std::string(kBoard) + "[lights]\nfile = \"dirs.lp\""),
      HasSubstr("kind = \"fixed camera\""));
}

TEST_F(FixedCameraCapture, BoardBesideTheKindIsRefused) {
  EXPECT_THAT(Complaint(kFixed, std::string(kBoard) + "[lights]\nfile = \"dirs.lp\""),
              AllOf(HasSubstr("board"), HasSubstr("kind = \"fixed camera\"")));
}

TEST_F(FixedCameraCapture, KindIsOneOfTwo) {
  EXPECT_FALSE(Read("kind = \"moved camera\"", kBoard).fixed_camera());
  EXPECT_FALSE(Read("", kBoard).fixed_camera());
  EXPECT_THAT(Complaint("kind = \"dome\"", kBoard),
              AllOf(HasSubstr("kind"), HasSubstr("'dome'"), HasSubstr("moved camera"),
                    HasSubstr("fixed camera")));
  EXPECT_THAT(Complaint("kind = 3", kBoard), HasSubstr("kind"));
}

TEST_F(FixedCameraCapture, WrongLightsAreNamed) {
  EXPECT_THAT(LightsComplaint("file = \"gone.lp\""),
              AllOf(HasSubstr("lights.file"), HasSubstr("gone.lp")));
  EXPECT_THAT(LightsComplaint("file = \"../dirs.lp\""), HasSubstr("lights.file"));
  EXPECT_THAT(LightsComplaint("file = \"dirs.lp\"\nunit = \"inch\""),
              AllOf(HasSubstr("lights.unit"), HasSubstr("'inch'")));
  EXPECT_THAT(LightsComplaint("file = \"dirs.lp\"\ndistance_mm = 0"),
              HasSubstr("lights.distance_mm"));
  EXPECT_THAT(LightsComplaint("file = \"dirs.lp\"\ncamera_mm = -1"), HasSubstr("lights.camera_mm"));
  EXPECT_THAT(LightsComplaint("file = \"dirs.lp\"\ndistance = 700"), HasSubstr("lights.distance"));
}

}  // namespace
}  // namespace glint
