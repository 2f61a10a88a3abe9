#include "fitting/view_correction/outer_products.h"

#include <gtest/gtest.h>

#include <random>

#include "fitting/view_correction/outer_products_kernel.h"

namespace glint {
namespace {

Eigen::MatrixXd Drawn(int rows, int columns) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

TEST(OuterProducts, AreTheMatrixProductOfAnySize) {
  for (const auto& [rows, columns] :
       {std::pair{0, 5}, {1, 1}, {3, 15}, {144, 16}, {145, 17}, {500, 243}}) {
    const Eigen::MatrixXd drawn = Drawn(rows, columns);
    OuterProducts products(columns);
    for (int i = 0; i < rows; ++i) products.AddRow() = drawn.row(i);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Ones(columns, columns);
    products.AddTo(-2, sum);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Ones(columns, columns);
    expected.triangularView<Eigen::Lower>() -= 2 * (drawn.transpose() * drawn);
    EXPECT_LT((sum - expected).cwiseAbs().maxCoeff(), 1e-10) << rows << " x " << columns;
  }
}

// Results do not depend on the processor's vector units.
TEST(OuterProducts, AreTheSameBitsFromEveryInstructionSet) {
  constexpr int kStride = 3 * kernel::kStrideUnit, kCount = 37;
  const Eigen::MatrixXd drawn = Drawn(kStride, kCount);  // a row in each column
  const auto sums_of = [&](InstructionSet set) {
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(kStride, kStride);
    kernel::AddProductsFor(set)(drawn.data(), kCount, kStride, sums.data());
    return Eigen::MatrixXd(sums.triangularView<Eigen::Lower>());
  };
  const Eigen::MatrixXd baseline = sums_of(InstructionSet::kBaseline);
  EXPECT_GT(baseline.norm(), 1);
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!Available(set)) continue;
    EXPECT_EQ(sums_of(set), baseline) << Name(set);
  }
}

TEST(OuterProducts, BeginAnewWhenCleared) {
  const Eigen::MatrixXd drawn = Drawn(20, 9);
  const auto sum_of = [&](OuterProducts* products) {
    for (int i = 0; i < 20; ++i) products->AddRow() = drawn.row(i);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(9, 9);
    products->AddTo(1, sum);
    return sum;
  };
  OuterProducts products(9);
  const Eigen::MatrixXd first = sum_of(&products);
  products.Clear();
  EXPECT_EQ(sum_of(&products), first);
}

}  // namespace
}  // namespace glint
