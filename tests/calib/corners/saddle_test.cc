#include "calib/corners/saddle.h"

#include <gtest/gtest.h>

#include <cmath>

namespace glint {
namespace {

// A blurred corner by the model's own formula, after a tone curve.
GrayImage Corner(double cx, double cy, double turn1, double turn2, double blur) {
  GrayImage image{41, 41, std::vector<unsigned char>(41 * 41)};
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      const double dx = x + 0.5 - cx, dy = y + 0.5 - cy;
      const double d1 = std::cos(turn1) * dx + std::sin(turn1) * dy;
      const double d2 = std::cos(turn2) * dx + std::sin(turn2) * dy;
      const double s = 1 / (std::sqrt(2.0) * blur);
      const double linear = 0.4 - 0.35 * std::erf(d1 * s) * std::erf(d2 * s);
      image.samples[y * 41 + x] = static_cast<unsigned char>(255 * std::pow(linear, 1 / 2.2) + 0.5);
    }
  }
  return image;
}

SaddleGuess Guess(double turn1, double turn2) {
  SaddleGuess guess;
  guess.centre_px = {20, 20};
  guess.column_px = 30 * Eigen::Vector2d(std::sin(turn2), -std::cos(turn2));
  guess.row_px = 30 * Eigen::Vector2d(-std::sin(turn1), std::cos(turn1));
  return guess;
}

TEST(FitSaddle, FindsTheCentreWhateverBlurSkewAndToneCurve) {
  for (const double blur : {0.6, 1.2, 2.5}) {
    for (const double skew : {-0.3, 0.0, 0.4}) {
      const GrayImage image = Corner(21.3, 19.2, 0.2, 0.2 + M_PI / 2 + skew, blur);
      const SaddleFit fit = FitSaddle(image, Guess(0.2, 0.2 + M_PI / 2 + skew), {});
      ASSERT_TRUE(fit.ok) << blur << " " << skew;
      EXPECT_NEAR(fit.centre_px.x(), 21.3, 0.02) << blur << " " << skew;
      EXPECT_NEAR(fit.centre_px.y(), 19.2, 0.02) << blur << " " << skew;
    }
  }
}

TEST(FitSaddle, RefusesAnInvertedCorner) {
  SaddleGuess guess = Guess(0, M_PI / 2);
  const GrayImage image = Corner(20.4, 20.1, 0, M_PI / 2, 1);
  EXPECT_TRUE(FitSaddle(image, guess, {}).ok);
  guess.top_left_is_black = false;
  EXPECT_FALSE(FitSaddle(image, guess, {}).ok);
}

TEST(FitSaddle, RefusesACornerThatIsPartlyHidden) {
  for (int hidden = 14; hidden <= 24; hidden += 2) {
    GrayImage image = Corner(20.4, 20.1, 0, M_PI / 2, 1);
    for (int y = 0; y < 41; ++y) {
      for (int x = 0; x < hidden; ++x) image.samples[y * 41 + x] = 140;
    }
    EXPECT_FALSE(FitSaddle(image, Guess(0, M_PI / 2), {}).ok) << "hidden left of " << hidden;
  }
}

TEST(FitSaddle, RefusesEdgesFlatAreasAndNonsense) {
  GrayImage flat{41, 41, std::vector<unsigned char>(41 * 41, 128)};
  EXPECT_FALSE(FitSaddle(flat, Guess(0, M_PI / 2), {}).ok);
  GrayImage edge = flat;
  for (int y = 0; y < 41; ++y) {
    for (int x = 20; x < 41; ++x) edge.samples[y * 41 + x] = 20;
  }
  EXPECT_FALSE(FitSaddle(edge, Guess(0, M_PI / 2), {}).ok);
  SaddleGuess guess = Guess(0, M_PI / 2);
  guess.centre_px = {std::nan(""), 0};
  EXPECT_FALSE(FitSaddle(flat, guess, {}).ok);
  guess.centre_px = {-500, 1e9};
  EXPECT_FALSE(FitSaddle(flat, guess, {}).ok);
  guess = Guess(0, 0);  // edges that run the same way
  EXPECT_FALSE(FitSaddle(flat, guess, {}).ok);
}

}  // namespace
}  // namespace glint
