#include "calib/chart/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "calib/chart/chart_kinds.h"
#include "calib/chart/cielab.h"
#include "calib/chart/delta_e.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ChartKinds, HoldTheColoursThatTheMakerPublished) {
  const Chart classic = *ChartOfKind("classic24");
  ASSERT_EQ(classic.patches.size(), 24u);
  // X-Rite, ColorChecker Classic of before November 2014, L*a*b* under D50.
  const std::pair<const char*, Eigen::Vector3d> published[] = {
      {"A1", {37.986, 13.555, 14.059}},   {"A6", {70.719, -33.397, -0.199}},
      {"B2", {40.020, 10.410, -45.964}},  {"C1", {28.778, 14.179, -50.297}},
      {"C3", {42.101, 53.378, 28.190}},   {"C4", {81.733, 4.039, 79.819}},
      {"C6", {51.038, -28.631, -28.638}}, {"D1", {96.539, -0.425, 1.186}},
      {"D6", {20.461, -0.079, -0.973}}};
  for (const auto& [name, lab] : published) {
    const auto patch =
        std::find_if(classic.patches.begin(), classic.patches.end(),
                     [&, wanted = name](const ChartPatch& p) { return p.name == wanted; });
    ASSERT_NE(patch, classic.patches.end()) << name;
    EXPECT_LT(DeltaE00(patch->lab, lab), 0.1) << name << ": " << patch->lab.transpose();
  }
}

TEST(ChartKinds, AreThoseThatCaptureTomlTakes) {
  ASSERT_EQ(ChartKinds().size(), kFoundCharts.size());
  for (size_t i = 0; i < kFoundCharts.size(); ++i) EXPECT_EQ(ChartKinds()[i].name, kFoundCharts[i]);
}

TEST(ChartKinds, HaveAFrameOfNeutralPatchesRoundTheDigitalSg) {
  const Chart sg = *ChartOfKind("sg140");
  ASSERT_EQ(sg.patches.size(), 140u);
  for (size_t i = 0; i < 140; ++i) {
    const size_t row = i / 14, column = i % 14;
    if (row != 0 && row != 9 && column != 0 && column != 13) continue;
    EXPECT_LT(sg.patches[i].lab.tail<2>().norm(), 2) << sg.patches[i].name;
  }
}

// Where mcc draws the patches of a chart whose box is known.
TEST(ChartKinds, HavePatchesWhereOpenCvHasThem) {
  for (const ChartKind& kind : ChartKinds()) {
    const Chart chart = *ChartOfKind(kind.name);
    const double unit = 2000 / chart.size.x(), margin = unit * kind.margin;
    const float right = static_cast<float>(2 * margin + unit * chart.size.x());
    const float bottom = static_cast<float>(2 * margin + unit * chart.size.y());
    const auto checker = cv::mcc::CChecker::create();
    checker->setTarget(kind.detected_as);
    checker->setBox({{0, 0}, {right, 0}, {right, bottom}, {0, bottom}});
    cv::Mat drawn = cv::Mat::zeros(cv::Size(cvCeil(right) + 2, cvCeil(bottom) + 2), CV_8UC3), green;
    cv::mcc::CCheckerDraw::create(checker, cv::Scalar(0, 255, 0), 1)->draw(drawn);
    cv::extractChannel(drawn, green, 1);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(green, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
    ASSERT_EQ(outlines.size(), chart.patches.size()) << kind.name;
    for (const ChartPatch& patch : chart.patches) {
      double nearest = 1e9;
      for (const auto& outline : outlines) {
        const cv::Rect box = cv::boundingRect(outline);
        const Eigen::Vector2d at(box.x + box.width / 2.0, box.y + box.height / 2.0);
        nearest = std::min(
            nearest,
            (at - (unit * patch.centre).array().matrix() - Eigen::Vector2d(margin, margin)).norm());
      }
      EXPECT_LT(nearest, 0.06 * unit * kind.patch) << kind.name << " " << patch.name;
    }
  }
}

TEST(GreyCard, IsNeutralAndReflectsWhatItSays) {
  const Eigen::Vector3d rgb = Rec709FromLab(GreyCard(0.18).patches[0].lab);
  EXPECT_LT((rgb.array() - 0.18).abs().maxCoeff(), 1e-9);
}

class ChartCsv : public ::testing::Test {
 protected:
  Chart Read(const std::string& text, const std::string& illuminant = "D50") {
    return ReadChartCsv(folder_.Write("chart.csv", text), illuminant, 1.5);
  }
  std::string Complaint(const std::string& text) {
    return test::MessageOf<UserError>([&] { Read(text); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(ChartCsv, HoldsPatchesByPlaceAndColour) {
  const Chart chart =
      Read("\xEF\xBB\xBFname, x,y, L,a,b\nred,0.25,0.5,42,53,28\n\nwhite,0.75,0.5,96,0,1\n");
  ASSERT_EQ(chart.patches.size(), 2u);
  EXPECT_EQ(chart.patches[1].name, "white");
  EXPECT_EQ(chart.patches[0].centre, Eigen::Vector2d(0.375, 0.5));
  EXPECT_DOUBLE_EQ(chart.patches[0].half_side, 0.375);
  EXPECT_EQ(chart.patches[0].lab, Eigen::Vector3d(42, 53, 28));
}

TEST_F(ChartCsv, AdaptsXyzOfAnotherIlluminant) {
  const Chart chart = Read("name,x,y,X,Y,Z\ngrey,0.5,0.5,19.7726,18,6.4053\n", "A");
  EXPECT_LT(chart.patches[0].lab.tail<2>().norm(), 0.05);
  EXPECT_NEAR(chart.patches[0].lab[0], 49.5, 0.1);
}

TEST_F(ChartCsv, IsRefusedByLineAndColumn) {
  EXPECT_THAT(Complaint("name,x,y,L,a\n"), HasSubstr("no column 'b'"));
  EXPECT_THAT(Complaint("name,x,y,L,a,b\nred,0.2,1.5,42,53,28\n"),
              AllOf(HasSubstr("chart.csv"), HasSubstr("line 2, y"), HasSubstr("1.5")));
  EXPECT_THAT(Complaint("name,x,y,X,Y,Z\na,0,0,0.4,0.5,0.4\n"), HasSubstr("Y = 100"));
  EXPECT_THAT(Complaint("name,x,y,L,a,b\na,0.5,0.5,50,0,0\nb,0.5,0.5,60,0,0\n"),
              HasSubstr("two patches at the same position"));
  EXPECT_THAT(Complaint(""), HasSubstr("no table"));
  EXPECT_THAT(Complaint("name,x,y,L,a,b\nr\xE9"
                        "d,0.2,0.5,42,53,28\n"),
              HasSubstr("UTF-8"));
}

}  // namespace
}  // namespace glint
