// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/trace_plot.hpp"

#include <gtest/gtest.h>

namespace papilla::app {
namespace {

TEST(TracePlot, MarksWhatNobodyBeats) {
  std::vector<TraceCurve> curves{{"fast", {{0.1, 1}}}, {"good", {{0.5, 2}, {1, 0.1}}}, {"beaten", {{2, 0.2}}}};
  mark_front(curves);
  EXPECT_TRUE(curves[0].in_front);
  EXPECT_TRUE(curves[1].in_front);
  EXPECT_FALSE(curves[2].in_front);
}

TEST(TracePlot, DrawsEveryCurveAndEscapesNames) {
  const std::string svg = trace_plot_svg("a < b", "error", {{"one & two", {{0.01, 3}, {0.1, 0}}}, {"empty", {}}});
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_NE(svg.find("one &amp; two"), std::string::npos);
  EXPECT_NE(svg.find("empty"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

}  // namespace
}  // namespace papilla::app
