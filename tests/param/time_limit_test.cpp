// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "chart_driver.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/levy.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/maillot.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/reference_maps.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

using Method = std::function<Flattening(const TriangleMesh&, const ChartSet&, Deadline)>;

template <class Options>
Options until(Deadline deadline) {
  Options options;
  options.deadline = deadline;
  return options;
}

const std::map<std::string, Method>& methods() {
  static const std::map<std::string, Method> all{
      {"best", [](const auto& mesh, const auto& charts,
                  Deadline d) { return flatten_best(mesh, charts, until<BestOptions>(d)); }},
      {"automatic",
       [](const auto& mesh, const auto& charts, Deadline d) {
         AutomaticOptions options;
         options.best.deadline = d;
         return flatten_automatic(mesh, charts, options).flattening;
       }},
      {"maillot", [](const auto& mesh, const auto& charts,
                     Deadline d) { return flatten_maillot(mesh, charts, until<MaillotOptions>(d)).flattening; }},
      {"levy", [](const auto& mesh, const auto& charts,
                  Deadline d) { return flatten_levy(mesh, charts, until<LevyOptions>(d)).flattening; }},
      {"lscm", [](const auto& mesh, const auto& charts,
                  Deadline d) { return flatten_lscm(mesh, charts, until<LscmOptions>(d)); }},
      {"arap", [](const auto& mesh, const auto& charts,
                  Deadline d) { return flatten_reference(mesh, charts, until<ReferenceOptions>(d)); }},
  };
  return all;
}

/// A wavy sheet, whose map takes longer than the deadlines below.
TriangleMesh large_sheet() {
  return test::grid_mesh(400, 400, [](double s, double t) {
    return Vec3{s, t, 0.2 * std::sin(9 * s) * std::sin(11 * t)};
  });
}

TEST(TimeLimit, ChartsNotBegunAreProjected) {
  const TriangleMesh mesh = test::grid_mesh(8, 8, [](double s, double t) { return Vec3{s, t, 0.3 * s * t}; });
  for (const auto& [name, method] : methods()) {
    const Flattening f = method(mesh, test::one_chart(mesh), Deadline(0));
    EXPECT_EQ(f.stop, StopReason::time_limit) << name;
    ASSERT_EQ(f.notes.size(), 1U) << name;
    EXPECT_NE(f.notes[0].reason.find("no time is left; projected"), std::string::npos) << f.notes[0].reason;
    EXPECT_EQ(measure_distortion(mesh, f.uv).flipped, 0U) << name;
    EXPECT_TRUE(method(mesh, test::one_chart(mesh), Deadline()).notes.empty()) << name;
  }
}

TEST(TimeLimit, EndsTheMapThatIsStartedFrom) {
  const TriangleMesh mesh = large_sheet();
  const Flattening f = flatten_maillot(mesh, test::one_chart(mesh), until<MaillotOptions>(Deadline(0.05))).flattening;
  EXPECT_EQ(f.stop, StopReason::time_limit);
  EXPECT_EQ(f.notes.size(), 1U) << "no map, where the start was not finished";
}

TEST(TimeLimit, EndsTheMapThatIsMadeInstead) {
  const TriangleMesh mesh = large_sheet();
  param_detail::DriverOptions driver;
  driver.function = "test";
  driver.deadline = Deadline(0.1);
  const auto fail = [](const param_detail::ChartSurface&) {
    param_detail::ChartMap map;
    map.failure = "it is none";
    return map;
  };
  const Flattening f = param_detail::flatten_charts(mesh, test::one_chart(mesh), fail, driver);
  EXPECT_EQ(f.stop, StopReason::time_limit);
  EXPECT_EQ(f.notes.size(), 1U);
}

TEST(TimeLimit, KeepsAMapThatOnlyItsDistortionRefuses) {
  const TriangleMesh mesh = test::grid_mesh(8, 8, [](double s, double t) { return Vec3{s, t, 0.3 * s * t}; });
  param_detail::DriverOptions driver;
  driver.function = "test";
  const auto stopped = [](const param_detail::ChartSurface& chart) {
    param_detail::ChartMap map;
    map.failure = "it is too distorted";
    map.stop = StopReason::time_limit;
    for (const Vec3& p : chart.positions) map.uv.push_back({p.x, p.y});
    return map;
  };
  const Flattening f = param_detail::flatten_charts(mesh, test::one_chart(mesh), stopped, driver);
  EXPECT_EQ(f.stop, StopReason::time_limit);
  EXPECT_EQ(f.charts.count, 1U);
  ASSERT_EQ(f.notes.size(), 1U);
  EXPECT_NE(f.notes[0].reason.find("mapped with least distortion instead"), std::string::npos) << f.notes[0].reason;
}

}  // namespace
}  // namespace papilla
