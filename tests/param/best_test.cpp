// SPDX-License-Identifier: MIT
#include "papilla/param/best.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bench/param_meshes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Maps one chart and checks what is promised of every disk.
DistortionReport valid_map(const TriangleMesh& mesh, const BestOptions& options = {}) {
  const Flattening f = flatten_best(mesh, test::one_chart(mesh), options);
  EXPECT_TRUE(f.notes.empty()) << f.notes.front().reason;
  EXPECT_EQ(f.charts.count, 1u);
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_EQ(r.flipped, 0u);
  EXPECT_EQ(r.degenerate_uv, 0u);
  EXPECT_EQ(r.overlap_within_charts, 0);
  EXPECT_EQ(r.overlapping_triangles, 0u);
  EXPECT_EQ(r.mirrored_charts, 0u);
  return r;
}

/// A tube of radius 1 and the given length that is closed at its end: convex maps shrink its tip by exp(-length).
/// @param bend the angle between its ends [rad].
TriangleMesh finger(double length, double bend = 0) {
  const int rings = static_cast<int>(4 * length);
  TriangleMesh mesh = test::grid_mesh(24, rings, [&](double s, double t) {
    const double x = std::cos(2 * k_pi * s), y = std::sin(2 * k_pi * s), z = length * (t - 1);
    if (bend == 0) return Vec3{x, y, z};
    const double radius = length / bend;
    return Vec3{radius - (radius - x) * std::cos(z / radius), y, (radius - x) * std::sin(z / radius)};
  });
  // Rolls the sheet up: the last column becomes the first one; the top ring is closed by a fan.
  std::vector<Index> number(mesh.positions.size());
  for (Index v = 0; v < number.size(); ++v) number[v] = v % 25 == 24 ? v - 24 : v;
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) v = number[v];
  const auto tip = static_cast<Index>(mesh.positions.size());
  mesh.positions.push_back({0, 0, 0.5});
  const auto top = static_cast<Index>(25 * rings);
  for (Index i = 0; i < 24; ++i) mesh.triangles.push_back({top + i, top + (i + 1) % 24, tip});
  return mesh;
}

/// A flat spiral strip, wound up on a cylinder of helical turns: free flattening lays the turns on one another.
TriangleMesh spiral(int turns) {
  return test::grid_mesh(24 * turns, 3, [&](double s, double t) {
    const double angle = 2 * k_pi * turns * s, r = 10 + 5 * t;
    return Vec3{r * std::cos(angle), -r * std::sin(angle), -2 * angle};
  });
}

TEST(Best, DevelopableChartIsExact) {
  const DistortionReport r = valid_map(test::grid_mesh(64, 30, test::open_cylinder));
  EXPECT_NEAR(r.symmetric_dirichlet.mean, 4, 1e-9);
  EXPECT_LT(r.maillot_length, 1e-9);
  EXPECT_NEAR(r.uv_area, r.area_mm2, 1e-9 * r.area_mm2);
}

TEST(Best, ReachesTheKnownMinima) {
  // Converged values of another solver (scalable locally injective mappings) on the same surfaces.
  EXPECT_NEAR(valid_map(test::dashboard_mesh(118, 42)).symmetric_dirichlet.mean, 4.00777, 2e-4);
  EXPECT_NEAR(valid_map(test::hemisphere_mesh(50, 101)).symmetric_dirichlet.mean, 4.1416, 1e-3);
  EXPECT_NEAR(valid_map(test::grid_mesh(32, 160, test::grab_handle, 0.15)).symmetric_dirichlet.mean, 4.1293, 1e-3);
}

TEST(Best, SqueezedDomesUnfold) {
  // The minimum that another solver (as rigid as possible, local and global steps) comes to is 4.0038.
  for (const double aspect : {1e2, 1e3, 1e5}) {
    const TriangleMesh mesh = test::grid_mesh(40, 40, [aspect](double s, double t) {
      return 100.0 * Vec3{s / aspect, t, 2 * s * (1 - s) * t * (1 - t)};
    });
    EXPECT_LT(valid_map(mesh).symmetric_dirichlet.mean, 4.005);
  }
}

TEST(Best, GrainStandsUpright) {
  const TriangleMesh mesh = test::grid_mesh(32, 16, test::open_cylinder);
  const Flattening f = flatten_best(mesh, test::one_chart(mesh));
  const Vec2 origin = f.uv.values[f.uv.indices[0][0]];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(f.uv.values[f.uv.indices[t][k]].y - origin.y,
                  mesh.corner(t, static_cast<int>(k)).z - mesh.corner(0, 0).z, 1);  // of a height of 2000
}

