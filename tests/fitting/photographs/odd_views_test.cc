#include "fitting/photographs/odd_views.h"

#include <gtest/gtest.h>

#include <limits>

namespace glint {
namespace {

using Indices = std::vector<size_t>;

TEST(OddViews, OnesThatAreExplainedMuchWorseThanMost) {
  EXPECT_EQ(OddViews({0.03, 0.35, 0.02, 0.04, 0.03}, 2), Indices{1});
  EXPECT_EQ(OddViews({0.03, 0.35, 0.02, 0.04, 0.03, 0.09}, 2), (Indices{1, 5}));
  EXPECT_EQ(OddViews({0.03, 0.35, 0.02, 0.04, 0.03, 0.09}, 4), Indices{1});
}

TEST(OddViews, NoneWhereAllAreExplainedAlike) {
  EXPECT_EQ(OddViews({0.38, 0.50, 0.31, 0.29}, 2), Indices{});
  EXPECT_EQ(OddViews({0, 0, 0, 0}, 2), Indices{});
  EXPECT_EQ(OddViews({0.004, 0.004, 0.03, 0.004}, 2), Indices{});  // all of them well
}

TEST(OddViews, NoneOfTooFewToTell) {
  EXPECT_EQ(OddViews({0.03, 0.35, 0.02}, 2), Indices{});
  const double masked = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(OddViews({0.03, masked, 0.35, 0.02}, 2), Indices{});
  EXPECT_EQ(OddViews({0.03, masked, 0.35, 0.02, 0.03}, 2), Indices{2});
}

}  // namespace
}  // namespace glint
