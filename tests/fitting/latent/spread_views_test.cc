#include "fitting/latent/spread_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::Le;
using ::testing::SizeIs;

constexpr double kRadian = 3.141592653589793 / 180;

// From above, lit from `tilt_deg` off the normal.
RectifiedView LitFrom(const std::string& name, double tilt_deg, double azimuth_deg) {
  RectifiedView view;
  view.name = name;
  view.view.camera_in_sample_mm = {0, 0, 1000};
  const double side = 800 * std::sin(tilt_deg * kRadian);
  view.view.light_in_sample_mm = {side * std::cos(azimuth_deg * kRadian),
                                  side * std::sin(azimuth_deg * kRadian),
                                  800 * std::cos(tilt_deg * kRadian)};
  return view;
}

std::vector<std::string> ChosenOf(const std::vector<RectifiedView>& views, size_t most) {
  std::vector<std::string> names;
  for (const RectifiedView& view : SpreadViews(views, most)) names.push_back(view.name);
  return names;
}

TEST(SpreadViews, AllAreTakenWhereTheyAreNoMore) {
  const std::vector<RectifiedView> views = {LitFrom("a", 60, 0), LitFrom("b", 10, 0)};
  EXPECT_THAT(ChosenOf(views, 2), ElementsAre("a", "b"));
  EXPECT_THAT(ChosenOf(views, 5), ElementsAre("a", "b"));
  EXPECT_THAT(ChosenOf({}, 5), ElementsAre());
}

TEST(SpreadViews, TheOneNearestToTheNormalIsAmongThem) {
  const std::vector<RectifiedView> views = {LitFrom("a", 60, 0), LitFrom("b", 50, 120),
                                            LitFrom("top", 4, 0), LitFrom("c", 60, 240)};
  EXPECT_THAT(ChosenOf(views, 1), ElementsAre("top"));
  EXPECT_THAT(ChosenOf(views, 3), Contains("top"));
}

TEST(SpreadViews, EachFurtherOneIsFarthestFromThoseThatAreThere) {
  const std::vector<RectifiedView> views = {LitFrom("top", 0, 0), LitFrom("near", 20, 0),
                                            LitFrom("left", 70, 180), LitFrom("right", 60, 0)};
  EXPECT_THAT(ChosenOf(views, 2), ElementsAre("top", "left"));
  EXPECT_THAT(ChosenOf(views, 3), ElementsAre("top", "left", "right"));
}

TEST(SpreadViews, OneOfEachGroupIsTakenInTheirOrder) {
  std::vector<RectifiedView> views;
  for (int i = 0; i < 12; ++i) {
    const int group = i % 4;
    views.push_back(LitFrom(std::string(1, static_cast<char>('a' + group)) + std::to_string(i),
                            group == 0 ? 2 + 0.1 * i : 60, 120 * group + 0.5 * i));
  }
  const std::vector<std::string> names = ChosenOf(views, 4);
  ASSERT_THAT(names, SizeIs(4));
  std::vector<int> at;
  std::string groups;
  for (const std::string& name : names) {
    groups += name[0];
    at.push_back(std::stoi(name.substr(1)));
  }
  EXPECT_TRUE(std::is_sorted(at.begin(), at.end()));
  std::sort(groups.begin(), groups.end());
  EXPECT_EQ(groups, "abcd");
}

TEST(SpreadViews, ViewsThatAreAllAlikeAreNoFault) {
  const std::vector<RectifiedView> views(6, LitFrom("same", 30, 40));
  EXPECT_THAT(ChosenOf(views, 3), AllOf(SizeIs(Ge(1)), SizeIs(Le(3)), Each("same")));
}

}  // namespace
}  // namespace glint
