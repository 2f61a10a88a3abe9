#include "calib/moving_light/lights_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Names = std::vector<std::string>;

class LightsFileTest : public ::testing::Test {
 protected:
  LightsFile Read(const std::string& text, const std::string& unit = "",
                  const std::string& name = "dirs.lp") const {
    return ReadLightsFile(folder_.Write(name, text), unit, kWidth_mm);
  }
  LightsFile ReadDome(const std::string& text) const { return Read(text, "", "lamps.dome"); }
  std::string Complaint(const std::string& text, const std::string& name = "dirs.lp") const {
    return test::MessageOf<UserError>([&] { Read(text, "", name); });
  }
  std::vector<int> Match(const std::string& text, const Names& photos) {
    return MatchLights(Read(text), photos, &remarks_);
  }
  std::string MatchComplaint(const LightsFile& file, const Names& photos) {
    return test::MessageOf<UserError>([&] { MatchLights(file, photos, &remarks_); });
  }

  static constexpr double kWidth_mm = 100;
  test::TemporaryFolder folder_;
  std::vector<std::string> remarks_;
};

void ExpectNear(const Eigen::Vector3d& found, double x, double y, double z) {
  EXPECT_LT((found - Eigen::Vector3d(x, y, z)).norm(), 1e-9) << found.transpose();
}

TEST_F(LightsFileTest, LpListsANameAndADirectionALine) {
  const LightsFile file = Read("2\na.jpg 0.6 0 0.8\nb.jpg 0 -0.6 0.8\n");
  ASSERT_EQ(file.lights.size(), 2u);
  EXPECT_TRUE(file.has_names());
  EXPECT_THAT(file.remarks, IsEmpty());
  EXPECT_EQ(file.lights[1].photo, "b.jpg");
  ExpectNear(file.lights[0].direction, 0.6, 0, 0.8);
  ExpectNear(file.lights[1].direction, 0, -0.6, 0.8);
  EXPECT_FALSE(file.lights[0].position_mm);
}

TEST_F(LightsFileTest, LpMayLackTheCountAndHaveCommentsTabsAndEmptyLines) {
  const LightsFile file = Read("# made by hand\n\na.jpg\t0.6\t0\t0.8\n\nb.jpg, 0, 0, 1\n");
  ASSERT_EQ(file.lights.size(), 2u);
  EXPECT_EQ(file.lights[1].photo, "b.jpg");
  ExpectNear(file.lights[1].direction, 0, 0, 1);
}

TEST_F(LightsFileTest, DecimalCommasAndSignsAreNumbers) {
  const LightsFile file = Read("3\na.jpg +0,6 -0,0 0,8\nb.jpg; 0,6; 0,0; 0,8\nc.jpg,+0.6,0,0.8\n");
  ASSERT_EQ(file.lights.size(), 3u);
  for (const ListedLight& light : file.lights) ExpectNear(light.direction, 0.6, 0, 0.8);
  EXPECT_EQ(file.lights[2].photo, "c.jpg");
}

TEST_F(LightsFileTest, CountBelowZeroIsRefused) {
  EXPECT_THAT(Complaint("-2\na.jpg 0 0 1\nb.jpg 0.6 0 0.8\n"),
              AllOf(HasSubstr("line 1"), HasSubstr("-2 lights announced")));
}

TEST_F(LightsFileTest, ByteOrderMarkAndLinesOfWindowsAreRead) {
  const LightsFile file = Read(
      "\xEF\xBB\xBF"
      "2\r\nC:\\rti\\IMG_1.JPG 0 0 1\r\nIMG_2.JPG 0.6 0 0.8\r\n");
  ASSERT_EQ(file.lights.size(), 2u);
  EXPECT_EQ(file.lights[0].photo, "IMG_1.JPG");
  ExpectNear(file.lights[1].direction, 0.6, 0, 0.8);
}

TEST_F(LightsFileTest, NamesMayHaveSpacesAndNumbers) {
  const LightsFile file = Read("2\n/home/x y/old coin 1 0 0 1\n\"old coin 2.jpg\" 0.6 0 0.8\n");
  EXPECT_EQ(file.lights[0].photo, "old coin 1");
  EXPECT_EQ(file.lights[1].photo, "old coin 2.jpg");
}

TEST_F(LightsFileTest, PositionsAreOfTheUnitThatIsGiven) {
  const LightsFile file = Read("1\na.jpg 30 0 40\n", "cm");
  ASSERT_TRUE(file.lights[0].position_mm);
  ExpectNear(*file.lights[0].position_mm, 300, 0, 400);
  ExpectNear(file.lights[0].direction, 0.6, 0, 0.8);
}

TEST_F(LightsFileTest, LengthsThatAreNotQuiteOneAreRemarkedOn) {
  const LightsFile file = Read("1\na.jpg 0.54 0 0.72\n");
  ExpectNear(file.lights[0].direction, 0.6, 0, 0.8);
  ASSERT_EQ(file.remarks.size(), 1u);
  EXPECT_THAT(file.remarks[0], HasSubstr("10 %"));
}

