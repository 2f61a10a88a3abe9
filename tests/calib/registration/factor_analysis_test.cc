#include "calib/registration/factor_analysis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace glint {
namespace {

Eigen::MatrixXd SomeMixing(int views, int factors) {
  Eigen::MatrixXd mixing(views, factors);
  for (int i = 0; i < views; ++i) {
    for (int j = 0; j < factors; ++j) mixing(i, j) = std::sin(1.7 * i + 2.9 * j + 0.3 * i * j);
  }
  return mixing;
}

Eigen::MatrixXd WithNoise(const Eigen::MatrixXd& mixing) {
  Eigen::MatrixXd covariance = mixing * mixing.transpose();
  for (int i = 0; i < covariance.rows(); ++i) covariance(i, i) += 0.2 + 0.05 * i;
  return covariance;
}

TEST(FactorAnalysis, AsManyFactorsAsTheViewsCanTell) {
  EXPECT_EQ(FactorsOf(2), 0);
  EXPECT_EQ(FactorsOf(3), 0);
  EXPECT_EQ(FactorsOf(4), 1);
  EXPECT_EQ(FactorsOf(5), 2);
  EXPECT_EQ(FactorsOf(6), 2);
  EXPECT_EQ(FactorsOf(7), 3);
  EXPECT_EQ(FactorsOf(50), 3);
}

TEST(FactorAnalysis, FindsTheCovarianceOfFactorsAndNoise) {
  const Eigen::MatrixXd truth = WithNoise(SomeMixing(9, 3));
  EXPECT_LT((FitFactors(truth, 3).covariance - truth).cwiseAbs().maxCoeff(), 0.1);
}

TEST(FactorAnalysis, FewerFactorsThanThereAreFitWorse) {
  const Eigen::MatrixXd truth = WithNoise(SomeMixing(9, 3));
  EXPECT_GT(FitFactors(truth, 2).misfit, FitFactors(truth, 3).misfit + 0.1);
}

TEST(FactorAnalysis, ViewsWithoutAnythingAreNoReasonToFail) {
  Eigen::MatrixXd sample = WithNoise(SomeMixing(8, 3));
  sample.row(2).setZero();
  sample.col(2).setZero();
  EXPECT_TRUE(FitFactors(sample, 3).covariance.allFinite());
  EXPECT_TRUE(std::isfinite(FitFactors(Eigen::MatrixXd::Zero(8, 8), 3).misfit));
}

}  // namespace
}  // namespace glint
