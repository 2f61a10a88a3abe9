#include "training/loss_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/process.h"
#include "training/random.h"

namespace glint {
namespace {

// A training's loss: it falls, and batches differ.
double Falling(int i, Stream* random) {
  return (0.4 + 0.5 * std::exp(-i / 40.0)) * std::exp(0.04 * random->Normal());
}

TEST(LossWatch, StaysCalmWhileALossFallsWithNoise) {
  Stream random(1);
  LossWatch watch;
  for (int i = 0; i < 500; ++i) {
    EXPECT_EQ(watch.Judge(Falling(i, &random)), LossVerdict::kCalm) << i;
  }
}

TEST(LossWatch, KnowsAJumpAtOnceAndAClimbAtItsSecondLoss) {
  for (const double factor : {4.0, 1.5}) {
    Stream random(2);
    LossWatch watch;
    for (int i = 0; i < 100; ++i) watch.Judge(Falling(i, &random));
    LossVerdict verdict = watch.Judge(factor * Falling(100, &random));
    if (factor < 2) {
      EXPECT_EQ(verdict, LossVerdict::kSuspicious);
      verdict = watch.Judge(factor * Falling(101, &random));
    }
    EXPECT_EQ(verdict, LossVerdict::kJumped);
    watch.Calm();
    EXPECT_EQ(watch.Judge(Falling(102, &random)), LossVerdict::kCalm);
  }
}

// Of few steps each, losses scatter by a third; they stay up after a jump alone.
TEST(LossWatch, KnowsAJumpThatIsWithinTheScatter) {
  Stream random(3);
  LossWatch watch;
  const auto loss = [&](double level) { return level * std::exp(0.35 * random.Normal()); };
  int jumps = 0;
  for (int i = 0; i < 400; ++i) jumps += watch.Judge(loss(0.4)) == LossVerdict::kJumped;
  EXPECT_EQ(jumps, 0);
  int until = 1;
  while (watch.Judge(loss(1.4)) != LossVerdict::kJumped && until < 100) ++until;
  EXPECT_LE(until, 8);
}

TEST(LossWatch, TakesWhatIsNotFiniteForAJump) {
  LossWatch watch;
  EXPECT_EQ(watch.Judge(std::numeric_limits<double>::quiet_NaN()), LossVerdict::kJumped);
  EXPECT_EQ(watch.Judge(std::numeric_limits<double>::infinity()), LossVerdict::kJumped);
}

TEST(LossWatch, RemembersTheLevelFromALog) {
  const test::TemporaryFolder folder;
  std::string log = "step,seconds,loss,map,smoothness,render,validation\n";
  for (int i = 0; i < 20; ++i) log += std::to_string(i) + ",1,0.1,0.2,0,0.3,\n";
  LossWatch watch;
  watch.Remember(folder.Write("loss.csv", log));
  EXPECT_EQ(watch.Judge(2.5), LossVerdict::kJumped);
  EXPECT_EQ(watch.Judge(0.51), LossVerdict::kCalm);
}

}  // namespace
}  // namespace glint