TEST_F(LightsFileTest, CountThatIsNotThatOfTheLinesIsRefused) {
  EXPECT_THAT(Complaint("3\na.jpg 0 0 1\nb.jpg 0.6 0 0.8\n"),
              HasSubstr("dirs.lp: line 1: found 3 lights announced, 2 listed"));
}

TEST_F(LightsFileTest, LinesThatAreNoVectorAreNamed) {
  EXPECT_THAT(Complaint("2\na.jpg 0 0 1\nb.jpg left up far\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("'b.jpg left up far'")));
  EXPECT_THAT(Complaint("1\na.jpg 0 1\n"), AllOf(HasSubstr("line 2"), HasSubstr("three numbers")));
  EXPECT_THAT(Complaint("1\n0 0 1\n"), AllOf(HasSubstr("line 2"), HasSubstr("name in front")));
  EXPECT_THAT(Complaint("1\na.jpg 0 0 nan\n"), HasSubstr("line 2"));
}

TEST_F(LightsFileTest, VectorWithoutALengthIsRefused) {
  EXPECT_THAT(Complaint("1\na.jpg 0 0 0\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("the vector 0 0 0")));
  EXPECT_THAT(Complaint(R"({"directions": [[0, 0, 0]]})", "lamps.dome"), HasSubstr("light 1"));
}

TEST_F(LightsFileTest, LongVectorsAskForTheirUnit) {
  EXPECT_THAT(Complaint("1\na.jpg 210 0 280\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("length 350"), HasSubstr("unit")));
}

TEST_F(LightsFileTest, UnknownEndingIsToldThoseThatAreKnown) {
  EXPECT_THAT(Complaint("1\na.jpg 0 0 1\n", "lights.txt"),
              AllOf(HasSubstr("'.txt'"), HasSubstr(".lp, .relight or .dome")));
  EXPECT_EQ(Read("1\na.jpg 0 0 1\n", "", "DIRS.LP").lights.size(), 1u);
}

TEST_F(LightsFileTest, FilesWithoutLightsAreRefused) {
  EXPECT_THAT(Complaint(""), HasSubstr("no lights"));
  EXPECT_THAT(Complaint("0\n"), HasSubstr("no lights"));
  EXPECT_THAT(Complaint("{}", "x.relight"), HasSubstr("no lights"));
  EXPECT_THAT(Complaint("[]", "x.dome"), HasSubstr("no lights"));
}

TEST_F(LightsFileTest, RelightProjectsNameTheirImagesAndSkipSome) {
  const LightsFile file = Read(R"({"images": [
    {"filename": "a.jpg", "direction": {"x": 0.6, "y": 0, "z": 0.8}},
    {"filename": "b.jpg", "direction": {"x": 0, "y": 0, "z": 1}, "skip": true},
    {"filename": "sub/c.jpg", "direction": {"x": 0, "y": 0.6, "z": 0.8}}]})",
                               "", "coin.relight");
  ASSERT_EQ(file.lights.size(), 2u);
  EXPECT_EQ(file.lights[0].photo, "a.jpg");
  EXPECT_EQ(file.lights[1].photo, "c.jpg");
  ExpectNear(file.lights[1].direction, 0, 0.6, 0.8);
}

TEST_F(LightsFileTest, RelightImagesWithoutADirectionTakeTheDomes) {
  const LightsFile file = Read(R"({"images": [{"filename": "a.jpg", "skip": true},
    {"filename": "b.jpg"}], "dome": {"directions": [[0, 0, 1], [0.6, 0, 0.8]]}})",
                               "", "x.relight");
  ASSERT_EQ(file.lights.size(), 1u);
  ExpectNear(file.lights[0].direction, 0.6, 0, 0.8);
  EXPECT_THAT(Complaint(R"({"images": [{"filename": "a.jpg"}]})", "x.relight"),
              AllOf(HasSubstr("images[0]"), HasSubstr("no direction")));
  EXPECT_THAT(Complaint(R"({"images": [{"direction": [0, 0, 1]}]})", "x.relight"),
              HasSubstr("images[0].filename"));
}

TEST_F(LightsFileTest, DomesOfPositionsAreScaledByThePicturesWidth) {
  const LightsFile placed = ReadDome(
      R"({"lightConfiguration": "lights3d", "imageWidth": 10, "positions3d": [[30, 0, 40]]})");
  EXPECT_FALSE(placed.has_names());
  ASSERT_TRUE(placed.lights.at(0).position_mm);
  ExpectNear(*placed.lights[0].position_mm, 300, 0, 400);
  const LightsFile sphere = ReadDome(R"({"lightConfiguration": "spherical", "imageWidth": 10,
    "domeDiameter": 20, "verticalOffset": 1, "directions": [[0.6, 0, 0.8]]})");
  ASSERT_TRUE(sphere.lights.at(0).position_mm);
  ExpectNear(*sphere.lights[0].position_mm, 60, 0, 90);
}

