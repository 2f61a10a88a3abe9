#include "fitting/refine/substances.h"
#include "base/model/substances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace glint {
namespace {

// Three planes of two colours, in stripes.
std::vector<float> Stripes(size_t texels) {
  std::vector<float> colour(3 * texels);
  for (size_t t = 0; t < texels; ++t) {
    const bool red = t % 10 < 5;
    colour[t] = red ? 0.5f : 0.05f;
    colour[texels + t] = 0.1f;
    colour[2 * texels + t] = red ? 0.05f : 0.4f;
  }
  return colour;
}

TexelLooks Looks(std::vector<float> colour) {
  const size_t texels = colour.size() / 3;
  return {std::move(colour), std::vector<float>(texels, 0.0f)};
}

TEST(Substances, TexelsOfOneColourAreOneSubstanceWhereverTheyLie) {
  const Substances substances(Looks(Stripes(1000)), 4, true);
  ASSERT_EQ(substances.count(), 2);  // no more colours than there are
  const std::vector<float> shares = substances.SharesOf(Looks(Stripes(1000)));
  for (const size_t t : {10u, 503u, 990u}) {
    for (size_t k = 0; k < 2; ++k) {
      EXPECT_FLOAT_EQ(shares[2 * t + k], shares[(t % 10 < 5 ? 0 : 10) + k]);
    }
  }
  EXPECT_GT(std::abs(shares[0] - shares[10]), 0.99f);
}

TEST(Substances, SharesSumToOneAndDoNotChangeWithBrightnessOfLight) {
  std::vector<float> colour = Stripes(1000);
  const Substances substances_before(Looks(colour), 4, true);
  const std::vector<float> before = substances_before.SharesOf(Looks(colour));
  for (float& c : colour) c *= 1.5f;
  const std::vector<float> after = Substances(Looks(colour), 4, true).SharesOf(Looks(colour));
  const auto count = static_cast<size_t>(substances_before.count());
  for (size_t t = 0; t < 1000; ++t) {
    float sum = 0;
    float alike_before = 0, alike_after = 0;  // with the first texel
    for (size_t k = 0; k < count; ++k) {
      sum += before[count * t + k];
      alike_before += before[count * t + k] * before[k];
      alike_after += after[count * t + k] * after[k];
    }
    EXPECT_NEAR(sum, 1, 1e-5f);
    EXPECT_NEAR(alike_before, alike_after, 1e-3f);
  }
}

TEST(Substances, TexelsOfOneColourAndAnotherGlossAreAnother) {
  TexelLooks looks{std::vector<float>(3 * 1000, 0.2f), {}};
  for (int t = 0; t < 1000; ++t) looks.gloss.push_back(t % 10 == 0 ? -0.5f : 0.05f);
  EXPECT_EQ(Substances(looks, 4, false).count(), 1);
  const Substances substances(looks, 4, true);
  ASSERT_EQ(substances.count(), 2);
  const std::vector<float> shares = substances.SharesOf(looks);
  EXPECT_GT(std::abs(shares[0] - shares[2]), 0.9f);
  EXPECT_EQ(shares[0], shares[20]);
}

// Dielectrics have no colour, however little photographs say of it; metals have one.
TEST(UpdateMeans, SubstancesThatReflectFewPerCentAreExpectedToBeColourless) {
  const std::vector<float> shares(1000, 1.0f);
  const auto chroma = [&](double grey, double colour) {
    SubstanceMeans means;
    const SharedValues seen = {(1 + colour) * grey, grey, (1 - colour) * grey, 0.3, 0.2, 0.2, 0.2};
    means.mean.assign(1, seen);
    for (int round = 0; round < 20; ++round) {
      std::vector<SubstanceSample> samples;
      for (size_t t = 0; t < shares.size(); ++t) {
        SubstanceSample sample;
        sample.shares = &shares[t];
        // Photographs say a tenth of what the substance does.
        sample.value = means.mean[0];
        const SharedValues variances = means.Variances(sample.value);
        for (size_t p = 0; p < kShared; ++p) {
          if (!std::isfinite(variances[p])) continue;
          sample.covariance[(kShared + 1) * p] = 0.9 * variances[p];
          sample.value[p] += 0.1 * (seen[p] - sample.value[p]);
        }
        samples.push_back(sample);
      }
      UpdateMeans(samples, {0.1, 0.1}, &means);
    }
    const SharedValues& m = means.mean[0];
    return (m[0] - m[2]) / (m[0] + m[1] + m[2]);
  };
  EXPECT_LT(chroma(0.04, 0.1), 0.025);
  EXPECT_GT(chroma(0.6, 0.5), 0.2);
}

// Texels that know their values to `noise`, of two substances.
std::vector<SubstanceSample> Samples(const std::vector<float>& shares, double noise,
                                     const SubstanceMeans& prior, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<SubstanceSample> samples;
  for (size_t t = 0; t < 1000; ++t) {
    const bool first = t % 10 < 5;
    SubstanceSample sample;
    sample.shares = shares.data() + 2 * t;
    const SharedValues mean = prior.Of(sample.shares), variances = prior.Variances(mean);
    const SharedValues truth = first ? SharedValues{0.3, 0.2, 0.1, 0.3, 0.1, 0.1, 0.1}
                                     : SharedValues{0.04, 0.04, 0.04, 0.6, 0.5, 0.4, 0.3};
    for (size_t p = 0; p < kShared; ++p) {
      if (!std::isfinite(variances[p])) continue;  // not shared
      // The posterior mean and covariance of an observation under the prior.
      const double seen = truth[p] + noise * normal(random);
      const double weight = variances[p] / (variances[p] + noise * noise);
      sample.value[p] = mean[p] + weight * (seen - mean[p]);
      sample.covariance[(kShared + 1) * p] = weight * noise * noise;
    }
    samples.push_back(sample);
  }
  return samples;
}

TEST(UpdateMeans, FindsEachSubstanceHoweverLittleATexelKnows) {
  const std::vector<float> shares =
      Substances(Looks(Stripes(1000)), 2, true).SharesOf(Looks(Stripes(1000)));
  for (const double noise : {0.02, 0.3}) {
    SubstanceMeans means;
    means.diffuse_spread = constants::kDiffuseSd;
    means.mean.assign(2, {0.1, 0.1, 0.1, 0.45, 0.2, 0.2, 0.2});
    for (int round = 0; round < 12; ++round) {
      UpdateMeans(Samples(shares, noise, means), {1, 1}, &means);
    }
    const SharedValues first = means.Of(shares.data());
    const SharedValues second = means.Of(shares.data() + 2 * 5);
    EXPECT_NEAR(first[3], 0.3, 0.05) << noise;
    EXPECT_NEAR(second[3], 0.6, 0.05) << noise;
    EXPECT_NEAR(first[0], 0.3, 0.06) << noise;
    EXPECT_NEAR(second[0], 0.04, 0.04) << noise;
    EXPECT_NEAR(first[4], 0.1, 0.06) << noise;
    EXPECT_NEAR(second[4], 0.5, 0.06) << noise;
  }
}

TEST(UpdateMeans, SubstancesThatLittleIsKnownOfStayTogether) {
  const std::vector<float> shares =
      Substances(Looks(Stripes(1000)), 2, true).SharesOf(Looks(Stripes(1000)));
  SubstanceMeans means;
  means.mean.assign(2, {0.1, 0.1, 0.1, 0.45});
  for (int round = 0; round < 12; ++round) {
    UpdateMeans(Samples(shares, 0.3, means), {1e-4, 1e-4}, &means);
  }
  EXPECT_LT(std::abs(means.mean[0][3] - means.mean[1][3]), 0.15);
}

// Two substances that all texels share about alike, and whose roughness texels know well.
std::vector<SubstanceSample> MixedSamples(const std::vector<float>& shares,
                                          const SubstanceMeans& prior) {
  std::vector<SubstanceSample> samples;
  for (size_t t = 0; t < shares.size() / 2; ++t) {
    SubstanceSample sample;
    sample.shares = shares.data() + 2 * t;
    const SharedValues mean = prior.Of(sample.shares), variances = prior.Variances(mean);
    sample.value = mean;
    for (size_t p = 0; p < 3; ++p) sample.covariance[(kShared + 1) * p] = variances[p];
    sample.value[3] = 0.055 - 0.5 * (sample.shares[0] - 0.575);  // as if the first had −.16
    sample.covariance[(kShared + 1) * 3] = 1e-6;
    samples.push_back(sample);
  }
  return samples;
}

TEST(UpdateMeans, RoughnessThatIsHeldStaysAndAllElseIsFound) {
  const std::vector<float> shares =
      Substances(Looks(Stripes(1000)), 2, true).SharesOf(Looks(Stripes(1000)));
  SubstanceMeans means;
  means.diffuse_spread = constants::kDiffuseSd;
  means.holds_roughness = true;
  means.mean.assign(2, {0.1, 0.1, 0.1, 0.5, 0.2, 0.2, 0.2});
  for (int round = 0; round < 12; ++round)
    UpdateMeans(Samples(shares, 0.02, means), {1, 1}, &means);
  for (const SharedValues& mean : means.mean) EXPECT_EQ(mean[kSharedRoughness], 0.5);
  // Off by half of what the levels are apart, over √12, all alike.
  const auto covariance = [&](size_t a, size_t b) {
    return means.covariance[(kShared * a + kSharedRoughness) * 2 * kShared + kShared * b +
                            kSharedRoughness];
  };
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.5 * std::log(2) / 2 / std::sqrt(12), 1e-3);
  EXPECT_NEAR(covariance(0, 1), covariance(0, 0), 1e-9);
  EXPECT_NEAR(means.Of(shares.data())[4], 0.1, 0.06);
  EXPECT_NEAR(means.Of(shares.data() + 2 * 5)[4], 0.5, 0.06);
}