TEST(Best, LongFingerIsValid) {
  // The tip of Tutte's map is exp(-30) wide; the best map opens the finger as far as its border allows.
  EXPECT_LT(valid_map(finger(6)).symmetric_dirichlet.mean, 9.45);  // the minimum is 9.414
  EXPECT_LT(valid_map(finger(30)).symmetric_dirichlet.mean, 40);
}

TEST(Best, LongFingersOpenAsConesDo) {
  // A tube that opens to a disk of radius a z has E / A = a² + 1/a² + a² L²/3 + ..., least 2 √(1 + L²/3), without its
  // tip.
  const auto cone = [](double length) { return 2 * std::sqrt(1 + length * length / 3); };
  EXPECT_LT(valid_map(finger(45)).symmetric_dirichlet.mean, 1.03 * cone(45));
  EXPECT_LT(valid_map(finger(80)).symmetric_dirichlet.mean, 1.06 * cone(80));
  EXPECT_LT(valid_map(finger(30, 2)).symmetric_dirichlet.mean, 1.05 * cone(30));
}

TEST(Best, NearlyClosedSphereIsValid) {
  TriangleMesh mesh = test::uv_sphere(10, 30, 60);
  mesh.triangles.resize(mesh.triangles.size() - 1);
  valid_map(mesh);
}

TEST(Best, TurnsOfASpiralAreKeptApart) {
  EXPECT_LT(valid_map(spiral(3)).symmetric_dirichlet.mean, 5);
  EXPECT_LT(valid_map(spiral(30)).symmetric_dirichlet.mean, 6);
  EXPECT_LT(valid_map(test::grid_mesh(60, 6, test::helical_ramp)).symmetric_dirichlet.mean, 5);
}

TEST(Best, CutTorusIsValid) {
  const TriangleMesh mesh = test::grid_mesh(60, 30, [](double s, double t) {
    const double a = 2 * k_pi * s, b = 2 * k_pi * t, r = 3 + std::cos(b);
    return Vec3{r * std::cos(a), r * std::sin(a), std::sin(b)};
  });
  EXPECT_LT(valid_map(mesh).symmetric_dirichlet.mean, 5);
}

TEST(Best, HolesAreWelcome) {
  TriangleMesh mesh = test::plane(40, 30, 40, 30);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vec3 c = (1.0 / 3) * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    return std::hypot(c.x - 15, c.y - 15) < 5 || std::hypot(c.x - 30, c.y - 12) < 4;
  });
  EXPECT_NEAR(valid_map(mesh).symmetric_dirichlet.max, 4, 1e-3);
}