TEST_F(LightsFileTest, DomesOfUnknownSizeTellDirectionsAlone) {
  const LightsFile file =
      ReadDome(R"({"lightConfiguration": "lights3d", "positions3d": [[30, 0, 40]]})");
  ExpectNear(file.lights.at(0).direction, 0.6, 0, 0.8);
  EXPECT_FALSE(file.lights[0].position_mm);
}

TEST_F(LightsFileTest, WhatIsNoVectorInADomeIsRefused) {
  EXPECT_THAT(Complaint(R"({"directions": [[0, 0, 1], [0, 1]]})", "lamps.dome"),
              AllOf(HasSubstr("light 2"), HasSubstr("x, y and z")));
  EXPECT_THAT(Complaint(R"({"directions": [{"x": 0, "y": "up", "z": 1}]})", "lamps.dome"),
              HasSubstr("light 1"));
  EXPECT_THAT(Complaint("1\na.jpg 0 0 1\n", "lamps.dome"), HasSubstr("lamps.dome"));
}

TEST_F(LightsFileTest, NamesAreFoundWithoutRegardToCaseOrEnding) {
  EXPECT_THAT(Match("3\nC:\\x\\IMG_3.JPG 0 0 1\nimg_1.tif 0.6 0 0.8\nImg_2.jpg 0 0.6 0.8\n",
                    {"photos/IMG_1.jpg", "photos/IMG_2.jpg", "photos/img_3.jpg"}),
              ElementsAre(1, 2, 0));
  EXPECT_THAT(remarks_, IsEmpty());
}

TEST_F(LightsFileTest, NameWithItsEndingGoesBeforeTheNameWithout) {
  EXPECT_THAT(Match("2\na.tif 0 0 1\na.jpg 0.6 0 0.8\n", {"a.jpg", "a.tif"}), ElementsAre(1, 0));
  EXPECT_THAT(MatchComplaint(Read("1\na.png 0 0 1\n"), {"a.jpg", "a.tif"}),
              AllOf(HasSubstr("a.jpg and a.tif"), HasSubstr("cannot distinguish")));
}

TEST_F(LightsFileTest, PhotographsThatAreNotListedHaveNoLight) {
  EXPECT_THAT(Match("1\nb.jpg 0 0 1\n", {"a.jpg", "b.jpg"}), ElementsAre(-1, 0));
}

TEST_F(LightsFileTest, NamesWithoutAPhotographAreListed) {
  EXPECT_THAT(MatchComplaint(Read("3\na.jpg 0 0 1\nb.jpg 0.6 0 0.8\nc.jpg 0 0.6 0.8\n"),
                             {"a.jpg", "c.jpg", "d.jpg"}),
              HasSubstr("1 of 3 names without a photograph: b.jpg"));
}

TEST_F(LightsFileTest, PhotographsOfOneNameAreRefused) {
  const LightsFile file = Read("1\na.jpg 0 0 1\n");
  EXPECT_THAT(MatchComplaint(file, {"A.jpg", "a.JPG"}), HasSubstr("A.jpg and a.JPG"));
  EXPECT_THAT(MatchComplaint(file, {"x/a.jpg", "y/a.jpg"}), HasSubstr("x/a.jpg and y/a.jpg"));
}

TEST_F(LightsFileTest, TwoLightsOfOnePhotographAreRefused) {
  EXPECT_THAT(MatchComplaint(Read("2\na.jpg 0 0 1\nA.tif 0.6 0 0.8\n"), {"a.jpg"}),
              HasSubstr("two lights of A.tif"));
}

TEST_F(LightsFileTest, OtherNamesAsManyAsPhotographsAreTakenInOrderAndSaidSo) {
  const std::string text = "3\nx1.jpg 0 0 1\nx2.jpg 0.6 0 0.8\nx3.jpg 0 0.6 0.8\n";
  EXPECT_THAT(Match(text, {"a.jpg", "b.jpg", "c.jpg"}), ElementsAre(0, 1, 2));
  ASSERT_EQ(remarks_.size(), 1u);
  EXPECT_THAT(remarks_[0], AllOf(HasSubstr("x1.jpg, x2.jpg and 1 more"), HasSubstr("in order")));
  EXPECT_THAT(MatchComplaint(Read(text), {"a.jpg", "b.jpg"}), HasSubstr("3 of 3 names"));
}

TEST_F(LightsFileTest, LampsWithoutNamesAreTakenInOrderWhereAsManyAsPhotographs) {
  const LightsFile file = ReadDome(R"({"directions": [[0, 0, 1], [0.6, 0, 0.8]]})");
  EXPECT_THAT(MatchLights(file, {"a.jpg", "b.jpg"}, &remarks_), ElementsAre(0, 1));
  EXPECT_THAT(MatchComplaint(file, {"a.jpg", "b.jpg", "c.jpg"}),
              HasSubstr("2 lights without names for 3 photographs"));
}

}  // namespace
}  // namespace glint