TEST(UpdateMeans, WhereOneIsHeldAtItsBoundTheOtherMakesUpForIt) {
  std::vector<float> shares;
  for (int t = 0; t < 1000; ++t) {
    const float first = 0.55f + 0.05f * static_cast<float>(t) / 1000;
    shares.insert(shares.end(), {first, 1 - first});
  }
  SubstanceMeans means;
  means.mean.assign(2, {0.5, 0.5, 0.5, 0.055});
  for (int round = 0; round < 12; ++round) UpdateMeans(MixedSamples(shares, means), {1, 1}, &means);
  const float middle[2] = {0.575f, 0.425f};
  EXPECT_NEAR(means.Of(middle)[3], 0.055, 0.005);
  EXPECT_NEAR(means.mean[0][3], 0.03, 1e-9);
}

TEST(UpdateMeans, MeansAreOffByAsMuchAsTheirCovarianceSays) {
  const std::vector<float> shares =
      Substances(Looks(Stripes(1000)), 2, true).SharesOf(Looks(Stripes(1000)));
  double squares = 0;
  constexpr int kSeeds = 100;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SubstanceMeans means;
    means.mean.assign(2, {0.1, 0.1, 0.1, 0.45});
    for (int round = 0; round < 12; ++round) {
      UpdateMeans(Samples(shares, 0.3, means, static_cast<unsigned>(seed)), {1, 1}, &means);
    }
    const double error = means.Of(shares.data())[3] - 0.3;
    squares += error * error / means.CovarianceOf(shares.data())[(kShared + 1) * 3];
  }
  EXPECT_GT(squares / kSeeds, 0.6);
  EXPECT_LT(squares / kSeeds, 1.4);
}

}  // namespace
}  // namespace glint
