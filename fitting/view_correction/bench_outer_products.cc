// Sums of outer products as view correction forms them, nine rows for each of many texels and 20
// photographs' unknowns, against Eigen's matrix product of the same rows.
#include <fmt/format.h>

#include <Eigen/Core>
#include <chrono>

#include "base/cpu/instruction_set.h"
#include "fitting/view_correction/outer_products.h"

namespace glint {
namespace {

constexpr int kUnknowns = 229, kRows = 9 * 300, kTurns = 5;

template <class Work>
double Seconds(const Work& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

void Run() {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows =
      Eigen::MatrixXd::Random(kRows, kUnknowns);
  double ours = 0, of_eigen = 0, difference = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    OuterProducts products(kUnknowns);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns), expected = sum;
    ours += Seconds([&] {
      for (int i = 0; i < kRows; ++i) products.AddRow() = rows.row(i);
      products.AddTo(1, sum);
    });
    of_eigen +=
        Seconds([&] { expected.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose()); });
    const Eigen::MatrixXd off = sum - expected;
    difference = off.triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff();
  }
  fmt::print("{}: {:.2f} times as fast as Eigen; largest difference {:.1e}\n",
             Name(BestInstructionSet()), of_eigen / ours, difference);
}

}  // namespace
}  // namespace glint

int main() { glint::Run(); }
