// SPDX-License-Identifier: MIT
#include "papilla/pipeline/unwrap_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

Scene scene_of(TriangleMesh mesh) {
  Scene scene;
  scene.up = UpAxis::z;
  scene.parts.resize(1);
  scene.parts[0].name = "part";
  scene.parts[0].mesh = std::move(mesh);
  return scene;
}

UnwrapOptions options_of(UnwrapMethod method) {
  UnwrapOptions options;
  options.method.method = method;
  return options;
}

TEST(Unwrap, EveryMethodByNameGivesFiniteUvWithoutMirrors) {
  TriangleMesh mesh = test::cylinder(30, 80, 24, 6);
  mesh.cad_uv = mesh.uv;
  for (const auto& [name, method] : unwrap_methods()) {
    EXPECT_EQ(unwrap_method_name(method), name);
    Scene scene = scene_of(mesh);
    const UnwrapResult report = unwrap_scene(scene, options_of(method));
    scene = report.scene;
    ASSERT_FALSE(scene.parts[0].mesh.uv.empty()) << name;
    for (const Vec2 p : scene.parts[0].mesh.uv.values) EXPECT_TRUE(is_finite(p)) << name;
    if (method == UnwrapMethod::environment) continue;
    const DistortionReport r = measure_distortion(scene.parts[0].mesh, scene.parts[0].mesh.uv);
    EXPECT_EQ(r.mirrored_charts, 0u) << name;
    EXPECT_EQ(r.flipped, 0u) << name;
  }
}

TEST(Unwrap, ProjectsWhatThereIsNoTimeFor) {
  for (const UnwrapMethod method : {UnwrapMethod::automatic, UnwrapMethod::best, UnwrapMethod::lscm}) {
    UnwrapOptions options = options_of(method);
    options.method.deadline = Deadline(0);
    const UnwrapResult result = unwrap_scene(scene_of(test::cylinder(30, 80, 24, 6)), options);
    EXPECT_EQ(result.parts[0].method, "triplanar");
    EXPECT_NE(result.parts[0].reason.find("time limit"), std::string::npos);
    EXPECT_EQ(result.stop, StopReason::time_limit);
    const TriangleMesh& mesh = result.scene.parts[0].mesh;
    const DistortionReport r = measure_distortion(mesh, mesh.uv);
    EXPECT_EQ(r.without_uv + r.flipped + r.overlapping_triangles, 0u);
  }
}

/// A bowl with waves: no map of it is an isometry.
TriangleMesh wavy_bowl(Index n) {
  TriangleMesh mesh = test::plane(200, 200, n, n);
  for (Vec3& p : mesh.positions)
    p.z = 2e-3 * (p.x * p.x + p.y * p.y) + 1.5 * std::sin(0.1 * p.x) * std::cos(0.12 * p.y);
  return mesh;
}

TEST(Unwrap, EffortsAreValidAndTheirDistortionFallsWithThem) {
  const auto unwrapped = [](UnwrapEffort effort) {
    UnwrapOptions options = options_of(UnwrapMethod::best);
    options.method.effort = effort;
    const UnwrapResult result = unwrap_scene(scene_of(wavy_bowl(170)), options);
    const TriangleMesh& mesh = result.scene.parts[0].mesh;
    const DistortionReport r = measure_distortion(mesh, mesh.uv);
    EXPECT_EQ(r.without_uv + r.flipped + r.overlapping_triangles, 0u);
    return r.symmetric_dirichlet.mean;
  };
  const double fast = unwrapped(UnwrapEffort::fast), normal = unwrapped(UnwrapEffort::normal),
               best = unwrapped(UnwrapEffort::best);
  EXPECT_LE(fast, 1.02 * normal);
  EXPECT_LE(best, normal * (1 + 1e-3));
}

