#include "pipeline/studio/photographs/advise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint {
namespace {

constexpr double kSample_mm = 100, kDistance_mm = 300;

Capture CaptureWithBoard() {
  Capture capture;
  capture.has_board = true;
  capture.board.squares_x = 13;
  capture.board.squares_y = 17;
  capture.board.square_mm = 15;
  capture.sample_size_mm = {kSample_mm, kSample_mm};
  capture.resolution_px = {1024, 1024};
  return capture;
}

CheckTask TaskWithBoard() {
  CheckTask task;
  task.board = CaptureWithBoard().board;
  task.sample_size_mm = {kSample_mm, kSample_mm};
  return task;
}

// A sharp photograph from there, that looks at the sample's centre.
PhotoCheck CheckFrom(double tilt_deg, double azimuth_deg, double distance_mm, int seed) {
  const double t = tilt_deg * kDegree, a = azimuth_deg * kDegree;
  const Eigen::Vector3d out(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
  const Eigen::Vector3d z = -out;
  const Eigen::Vector3d x = Eigen::Vector3d(0, 1, 0).cross(z).normalized() * -1;
  PosedCamera posed;
  posed.camera = {CameraModel::kSimplePinhole, 4000, 3000, {3000, 2000, 1500}};
  posed.camera_from_sample.rotation.row(0) = x;
  posed.camera_from_sample.rotation.row(1) = z.cross(x);
  posed.camera_from_sample.rotation.row(2) = z;
  posed.camera_from_sample.translation = -(posed.camera_from_sample.rotation * (distance_mm * out));
  PhotoCheck check;
  check.board_found = true;
  GuidancePhoto pose;
  pose.camera_in_sample_mm = distance_mm * out;
  pose.light_in_sample_mm = pose.camera_in_sample_mm + 10 * x;
  pose.posed = posed;
  check.pose = pose;
  check.measures.file.image.width = 4000;
  check.measures.file.image.height = 3000;
  check.measures.corners = 80;
  check.measures.blur_px = check.measures.edge_px = 1.4;
  check.measures.white = 0.8;
  std::mt19937 random(static_cast<unsigned>(seed));
  for (int i = 0; i < 48 * 48; ++i) {
    check.measures.thumbnail.push_back(static_cast<unsigned char>(random()));
  }
  return check;
}

TEST(Advise, TheFirstPhotographIsAskedFromStraightAbove) {
  const StudioAdvice advice = AdviseFor(CaptureWithBoard(), {}, {});
  EXPECT_EQ(advice.verdict, "none");
  ASSERT_TRUE(advice.target);
  EXPECT_EQ(advice.target->tilt_deg, 0);
  EXPECT_FALSE(advice.enough);
}

TEST(Advise, OnePhotographWithoutABoardIsEnough) {
  Capture capture;
  capture.photos = {"photos/a.jpg"};
  EXPECT_FALSE(AdviseFor(capture, {}, {}).enough);
  EXPECT_TRUE(AdviseFor(capture, {{"a.jpg", PhotoCheck()}}, {}).enough);
}

TEST(Advise, ATiltedOneIsAskedFromTheSideThatLacksThem) {
  std::vector<NamedCheck> photos;
  for (int i = 0; i < 3; ++i) {
    photos.push_back({"top" + std::to_string(i), CheckFrom(5, 120 * i, kDistance_mm, i)});
  }
  photos.push_back({"a", CheckFrom(30, -20, kDistance_mm, 3)});
  photos.push_back({"b", CheckFrom(30, 20, kDistance_mm, 4)});
  const StudioAdvice advice = AdviseFor(CaptureWithBoard(), photos, {});
  ASSERT_TRUE(advice.target);
  EXPECT_NEAR(advice.target->azimuth_deg, 180, 5);
  EXPECT_GE(advice.target->tilt_deg, 15);
}

struct Obeyed {
  std::vector<NamedCheck> photos;
  StudioAdvice advice;  // after the last
  Verdict verdict;
};

// Three photographs from anywhere, then as told, within what a hand can do, up to twelve.
Obeyed Obey(int seed, double distance_mm) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> hand_deg(0, 3), round_deg(0, 8), away(0, 0.05);
  std::uniform_real_distribution<double> tilt_deg(0, 40), azimuth_deg(0, 360);
  Obeyed obeyed;
  for (int i = 0; i < 3; ++i) {
    obeyed.photos.push_back({"start" + std::to_string(i),
                             CheckFrom(tilt_deg(random), azimuth_deg(random), distance_mm, i)});
  }
  obeyed.advice = AdviseFor(CaptureWithBoard(), obeyed.photos, {});
  while (!obeyed.advice.enough && obeyed.advice.target && obeyed.photos.size() < 12) {
    const int number = static_cast<int>(obeyed.photos.size());
    obeyed.photos.push_back({"photo" + std::to_string(number),
                             CheckFrom(std::abs(obeyed.advice.target->tilt_deg + hand_deg(random)),
                                       obeyed.advice.target->azimuth_deg + round_deg(random),
                                       distance_mm * (1 + away(random)), number)});
    obeyed.advice = AdviseFor(CaptureWithBoard(), obeyed.photos, {});
  }
  GuidanceInput input;
  input.sample_size_mm = {kSample_mm, kSample_mm};
  input.resolution_px = {1024, 1024};
  for (const NamedCheck& photo : obeyed.photos) input.photos.push_back(*photo.check.pose);
  obeyed.verdict = Judge(input);
  return obeyed;
}

// A photographer who does as told ends with a capture that calib's own guidance calls good,
// whatever the first three photographs were.
TEST(Advise, WhoeverObeysReachesAGoodCaptureWithinTwelve) {
  for (int seed = 0; seed < 10; ++seed) {
    const Obeyed obeyed = Obey(seed, kDistance_mm);
    EXPECT_TRUE(obeyed.advice.enough) << "seed " << seed << ": " << obeyed.advice.sentence;
    EXPECT_EQ(obeyed.advice.verdict, "good") << "seed " << seed;
    const Verdict& verdict = obeyed.verdict;
    EXPECT_GE(verdict.top_views, 3) << "seed " << seed;
    EXPECT_GE(verdict.tilted_views, 5) << "seed " << seed;
    EXPECT_LE(verdict.gap.width_deg, 120) << "seed " << seed;
    EXPECT_GE(verdict.highlight_share, 0.95) << "seed " << seed;
  }
}

// From afar a highlight is small, and to bring one everywhere takes more than twelve photographs:
// those that show relief must not wait for that.
TEST(Advise, HighlightsAndSidesAreAskedForInTurn) {
  for (int seed = 0; seed < 10; ++seed) {
    const Verdict verdict = Obey(seed, 2 * kDistance_mm).verdict;
    EXPECT_GE(verdict.tilted_views, 5) << "seed " << seed;
    EXPECT_LE(verdict.tilted_views, 8) << "seed " << seed;
    EXPECT_LE(verdict.gap.width_deg, 120) << "seed " << seed;
  }
}

std::vector<NamedCheck> FourGood() {
  std::vector<NamedCheck> photos;
  for (int i = 0; i < 4; ++i) {
    photos.push_back({std::to_string(i) + ".jpg", CheckFrom(10 * i, 90 * i, kDistance_mm, i)});
  }
  return photos;
}

TEST(JudgePhotos, GoodOnesAreGood) {
  for (const PhotoVerdict& verdict : JudgePhotos(FourGood(), TaskWithBoard())) {
    EXPECT_EQ(verdict.state, PhotoVerdict::State::kGood) << verdict.reason;
  }
}

TEST(JudgePhotos, BadOnesAreNamedWithReasonAndRemedy) {
  auto photos = FourGood();
  photos[0].check.board_found = false;
  photos[1].check.measures.blur_px = 8;
  photos[2].check.clipped_share = 0.4;
  photos[3].check.unreadable = "cannot be decoded";
  const auto verdicts = JudgePhotos(photos, TaskWithBoard());
  using State = PhotoVerdict::State;
  EXPECT_EQ(verdicts[0].state, State::kBad);
  EXPECT_EQ(verdicts[1].state, State::kBad);
  EXPECT_EQ(verdicts[2].state, State::kWeak);
  EXPECT_EQ(verdicts[3].state, State::kBad);
  for (const PhotoVerdict& verdict : verdicts) {
    EXPECT_FALSE(verdict.reason.empty());
    EXPECT_FALSE(verdict.remedy.empty());
  }
}

TEST(JudgePhotos, AnotherBoardIsSaidOnceAndInPlainWords) {
  PhotoCheck check;
  check.mismatch = true;
  const auto verdicts = JudgePhotos({{"a.jpg", check}}, TaskWithBoard());
  EXPECT_EQ(verdicts[0].state, PhotoVerdict::State::kBad);
  EXPECT_EQ(verdicts[0].reason,
            "It shows another board than the capture's, which has 13 × 17 squares.");
  const auto advice = AdviseFor(CaptureWithBoard(), {}, {{"a.jpg", verdicts[0].reason}});
  EXPECT_NE(advice.sentence.find("choose the board"), std::string::npos) << advice.sentence;
  EXPECT_FALSE(advice.target.has_value());
}

TEST(JudgePhotos, ARepeatedPhotographNamesTheOther) {
  auto photos = FourGood();
  photos[3].check.measures.thumbnail = photos[1].check.measures.thumbnail;
  const auto verdicts = JudgePhotos(photos, TaskWithBoard());
  EXPECT_EQ(verdicts[3].same_as, "1.jpg");
  EXPECT_EQ(verdicts[3].state, PhotoVerdict::State::kBad);
  EXPECT_EQ(verdicts[1].state, PhotoVerdict::State::kGood);
}

TEST(PhotoCheck, AKeptCheckIsReadAgainAsItWas) {
  const PhotoCheck check = CheckFrom(20, 100, kDistance_mm, 1);
  const auto again = PhotoCheckFromJson(Json::parse(ToJson(check).dump()));
  ASSERT_TRUE(again);
  EXPECT_EQ(ToJson(*again), ToJson(check));
  EXPECT_FALSE(PhotoCheckFromJson(Json::parse("{\"unreadable\": 3}")));
  EXPECT_FALSE(PhotoCheckFromJson(Json()));
}

}  // namespace
}  // namespace glint