TEST(Best, SmallestCharts) {
  TriangleMesh mesh;
  mesh.positions = {{1, 2, 3}, {4, 2, 3}, {1, 6, 4}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_NEAR(valid_map(mesh).symmetric_dirichlet.max, 4, 1e-6);
  mesh.positions.push_back({5, 6, 3});
  mesh.triangles.push_back({1, 3, 2});
  EXPECT_NEAR(valid_map(mesh).symmetric_dirichlet.max, 4, 1e-6);
  EXPECT_NEAR(valid_map(test::needle_strip(1000, 1, 100)).symmetric_dirichlet.mean, 4, 1e-6);
}

TEST(Best, ScaleAndOffsetDoNotMatter) {
  const TriangleMesh mesh = test::dashboard_mesh(60, 21);
  const double original = valid_map(mesh).symmetric_dirichlet.mean;
  for (const double scale : {1e-6, 1e6}) {
    TriangleMesh scaled = mesh;
    for (Vec3& p : scaled.positions) p = scale * p;
    EXPECT_NEAR(valid_map(scaled).symmetric_dirichlet.mean, original, 1e-6 * original);
  }
  TriangleMesh moved = mesh;
  for (Vec3& p : moved.positions) p.x += 1e7;
  EXPECT_NEAR(valid_map(moved).symmetric_dirichlet.mean, original, 1e-6 * original);
}

TEST(Best, TrianglesWithoutAreaHardlyMatter) {
  const TriangleMesh mesh = test::dashboard_mesh(118, 42);
  const double original = valid_map(mesh).symmetric_dirichlet.mean;
  for (const double height : {0.0, 1e-9, 1e-6}) {
    const DistortionReport r = valid_map(bench::squashed(mesh, height));  // one triangle in a hundred
    EXPECT_NEAR(r.symmetric_dirichlet.mean, original, 3e-4);
  }
}

/// Splits every seventh triangle at a vertex next to the middle of its first edge, and fills the gap along that edge
/// with a triangle of this height over its length: the surface stays what it was.
TriangleMesh with_slivers(const TriangleMesh& mesh, double height) {
  TriangleMesh result = mesh;
  for (std::size_t t = 3; t < mesh.triangles.size(); t += 7) {
    const auto [a, b, c] = mesh.triangles[t];
    const auto middle = static_cast<Index>(result.positions.size());
    const Vec3 p = mesh.positions[a], q = mesh.positions[b];
    const Vec3 foot = 0.5 * (p + q), to_tip = mesh.positions[c] - foot;
    result.positions.push_back(foot + (height * norm(q - p) / norm(to_tip)) * to_tip);
    result.triangles[t] = {a, b, middle};
    result.triangles.push_back({middle, b, c});
    result.triangles.push_back({a, middle, c});
  }
  return result;
}

TEST(Best, SliversLeaveDevelopableChartsExact) {
  for (const TriangleMesh& mesh : {test::grid_mesh(64, 30, test::open_cylinder), test::plane(30, 20, 30, 20)})
    for (const double height : {0.0, 1e-9, 1e-6})
      EXPECT_NEAR(valid_map(with_slivers(mesh, height)).symmetric_dirichlet.mean, 4, 1e-6) << height;
}

TEST(Best, SliversLeaveTheEnergyOfACurvedChart) {
  const TriangleMesh mesh = test::dashboard_mesh(60, 21);
  const double original = valid_map(mesh).symmetric_dirichlet.mean;
  for (const double height : {0.0, 1e-9, 1e-6})
    EXPECT_NEAR(valid_map(with_slivers(mesh, height)).symmetric_dirichlet.mean, original, 3e-4) << height;
}

TEST(Best, EnergyFallsAlongTheTrace) {
  const TriangleMesh mesh = test::hemisphere_mesh(20, 40);
  BestOptions options;
  options.tolerance = 1e-9;
  const Flattening f = flatten_best(mesh, test::one_chart(mesh), options);
  ASSERT_GE(f.trace.size(), 3u);
  for (std::size_t i = 1; i < f.trace.size(); ++i) {
    EXPECT_LE(f.trace[i].error, f.trace[i - 1].error);
    EXPECT_GE(f.trace[i].seconds, f.trace[i - 1].seconds);
  }
  EXPECT_NEAR(f.trace.back().error, measure_distortion(mesh, f.uv).symmetric_dirichlet.mean, 1e-3);
}

TEST(Best, SameBytesForAnyNumberOfThreads) {
  for (const TriangleMesh& mesh :
       {test::grid_mesh(32, 100, test::grab_handle, 0.15), finger(30), spiral(20), test::dashboard_mesh(150, 60)}) {
    std::vector<Flattening> results;
    for (const std::size_t threads : {1u, 2u, 4u}) {
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      results.push_back(flatten_best(mesh, test::one_chart(mesh)));
    }
    EXPECT_EQ(results[0].uv.values, results[1].uv.values);
    EXPECT_EQ(results[0].uv.values, results[2].uv.values);
  }
}

TEST(Best, WhatIsNoDiskFallsBackOrIsRefused) {
  const TriangleMesh cube = test::cube(5);
  const Flattening f = flatten_best(cube, test::one_chart(cube));
  ASSERT_EQ(f.notes.size(), 1u);
  EXPECT_NE(f.notes[0].reason.find("closed"), std::string::npos);
  EXPECT_EQ(f.charts.count, 6u);
  BestOptions strict;
  strict.fall_back = false;
  EXPECT_THROW(flatten_best(cube, test::one_chart(cube), strict), InvalidInput);
  // Two triangles on the same three vertices, sewn along two edges: a border of two vertices.
  TriangleMesh pocket;
  pocket.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  pocket.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 1, 0}, {2, 1, 3}};
  pocket.triangles.pop_back();
  EXPECT_TRUE(flatten_best(pocket, test::one_chart(pocket)).notes.empty());
}