TEST(Unwrap, ProgressGoesOnWithinOnePart) {
  std::vector<double> told;
  UnwrapOptions options = options_of(UnwrapMethod::best);
  options.method.choose_seam_cost = false;
  unwrap_scene(scene_of(wavy_bowl(60)), options, [&](const Progress& done) {
    if (done.stage == "unwrap") told.push_back(done.fraction);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GE(told.size(), 8u);
  EXPECT_EQ(told.back(), 1);
  EXPECT_GE(std::count_if(told.begin(), told.end(), [](double f) { return f > 0.5 && f < 1; }), 3);
}

TEST(Unwrap, ChartsThatHaveToBeKeptFailWithoutTime) {
  UnwrapOptions options = options_of(UnwrapMethod::best);
  options.method.charts = ChartSource::keep;
  options.method.deadline = Deadline(0);
  EXPECT_THROW(unwrap_scene(scene_of(test::cylinder(30, 80, 24, 6)), options), SolverFailure);
}

TEST(Unwrap, AutomaticProjectsWhatIsSmallerThanTheGrain) {
  UnwrapOptions options = options_of(UnwrapMethod::automatic);
  options.tile_mm = {100, 100};
  Scene scene = scene_of(test::cube(5));
  const UnwrapResult small = unwrap_scene(scene, options);
  EXPECT_EQ(small.parts[0].method, "triplanar");
  EXPECT_NE(small.parts[0].reason.find("8.66 mm"), std::string::npos) << small.parts[0].reason;
  scene = scene_of(test::cube(500));
  const UnwrapResult large = unwrap_scene(scene, options);
  EXPECT_EQ(large.parts[0].method, "auto");
  EXPECT_EQ(large.parts[0].choices.size(), large.parts[0].flattening.charts.count);
  for (const ChartChoice& choice : large.parts[0].choices) EXPECT_EQ(choice.method, "exact");
}

TEST(Unwrap, GrainRunsAlongThePart) {
  TriangleMesh bar = test::cube(10);
  for (Vec3& p : bar.positions) p.x *= 8;
  UnwrapOptions options = options_of(UnwrapMethod::triplanar);
  options.method.grains = {{GrainSource::longest}};
  options.layout = UvLayout::tile;
  Scene scene = scene_of(bar);
  scene = unwrap_scene(scene, options).scene;
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 in_space = mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k));
      const Vec2 edge = mesh.uv.values[mesh.uv.indices[t][(k + 1) % 3]] - mesh.uv.values[mesh.uv.indices[t][k]];
      if (in_space.y == 0 && in_space.z == 0) {
        EXPECT_NEAR(edge.y, in_space.x, 1e-9);
      }
    }
}

/// A sheet over x and z that faces y: a wall where z is up, a floor where y is, on which grain runs to -z.
TEST(Unwrap, GrainStandsUprightByTheAxesOfTheScene) {
  for (const UpAxis up : {UpAxis::z, UpAxis::y}) {
    TriangleMesh sheet = test::plane(30, 20, 2, 1);
    for (Vec3& p : sheet.positions) p = {p.x, 0, -p.y};
    sheet.normals = {};
    Scene scene = scene_of(sheet);
    scene.up = up;
    UnwrapOptions options = options_of(UnwrapMethod::triplanar);
    options.layout = UvLayout::tile;
    const TriangleMesh mesh = unwrap_scene(scene, options).scene.parts[0].mesh;
    ASSERT_EQ(mesh.uv.indices.size(), 4U);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 in_space = mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k));
        const Vec2 edge = mesh.uv.values[mesh.uv.indices[t][(k + 1) % 3]] - mesh.uv.values[mesh.uv.indices[t][k]];
        EXPECT_NEAR(edge.y, up == UpAxis::z ? in_space.z : -in_space.z, 1e-9);
      }
  }
}

