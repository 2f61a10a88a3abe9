#include "fitting/view_correction/bounded_step.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace glint {
namespace {

struct Quadratic {
  Eigen::MatrixXd a;
  Eigen::VectorXd g, least, most;
};

// Values that make up for each other: a few directions matter a thousand times as much.
Quadratic RandomQuadratic(Eigen::Index n, std::mt19937* random) {
  std::normal_distribution<double> normal(0, 1);
  const auto draw = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(*random); }).eval();
  };
  const Eigen::MatrixXd few = 30 * draw(3, n);
  Quadratic q;
  q.a = few.transpose() * few + Eigen::MatrixXd::Identity(n, n);
  q.g = 30 * draw(n, 1);
  q.least = -draw(n, 1).cwiseAbs();
  q.most = draw(n, 1).cwiseAbs();
  return q;
}

TEST(StepWithin, NothingWithinTheBoundsIsLower) {
  std::mt19937 random(3);
  for (int problem = 0; problem < 200; ++problem) {
    const Quadratic q = RandomQuadratic(12, &random);
    const Eigen::VectorXd step = StepWithin(q.a, q.g, q.least, q.most);
    const Eigen::VectorXd slope = q.a * step - q.g;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      ASSERT_GE(step[i], q.least[i]);
      ASSERT_LE(step[i], q.most[i]);
      // Downhill leads out of the bounds, if anywhere.
      ASSERT_LT(step[i] > q.least[i] ? slope[i] : 0, 1e-6) << problem;
      ASSERT_GT(step[i] < q.most[i] ? slope[i] : 0, -1e-6) << problem;
    }
  }
}

TEST(StepWithin, WideBoundsLeaveNewtonsStep) {
  std::mt19937 random(4);
  Quadratic q = RandomQuadratic(12, &random);
  q.least.setConstant(-1e6);
  q.most.setConstant(1e6);
  const Eigen::VectorXd newton = q.a.ldlt().solve(q.g);
  EXPECT_LT((StepWithin(q.a, q.g, q.least, q.most) - newton).norm(), 1e-9 * newton.norm());
}

TEST(StepWithin, NoRoomIsNoStep) {
  std::mt19937 random(5);
  Quadratic q = RandomQuadratic(5, &random);
  q.least.setZero();
  q.most.setZero();
  EXPECT_EQ(StepWithin(q.a, q.g, q.least, q.most).norm(), 0);
}

}  // namespace
}  // namespace glint
