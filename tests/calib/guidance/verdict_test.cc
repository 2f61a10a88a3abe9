// Each sentence of a verdict appears when its cause does, and vanishes with it.
#include "calib/guidance/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "calib/guidance/coverage_picture.h"
#include "calib/guidance/polar_picture.h"
#include "tests/calib/guidance/photo_fixture.h"

namespace glint {
namespace {

using testing::GoodCapture;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::PhotoFrom;

// The sentence on a topic; "": none.
std::string Sentence(const GuidanceInput& input, const std::string& topic) {
  for (const Advice& advice : Judge(input).advice) {
    if (advice.topic == topic) return advice.text;
  }
  return "";
}

void Keep(GuidanceInput* input, const std::string& prefix) {
  std::erase_if(input->photos, [&](const GuidancePhoto& photo) {
    return photo.name.compare(0, prefix.size(), prefix) != 0;
  });
}

void Drop(GuidanceInput* input, const std::string& prefix) {
  std::erase_if(input->photos, [&](const GuidancePhoto& photo) {
    return photo.name.compare(0, prefix.size(), prefix) == 0;
  });
}

TEST(Verdict, NothingIsMissingInAGoodCapture) {
  const Verdict verdict = Judge(GoodCapture());
  EXPECT_EQ(verdict.advice.size(), 0u) << TextOf(verdict);
  EXPECT_EQ(verdict.Word(), "good");
  EXPECT_THAT(verdict.Summary(),
              HasSubstr("12 photographs, 6 within 10° of vertical, tilts 0 to 30°"));
}

TEST(Verdict, TellsThatTheTopViewIsMissing) {
  GuidanceInput input = GoodCapture();
  Drop(&input, "top");
  EXPECT_EQ(Sentence(input, "top"), "");  // those at 9° stand in for it
  Drop(&input, "near");
  EXPECT_THAT(Sentence(input, "top"),
              HasSubstr("no photograph within 10° of vertical (the nearest is 30° off)"));
  EXPECT_EQ(Judge(input).Word(), "usable");
  input.photos.push_back(PhotoFrom(300, 4, 0));
  EXPECT_EQ(Sentence(input, "top"), "");
}

TEST(Verdict, TellsThatTiltedViewsAreMissing) {
  GuidanceInput input = GoodCapture();
  Drop(&input, "side");
  EXPECT_THAT(Sentence(input, "tilted"), HasSubstr("straight down (within 9°)"));
  EXPECT_EQ(Sentence(input, "sides"), "");
  input.photos.push_back(PhotoFrom(300, 30, 0));
  EXPECT_EQ(Sentence(input, "tilted"), "");
}

TEST(Verdict, NamesTheSideThatTiltedViewsLeaveOut) {
  GuidanceInput input = GoodCapture();
  Drop(&input, "side");
  for (const double azimuth : {280.0, 340.0, 40.0})
    input.photos.push_back(PhotoFrom(300, 30, azimuth));
  // From 40° round to 280°, its middle at 160°.
  EXPECT_THAT(Sentence(input, "sides"),
              HasSubstr("no tilted photograph from the left (a gap of 240°"));
  input.photos.push_back(PhotoFrom(300, 30, 160));
  EXPECT_EQ(Sentence(input, "sides"), "");
}

TEST(Verdict, ShowsWhereNoHighlightFallsAndItsAdviceMendsThat) {
  GuidanceInput input = GoodCapture();
  Keep(&input, "side");
  for (const double azimuth : {150.0, 180.0, 210.0})
    input.photos.push_back(PhotoFrom(300, 8, azimuth));
  const Verdict verdict = Judge(input);
  EXPECT_THAT(Sentence(input, "highlight"), HasSubstr("(the right edge) never shows a highlight"));
  EXPECT_THAT(Sentence(input, "highlight"), HasSubstr("toward the right"));
  EXPECT_GT(verdict.highlight_share_then, 0.95);
  for (const Suggestion& one : verdict.suggestions) input.photos.push_back(one.photo);
  EXPECT_EQ(Sentence(input, "highlight"), "");
  EXPECT_NEAR(Judge(input).highlight_share, verdict.highlight_share_then, 1e-9);
}

TEST(Verdict, TellsWhatMorePhotographsBring) {
  GuidanceInput input = GoodCapture();
  input.photos.resize(3);
  EXPECT_THAT(Sentence(input, "few"), HasSubstr("2 more photographs (5 in all)"));
  input.photos = GoodCapture().photos;
  input.photos.pop_back();
  EXPECT_THAT(Sentence(input, "few"), HasSubstr("1 more photograph (12 in all)"));
  EXPECT_EQ(Judge(input).Word(), "good");  // a hint, no more
  EXPECT_EQ(Sentence(GoodCapture(), "few"), "");
}

TEST(Verdict, ASampleThatReachesOverTheBoardIsNotEnough) {
  GuidanceInput input = GoodCapture();
  input.over_board = "15 mm on the left: 1 square";
  const Verdict verdict = Judge(input);
  EXPECT_EQ(verdict.Word(), "not enough");
  EXPECT_EQ(verdict.advice[0].topic, "over_board");
  EXPECT_THAT(verdict.advice[0].text, HasSubstr("15 mm on the left: 1 square"));
}

TEST(Verdict, TellsThatPartOfTheSampleIsInNoPhotograph) {
  GuidanceInput input = GoodCapture();
  for (GuidancePhoto& photo : input.photos) {
    photo.posed->camera_from_sample.translation.x() += 220;  // out of the picture on the right
  }
  EXPECT_THAT(Sentence(input, "unseen"), HasSubstr("is in no photograph"));
  EXPECT_EQ(Judge(input).Word(), "not enough");
  ASSERT_FALSE(Judge(input).advice.empty());
  EXPECT_EQ(Judge(input).advice[0].topic, "unseen");
  input.photos.push_back(PhotoFrom(300, 5, 0));
  EXPECT_EQ(Sentence(input, "unseen"), "");
}

TEST(Verdict, NamesPhotographsThatCutTheSample) {
  GuidanceInput input = GoodCapture();
  EXPECT_EQ(Sentence(input, "cut"), "");
  input.photos[7].posed->camera_from_sample.translation.x() += 200;
  EXPECT_THAT(Sentence(input, "cut"),
              HasSubstr("1 photograph shows only part of the sample: side1.jpg"));
}

TEST(Verdict, TellsThatTexelsAreSmallerThanPixelsAndBothWaysOut) {
  GuidanceInput input = GoodCapture();
  input.resolution_px = {2048, 2048};  // 20.5 texels/mm against 10 pixels/mm
  EXPECT_THAT(Sentence(input, "resolution"), HasSubstr("covers 2.0 texels"));
  EXPECT_THAT(Sentence(input, "resolution"), HasSubstr("as close as 146 mm (now 300)"));
  EXPECT_THAT(Sentence(input, "resolution"), HasSubstr("resolution_px = 1000"));
  input.resolution_px = {1000, 1000};
  EXPECT_EQ(Sentence(input, "resolution"), "");
}

TEST(Verdict, SaysThatPhotographsAreSoftAndHowSmallMapsMayBe) {
  GuidanceInput input = GoodCapture();  // 10 pixels/mm, 100 mm
  input.resolution_px = {1000, 1000};
  for (GuidancePhoto& photo : input.photos) photo.blur_px = 0.6;
  EXPECT_EQ(Sentence(input, "soft"), "");
  for (GuidancePhoto& photo : input.photos) photo.blur_px = 1.45;
  EXPECT_THAT(Sentence(input, "soft"), HasSubstr("blurred by 1.4 px"));
  EXPECT_THAT(Sentence(input, "soft"), HasSubstr("resolution_px = 4"));
  input.photos[0].blur_px = 0.6;  // one sharp photograph is enough for that
  EXPECT_EQ(Sentence(input, "soft"), "");
  for (GuidancePhoto& photo : input.photos) photo.blur_px = 1.45;
  input.resolution_px = {400, 400};
  EXPECT_EQ(Sentence(input, "soft"), "");
  input.resolution_px = {2048, 2048};  // said by "resolution"
  EXPECT_EQ(Sentence(input, "soft"), "");
}

TEST(Verdict, NamesClippedPhotographs) {
  GuidanceInput input = GoodCapture();
  input.photos[2].clipped_share = 0.19;
  EXPECT_EQ(Sentence(input, "clipped"), "");
  input.photos[2].clipped_share = 0.42;
  EXPECT_THAT(Sentence(input, "clipped"),
              HasSubstr("up to 42 % of the sample is clipped in 1 photograph (near1.jpg)"));
}

TEST(Verdict, RepeatsWhyPhotographsAreLeftOut) {
  GuidanceInput input = GoodCapture();
  EXPECT_EQ(Sentence(input, "left_out"), "");
  input.left_out = {{"a.jpg", "blurred"}};
  EXPECT_THAT(Sentence(input, "left_out"),
              HasSubstr("1 of 13 photographs is left out (a.jpg: blurred)"));
  EXPECT_EQ(Judge(input).Word(), "good");
  input.left_out.resize(6, {"b.jpg", "no board"});
  EXPECT_THAT(Sentence(input, "left_out"), HasSubstr("and 4 more"));
  EXPECT_EQ(Judge(input).Word(), "usable");
}

TEST(Verdict, SpeaksOfTheFocalLengthWhereItIsPoorlyKnown) {
  GuidanceInput input = GoodCapture();
  input.focal_sigma = 0.023;
  EXPECT_THAT(Sentence(input, "focal"), HasSubstr("known only to 2.3 %"));
  input.focal_sigma = 0.002;
  EXPECT_EQ(Sentence(input, "focal"), "");
  input.focal_assumed = true;
  EXPECT_THAT(Sentence(input, "focal"), HasSubstr("cannot be determined"));
  EXPECT_EQ(Judge(input).Word(), "not enough");
}

TEST(Verdict, ARectifiedSetIsJudgedByPositionsAlone) {
  GuidanceInput input = GoodCapture();
  for (GuidancePhoto& photo : input.photos) photo.posed.reset();
  EXPECT_EQ(Judge(input).Word(), "good");
  EXPECT_THAT(Judge(input).Summary(), Not(HasSubstr("pixels per texel")));
}

TEST(Verdict, SaysSixLinesAtMostTheMostImportantFirst) {
  GuidanceInput input = GoodCapture();
  input.photos = {PhotoFrom(900, 35, 10), PhotoFrom(900, 33, 20)};
  input.photos[0].clipped_share = 0.5;
  input.left_out = {{"a.jpg", "blurred"}};
  input.focal_assumed = true;
  const Verdict verdict = Judge(input);
  EXPECT_GT(verdict.advice.size(), 6u);
  EXPECT_EQ(verdict.advice[0].topic, "focal");
  const std::string text = TextOf(verdict);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7);
  EXPECT_EQ(ToJson(verdict)["advice"].size(), verdict.advice.size());
  EXPECT_TRUE(std::is_sorted(
      verdict.advice.begin(), verdict.advice.end(), [](const Advice& a, const Advice& b) {
        return static_cast<int>(a.importance) < static_cast<int>(b.importance);
      }));
}

TEST(Pictures, ShowOneDiscAPhotographAndASuggestionWhereThereIsOne) {
  GuidanceInput input = GoodCapture();
  const auto count = [](const std::string& text, const std::string& part) {
    int n = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const std::string good = PolarPictureSvg(Judge(input));
  EXPECT_EQ(count(good, "r=\"8\""), 12);
  EXPECT_EQ(count(good, "<polygon"), 13);  // and one in the legend
  EXPECT_THAT(good, Not(HasSubstr("take one here")));
  EXPECT_THAT(good, Not(HasSubstr("nan")));
  Keep(&input, "side");
  EXPECT_THAT(PolarPictureSvg(Judge(input)), HasSubstr("take one here"));
}

TEST(Pictures, CellsWithoutPhotographAreGreyAndSeenHighlightsBright) {
  GuidanceInput input = GoodCapture();
  input.photos.resize(1);
  input.photos[0].posed->camera_from_sample = testing::LookAt(150, 0, 0, 0, {80, 0});
  const Image image = CoveragePicture(Judge(input));
  const auto at = [&](int x, int y, int c) {
    return image.channel(c)[static_cast<size_t>(y) * image.width + x];
  };
  // Left edge: outside of the picture. Middle: below the phone (that its position says).
  EXPECT_NEAR(at(5, 220, 0), 190 / 255.0, 0.01);
  EXPECT_NEAR(at(5, 220, 2), 190 / 255.0, 0.01);
  EXPECT_GT(at(230, 220, 0), 0.8f);
  EXPECT_GT(at(230, 220, 1), 0.8f);
  EXPECT_LT(at(230, 220, 2), 0.4f);
}

}  // namespace
}  // namespace glint