TEST(Unwrap, EveryPartHasItsOwnGrain) {
  const std::vector<PlacedGrain> grains{{GrainSource::direction, {1, 0, 0}}, {GrainSource::longest, {}, "bar*"}};
  EXPECT_EQ(grain_of(grains, "bar 2").source, GrainSource::longest);  // by name goes before for all
  EXPECT_EQ(grain_of(grains, "door").source, GrainSource::direction);
  EXPECT_EQ(grain_of({}, "door").source, GrainSource::up);
  // The wall of a tube, with its rim picked: v runs around.
  UnwrapOptions options = options_of(UnwrapMethod::lscm);
  options.layout = UvLayout::tile;
  options.method.grains = {{GrainSource::edge_loop, {30, 0, 200}, "part"}};
  Scene scene = scene_of(test::cylinder(30, 80, 24, 6));
  scene = unwrap_scene(scene, options).scene;
  const TriangleMesh& mesh = scene.parts[0].mesh;
  std::size_t upright = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 in_space = mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k));
      const Vec2 edge = mesh.uv.values[mesh.uv.indices[t][(k + 1) % 3]] - mesh.uv.values[mesh.uv.indices[t][k]];
      if (std::hypot(in_space.x, in_space.y) > 1e-9) continue;
      EXPECT_NEAR(std::abs(edge.x), std::abs(in_space.z), 1e-6);
      ++upright;
    }
  EXPECT_GT(upright, 100U);
}

TEST(Unwrap, ASecondSetOfUvOverlapsNowhere) {
  UnwrapOptions options = options_of(UnwrapMethod::automatic);
  options.layout = UvLayout::tile;
  options.tile_mm = {20, 20};
  options.unique = UniqueUv{512, 3};
  options.density = {{"p*t", 2.0}};
  Scene scene = scene_of(test::torus(100, 30, 40, 20));
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "other";
  const UnwrapResult report = unwrap_scene(scene, options);
  scene = report.scene;
  ASSERT_TRUE(report.unique);
  EXPECT_GE(report.unique->gutter_px, 3);
  TriangleMesh both;
  CornerAttribute<Vec2> uv;
  std::vector<double> area;
  for (const Part& part : scene.parts) {
    const auto first = static_cast<Index>(both.positions.size()), first_uv = static_cast<Index>(uv.values.size());
    for (const Vec3& p : part.mesh.positions) both.positions.push_back(p + Vec3{0, 0, 1000.0 * first});
    for (const Triangle& t : part.mesh.triangles) both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    uv.values.insert(uv.values.end(), part.mesh.uv1.values.begin(), part.mesh.uv1.values.end());
    for (const Triangle& t : part.mesh.uv1.indices)
      uv.indices.push_back({first_uv + t[0], first_uv + t[1], first_uv + t[2]});
    area.push_back(measure_distortion(part.mesh, part.mesh.uv1).uv_area);
  }
  const DistortionReport r = measure_distortion(both, uv);
  EXPECT_EQ(r.overlapping_triangles, 0u);
  EXPECT_EQ(r.mirrored_charts, 0u);
  EXPECT_NEAR(area[0], 4 * area[1], 1e-9);  // twice the density
}

TEST(Unwrap, ChartsSayHowLevyAndMaillotMappedThem) {
  UnwrapOptions options = options_of(UnwrapMethod::levy);
  options.method.charts = ChartSource::keep;
  options.method.levy.solver = LevySolver::gauss_seidel;
  const Scene scene = scene_of(test::plane(40, 30, 8, 6));
  const UnwrapResult levy = unwrap_scene(scene, options);
  ASSERT_EQ(levy.parts[0].choices.size(), 1U);
  EXPECT_EQ(levy.parts[0].choices[0].method, "levy orthogonal");
  EXPECT_EQ(levy.parts[0].choices[0].reason, "the solver is Gauss-Seidel");
  options.method.method = UnwrapMethod::maillot;
  options.method.maillot.start = MaillotStart::planar;
  const UnwrapResult maillot = unwrap_scene(scene, options);
  ASSERT_EQ(maillot.parts[0].choices.size(), 1U);
  EXPECT_TRUE(maillot.parts[0].choices[0].reason.starts_with("from the planar map: E "));
}

