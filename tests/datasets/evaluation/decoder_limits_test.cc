#include "datasets/evaluation/decoder_limits.h"

#include <gtest/gtest.h>

#include "datasets/procedural/material.h"

namespace glint {
namespace {

class Limits : public testing::Test {
 protected:
  const SvbrdfMaps truth_ = MakeMaterial(12, 32, 32);
  const Autoencoder network_ = Autoencoder::Random({8, 8, 12, 16, 24}, 1);
};

TEST_F(Limits, ACodeFittedToTheMapsIsBetterThanTheEncodedOne) {
  const LimitFigures encoded = MeasureAgainst(EncodedAndDecoded(network_, truth_, 1), truth_, 1);
  const LimitFigures fitted = MeasureAgainst(CodeFittedToMaps(network_, truth_, 200, 1), truth_, 1);
  EXPECT_LT(fitted.errors.maps.average(), 0.95 * encoded.errors.maps.average());
}

TEST_F(Limits, NoStepsLeaveTheEncodedCode) {
  EXPECT_EQ(CodeFittedToMaps(network_, truth_, 0, 1).planes,
            EncodedAndDecoded(network_, truth_, 1).planes);
}

}  // namespace
}  // namespace glint
