#include "fitting/refine/gather.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

constexpr std::array<size_t, 5> kTexels = {3, 17, 40, 41, 90};
constexpr std::array<int, 3> kSome = {4, 0, 2};

void ExpectSame(const BatchObservations& a, const BatchObservations& b) {
  ASSERT_EQ(a.views(), b.views());
  const size_t rows = static_cast<size_t>(a.views()) * BatchObservations::kPlanes;
  EXPECT_EQ(std::memcmp(a.rows(), b.rows(), rows * sizeof(BatchRow)), 0);
  for (int lane = 0; lane < kBatch; ++lane) EXPECT_EQ(a.seen(lane), b.seen(lane));
}

class Gathered : public testing::Test {
 protected:
  Gathered() {
    for (int texel : {3, 40}) scene_.masks[2][static_cast<size_t>(texel)] = 0;
    problem_ = scene_.Problem();
  }
  BatchObservations Anew(std::span<const size_t> texels) const {
    BatchObservations observations(static_cast<int>(problem_.views.size()));
    GatherObservations(problem_, scene_.truth, texels, kSome, &observations);
    return observations;
  }
  test::SyntheticScene scene_ = test::Photograph(test::QuarteredMaps(10, 3), 5, 8);
  RefineProblem problem_;
  BatchObservations buffer_{5};
};

TEST_F(Gathered, ObservationsThatWereKeptAreThoseOfTheirViews) {
  GatheredObservations gathered(problem_, scene_.truth);
  const BatchObservations& kept = gathered.Of(kTexels, kSome, &buffer_);
  ExpectSame(kept, Anew(kTexels));
  // Other texels with the same first one.
  const auto fewer = std::span(kTexels).first(2);
  ExpectSame(gathered.Of(fewer, kSome, &buffer_), Anew(fewer));
  EXPECT_EQ(&gathered.Of(kTexels, kSome, &buffer_), &kept);
}

TEST_F(Gathered, ForgottenOnesAreGatheredFromTheViewsAsTheyAreNow) {
  GatheredObservations gathered(problem_, scene_.truth);
  gathered.Of(kTexels, kSome, &buffer_);
  problem_.views[0].view.exposure *= 1.5;
  gathered.Forget();
  ExpectSame(gathered.Of(kTexels, kSome, &buffer_), Anew(kTexels));
}

}  // namespace
}  // namespace glint