TEST(Unwrap, PinsHoldTheNearestVertex) {
  UnwrapOptions options = options_of(UnwrapMethod::levy);
  options.layout = UvLayout::tile;
  options.method.charts = ChartSource::keep;
  options.method.pins = {{{0, 0, 0.1}, {5, 7}}, {{40, 30, 0}, {45, 37}}};
  Scene scene = scene_of(test::plane(40, 30, 8, 6));
  scene = unwrap_scene(scene, options).scene;
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, static_cast<int>(k));
      EXPECT_NEAR(mesh.uv.values[mesh.uv.indices[t][k]].x, p.x + 5, 1e-6);
      EXPECT_NEAR(mesh.uv.values[mesh.uv.indices[t][k]].y, p.y + 7, 1e-6);
    }
}

TEST(Unwrap, PinsAndIsoLinesOfOnePartLeaveTheOthersAlone) {
  UnwrapOptions options = options_of(UnwrapMethod::levy);
  options.layout = UvLayout::tile;
  options.method.charts = ChartSource::keep;
  options.method.pins = {{{0, 0, 0}, {0, 0}, "b*"}, {{40, 30, 0}, {60, 30}, "b*"}};
  options.method.iso_lines = {{{{20, 0, 0}, {20, 30, 0}}, true, 20, "b*"}};
  Scene scene = scene_of(test::plane(40, 30, 8, 6));
  scene.parts[0].name = "a";
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "board";
  scene = unwrap_scene(scene, options).scene;
  std::size_t on_line = 0;
  for (std::size_t t = 0; t < scene.parts[1].mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const TriangleMesh& mesh = scene.parts[1].mesh;
      const Vec3 p = mesh.corner(t, static_cast<int>(k));
      const Vec2 uv = mesh.uv.values[mesh.uv.indices[t][k]];
      if (p.x == 20) {
        EXPECT_NEAR(uv.x, 20, 1e-9);
        ++on_line;
      }
      if (p.x == 40 && p.y == 30) {
        EXPECT_NEAR(uv.x, 60, 1e-9);
        EXPECT_NEAR(uv.y, 30, 1e-9);
      }
    }
  EXPECT_GT(on_line, 12u);
  const DistortionReport untouched = measure_distortion(scene.parts[0].mesh, scene.parts[0].mesh.uv);
  EXPECT_NEAR(untouched.symmetric_dirichlet.max, 4, 1e-9);
}

