#include "training/loss_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/process.h"

namespace glint {
namespace {

TEST(LossPlot, DrawsACurveForEachColumnThatHasValues) {
  const test::TemporaryFolder folder;
  const auto csv = folder.path() / "log.csv", svg = folder.path() / "log.svg";
  test::WriteAll(
      csv,
      "step,seconds,samples_per_second,learning_rate,loss,map,smoothness,render,validation\n"
      "10,1,5,1e-4,1,0.5,0,0.3,\n100,2,5,1e-4,1,0.05,0,0.1,0.07\n");
  WriteLossPlot(csv, svg);
  const std::string text = test::ReadAll(svg);
  EXPECT_THAT(text, testing::HasSubstr("maps, L1"));
  EXPECT_THAT(text, testing::HasSubstr("validation"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr(">smoothness<")));
  // The largest map loss is the highest point, the smallest the lowest.
  EXPECT_THAT(text, testing::HasSubstr("points='62,16 704,376 '"));
}

TEST(LossPlot, WithoutALogSaysSo) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(WriteLossPlot(folder.path() / "none.csv", folder.path() / "x.svg"),
               std::runtime_error);
}

}  // namespace
}  // namespace glint
