#include "fitting/view_correction/outer_products.h"

#include <gtest/gtest.h>

#include <random>

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