TEST(PlacedConstraints, IsoLineTakesTheShortestPathOfEdges) {
  const TriangleMesh mesh = test::plane(4, 3, 4, 3);
  const LevyIsoLine line = iso_line_on(mesh, {{{0, 1, 0}, {4, 1, 0}}, false, {}, ""});
  ASSERT_EQ(line.vertices.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(mesh.positions[line.vertices[i]], (Vec3{static_cast<double>(i), 1, 0}));
  TriangleMesh apart = mesh;
  for (Vec3 p : {Vec3{10, 0, 0}, Vec3{11, 0, 0}, Vec3{10, 1, 0}}) apart.positions.push_back(p);
  const auto first = static_cast<Index>(mesh.positions.size());
  apart.triangles.push_back({first, first + 1, first + 2});
  EXPECT_THROW(iso_line_on(apart, {{{0, 1, 0}, {10, 0, 0}}, false, {}, ""}), InvalidInput);
}

TEST(Unwrap, ChartsAreChosenByTwoSeamCosts) {
  struct Outcome {
    double seam_mm, price;
  };
  const TriangleMesh mesh = test::spherical_cap(100, 1.2, 16, 32);
  const auto outcome = [&](std::optional<double> cost) {
    Scene scene = scene_of(mesh);
    UnwrapOptions options = options_of(UnwrapMethod::automatic);
    options.method.choose_seam_cost = !cost;
    options.method.segmentation.seam_cost = cost.value_or(0.5);
    const UnwrapResult unwrapped = unwrap_scene(scene, options);
    const double seam_mm = unwrapped.parts[0].seams.seam_mm;
    scene = unwrapped.scene;
    const DistortionReport r = measure_distortion(scene.parts[0].mesh, scene.parts[0].mesh.uv);
    return Outcome{seam_mm, (r.symmetric_dirichlet.mean - 4 + 1e-4) * std::pow(1 + seam_mm / std::sqrt(r.area_mm2), 5)};
  };
  const Outcome usual = outcome(0.03), generous = outcome(0.01), sparing = outcome(0.1), chosen = outcome({});
  EXPECT_NE(generous.seam_mm, sparing.seam_mm);
  EXPECT_LE(chosen.price, usual.price * (1 + 1e-9));
  EXPECT_TRUE(chosen.seam_mm == usual.seam_mm || chosen.seam_mm == generous.seam_mm ||
              chosen.seam_mm == sparing.seam_mm);
}

TEST(Unwrap, EdgesOfOpposedTrianglesAreCounted) {
  TriangleMesh mesh = test::plane(2, 2, 2, 2);
  mesh.uv = {};
  Scene straight = scene_of(mesh);
  EXPECT_EQ(unwrap_scene(straight, options_of(UnwrapMethod::best)).parts[0].opposed_edges, 0u);
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  Scene turned = scene_of(mesh);
  EXPECT_GE(unwrap_scene(turned, options_of(UnwrapMethod::best)).parts[0].opposed_edges, 1u);
}

TEST(Unwrap, KeepRefusesWhatIsNoSurface) {
  TriangleMesh mesh = test::plane(1, 1, 1, 1);
  mesh.uv = {};
  mesh.positions.push_back({0.5, 0.5, 1});
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], 4});
  UnwrapOptions options = options_of(UnwrapMethod::best);
  options.method.charts = ChartSource::keep;
  Scene scene = scene_of(mesh);
  try {
    unwrap_scene(scene, options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("edge ("), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("triangle["), std::string::npos) << error.what();
  }
}

TEST(DistortionReport, HistogramAddsUpAndColoursAreCorners) {
  Scene scene = scene_of(test::plane(4, 3, 4, 3));
  const SceneDistortion distortion = measure_scene(scene);
  for (const auto& histogram : {dirichlet_histogram, stretch_histogram, angle_histogram}) {
    const DistortionHistogram h = histogram(distortion.report);
    EXPECT_NEAR(std::accumulate(h.area_shares.begin(), h.area_shares.end(), 0.0), 1, 1e-12);
    EXPECT_NEAR(h.area_shares.front(), 1, 1e-12);  // an isometry
    EXPECT_EQ(h.area_shares.size(), h.upper_ends.size() + 1);
  }
  colour_by_distortion(distortion, 5, scene);
  ASSERT_EQ(scene.parts[0].mesh.colors.indices.size(), scene.parts[0].mesh.triangles.size());
  EXPECT_LT(scene.parts[0].mesh.colors.values[0].g, scene.parts[0].mesh.colors.values[0].b);  // dark blue
}

TEST(DistortionReport, NamesTheChartThatOwnsTheDistortion) {
  Scene scene = scene_of(test::plane(4, 3, 4, 3));
  EXPECT_FALSE(worst_chart(measure_scene(scene)));  // an isometry
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "bad";
  for (Vec2& p : scene.parts[1].mesh.uv.values) p.x *= 2;
  const std::optional<WorstChart> worst = worst_chart(measure_scene(scene));
  ASSERT_TRUE(worst);
  EXPECT_EQ(worst->part, 1U);
  EXPECT_LT(worst->triangle, scene.parts[1].mesh.triangles.size());
  // Areas 12 and 24 over 24 in space: stretched by f = √(2/3) and 2f beside f and f.
  const double f2 = 2.0 / 3, bad = 5 * f2 + 1.25 / f2, other = 2 * f2 + 2 / f2;
  EXPECT_NEAR(worst->mean, bad, 1e-9);
  EXPECT_NEAR(worst->share, (bad - 4) / (bad + other - 8), 1e-9);
}

}  // namespace
}  // namespace papilla
