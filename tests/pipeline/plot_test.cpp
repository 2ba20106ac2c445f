// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/plot.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace papilla {
namespace {

bool gnuplot_is_there() { return std::system("gnuplot --version > /dev/null 2>&1") == 0; }

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Plot, HasNothingToDrawWithoutAPoint) {
  Plot plot{.title = "empty", .log_y = true};
  EXPECT_FALSE(plot_svg(plot));
  plot.series.push_back({"off the axis", {{1, 0}, {1, -2}, {std::numeric_limits<double>::quiet_NaN(), 1}}});
  EXPECT_FALSE(plot_svg(plot));
}

TEST(Plot, DrawsTheSameBytesAgain) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  const Plot plot{.title = "t", .x_name = "x", .y_name = "y", .series = {{"a", {{0, 1}, {1, 2}}}}};
  const auto first = plot_svg(plot);
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, *plot_svg(plot));
  EXPECT_NE(first->find("</svg>"), std::string::npos);
}

TEST(Plot, TakesNamesAsData) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  const std::string name = "it's <b>x_1</b> `touch /tmp/never` \"$d0\"\nset output";
  const auto svg = plot_svg({.title = name,
                             .x_name = name,
                             .y_name = name,
                             .series = {{name, {{0, 1}, {1, 2}}}},
                             .labels = {{name, {1, 1}}}});
  ASSERT_TRUE(svg);
  EXPECT_EQ(svg->find("<b>"), std::string::npos);
  EXPECT_GE(count(*svg, "it's &lt;b>x_1&lt;/b> `touch /tmp/never`"), 5U);  // title, both axes, legend, label
}

TEST(Plot, LeavesOutWhatALogarithmicAxisHasNoPlaceFor) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  const Plot all{.log_y = true, .series = {{"", {{1, 1}, {2, 10}, {3, 100}}, PlotSeries::Style::points}}};
  Plot more = all;
  more.series[0].points.push_back({4, 0});
  more.series[0].points.push_back({4, std::numeric_limits<double>::infinity()});
  ASSERT_TRUE(plot_svg(all));
  EXPECT_EQ(*plot_svg(all), *plot_svg(more));
}

TEST(Plot, NumbersALogarithmicAxisHoweverLittleItShows) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  const auto shows = [](double low, double high, const std::vector<std::string>& ticks) {
    const auto svg =
        plot_svg({.log_y = true, .series = {{"", {{1, low}, {2, high}}}}, .low = {0.5, low}, .high = {2.5, high}});
    ASSERT_TRUE(svg);
    for (const std::string& tick : ticks) EXPECT_EQ(count(*svg, ">" + tick + "</"), 1U) << tick << " of " << low;
  };
  shows(3.85, 4.34, {"3.9", "4.2", "4.3"});
  shows(0.04, 0.9, {"0.05", "0.1", "0.2", "0.5"});
}

}  // namespace
}  // namespace papilla