TEST(Best, ChartsBeyondTheEnergyLimitCountAsUnmapped) {
  const TriangleMesh bowl = test::hemisphere_mesh(10, 24);
  const double energy = flatten_best(bowl, test::one_chart(bowl)).trace.back().error;
  EXPECT_GT(energy, 4.1);  // no isometry takes a hemisphere to the plane
  BestOptions options;
  options.fall_back = false;
  options.energy_limit = 1.001 * energy;
  EXPECT_EQ(flatten_best(bowl, test::one_chart(bowl), options).trace.back().error, energy);
  options.energy_limit = 0.999 * energy;
  EXPECT_THROW(flatten_best(bowl, test::one_chart(bowl), options), SolverFailure);
  options.fall_back = true;
  const Flattening anyway = flatten_best(bowl, test::one_chart(bowl), options);
  ASSERT_EQ(anyway.notes.size(), 1u);
  EXPECT_NE(anyway.notes.front().reason.find("energy"), std::string::npos);
  EXPECT_EQ(anyway.charts.count, 1u);
  options.max_iterations = 0;
  const Flattening refused = flatten_best(bowl, test::one_chart(bowl), options);
  options.energy_limit = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused.uv.values, flatten_best(bowl, test::one_chart(bowl), options).uv.values) << "the refused map";
}

TEST(Best, WhatIsOfNoUseIsLeftUnfinished) {
  const TriangleMesh bowl = test::hemisphere_mesh(40, 96);
  const ChartSet chart = test::one_chart(bowl);
  const Flattening finished = flatten_best(bowl, chart);
  double area = 0;
  for (const Triangle& t : bowl.triangles)
    area += 0.5 * norm(cross(bowl.positions[t[1]] - bowl.positions[t[0]], bowl.positions[t[2]] - bowl.positions[t[0]]));
  const double energy = finished.trace.back().error, excess = (energy - 4) * area;
  BestOptions options;
  options.give_up_excess_mm2 = 1.01 * excess;
  EXPECT_EQ(flatten_best(bowl, chart, options).uv.values, finished.uv.values);
  ChartMemory memory;
  options.memory = &memory;
  for (const double part : {0.9, 0.1}) {  // By the finest level, and by one that is coarser.
    options.give_up_excess_mm2 = part * excess;
    const Flattening left = flatten_best(bowl, chart, options);
    EXPECT_TRUE(left.notes.empty());
    EXPECT_GT(left.trace.back().error, energy) << part;
    EXPECT_LT(left.trace.back().error, 1.5 * energy) << part;
    EXPECT_EQ(measure_distortion(bowl, left.uv, {}).flipped, 0u) << part;
    EXPECT_LT(left.trace.size(), finished.trace.size()) << part;
  }
  options.give_up_excess_mm2 = std::numeric_limits<double>::infinity();
  EXPECT_EQ(flatten_best(bowl, chart, options).uv.values, finished.uv.values) << "what was left is not remembered";
  options.give_up_excess_mm2 = -1;
  EXPECT_THROW(flatten_best(bowl, chart, options), InvalidInput);
}

TEST(Best, BadInputIsNamed) {
  EXPECT_TRUE(flatten_best({}, {}).uv.empty());
  TriangleMesh mesh = test::plane(2, 2, 2, 2);
  BestOptions options;
  options.tolerance = 0;
  EXPECT_THROW(flatten_best(mesh, test::one_chart(mesh), options), InvalidInput);
  options = {};
  options.max_iterations = -1;
  EXPECT_THROW(flatten_best(mesh, test::one_chart(mesh), options), InvalidInput);
  options = {};
  options.energy_limit = 3.9;
  EXPECT_THROW(flatten_best(mesh, test::one_chart(mesh), options), InvalidInput);
  mesh.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(flatten_best(mesh, test::one_chart(mesh)), InvalidInput);
}

TEST(Best, EdgesWithoutLengthToSpeakOfStayShort) {
  TriangleMesh mesh = test::hemisphere_mesh(20, 40);
  const double worst = valid_map(mesh).symmetric_dirichlet.max;
  for (Index ring = 4; ring < 12; ++ring)
    for (Index s = 0; s < 40; s += 2) {
      Vec3 *own = &mesh.positions[1 + (ring - 1) * 40 + s], *next = own + 1;
      *next = *own + 1e-6 * (*next - *own);
    }
  EXPECT_LT(valid_map(mesh).symmetric_dirichlet.max, 1.1 * worst);
}

}  // namespace
}  // namespace papilla
