#include "datasets/evaluation/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

namespace glint {
namespace {

using testing::HasSubstr;
using testing::Not;

Plot Example() {
  Plot plot;
  plot.title = "a < b & c";
  plot.log_x = plot.log_y = true;
  plot.x_label = "views";
  plot.panels = {{"left",
                  {{"one", {{1, 0.1}, {10, 0.01}, {100, 0.001}}, -1},
                   {"paper", {{1, 0.05}, {100, 0.01}}, 0}}}};
  return plot;
}

// Centres of the marks, in order.
std::vector<std::pair<double, double>> Marks(const std::string& svg) {
  static const std::regex mark("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::vector<std::pair<double, double>> marks;
  for (std::sregex_iterator at(svg.begin(), svg.end(), mark), end; at != end; ++at) {
    marks.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
  }
  return marks;
}

TEST(PlotSvg, LogarithmicAxesSpacePowersEvenly) {
  const auto marks = Marks(PlotSvg(Example()));
  ASSERT_EQ(marks.size(), 5u);
  EXPECT_NEAR(marks[1].first - marks[0].first, marks[2].first - marks[1].first, 0.2);
  EXPECT_NEAR(marks[1].second - marks[0].second, marks[2].second - marks[1].second, 0.2);
  EXPECT_GT(marks[1].first, marks[0].first + 50);
  EXPECT_GT(marks[1].second, marks[0].second + 50);  // smaller values are lower
}

TEST(PlotSvg, HasTicksLegendAndEscapedText) {
  const std::string svg = PlotSvg(Example());
  for (const std::string part : {">0.01</text>", ">10</text>", ">one</text>", ">views</text>",
                                 "a &lt; b &amp; c", "stroke-dasharray"}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
  EXPECT_EQ(svg, PlotSvg(Example()));
}

TEST(PlotSvg, LeavesOutWhatCannotBeDrawn) {
  Plot plot = Example();
  plot.panels[0].series[0].points = {{1, 0}, {10, 0.01}, {100, NAN}};
  plot.panels[0].series[1].points.clear();
  const std::string svg = PlotSvg(plot);
  EXPECT_EQ(Marks(svg).size(), 1u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  EXPECT_THAT(PlotSvg({}), HasSubstr("</svg>"));
}

TEST(PlotSvg, NarrowRangesHaveTicksToo) {
  Plot plot;
  plot.log_y = true;
  plot.panels = {{"p", {{"s", {{1, 0.1842}, {2, 0.1852}}, -1}}}};
  const std::string svg = PlotSvg(plot);
  static const std::regex tick(">0\\.18[0-9]+</text>");
  EXPECT_GE(std::distance(std::sregex_iterator(svg.begin(), svg.end(), tick), {}), 3);
}

TEST(PlotSvg, CategoriesAreTicks) {
  Plot plot;
  plot.categories = {"plain", "off by 5°"};
  plot.panels = {{"p", {{"s", {{0, 1}, {1, 3}}, -1}}}};
  const std::string svg = PlotSvg(plot);
  EXPECT_THAT(svg, HasSubstr(">off by 5°</text>"));
  EXPECT_EQ(Marks(svg).size(), 2u);
}

}  // namespace
}  // namespace glint
