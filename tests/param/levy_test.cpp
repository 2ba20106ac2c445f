// SPDX-License-Identifier: MIT
#include "papilla/param/levy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/reference_maps.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

LevyOptions convex(LevyWeights weights) {
  LevyOptions options;
  options.border = LevyBorder::convex;
  options.weights = weights;
  options.smoothness = 1;
  options.orthogonality = options.length = 0;
  return options;
}

/// The uv of each mesh vertex of a one-chart map.
std::vector<Vec2> per_vertex(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv) {
  std::vector<Vec2> result(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) result[mesh.triangles[t][k]] = uv.values[uv.indices[t][k]];
  return result;
}

TEST(Levy, DevelopableChartIsExact) {
  const TriangleMesh mesh = test::grid_mesh(64, 30, test::open_cylinder);
  const LevyResult r = flatten_levy(mesh, test::one_chart(mesh));
  EXPECT_TRUE(r.flattening.notes.empty());
  const DistortionReport d = measure_distortion(mesh, r.flattening.uv);
  EXPECT_LT(d.maillot_length, 1e-9);
  EXPECT_NEAR(d.symmetric_dirichlet.max, 4, 1e-6);
}

TEST(Levy, LengthConditionEvensOutScale) {
  const TriangleMesh mesh = test::hemisphere_mesh(30, 60);
  LevyOptions options;
  options.length = 0;
  const double conformal = measure_distortion(mesh, flatten_levy(mesh, test::one_chart(mesh), options).flattening.uv)
                               .symmetric_dirichlet.mean;
  options.length = 1;
  const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
  const double even = measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.mean;
  EXPECT_GT(conformal, 4.3);
  EXPECT_LT(even - 4, 0.55 * (conformal - 4));
  EXPECT_GT(r.length, 0);
}

TEST(Levy, LengthsAlongTheirDirectionsBeatEvenOnes) {
  const TriangleMesh mesh = test::grid_mesh(12, 60, test::grab_handle, 0.15);
  LevyOptions options;
  const auto energy = [&](int rounds) {
    options.length_rounds = rounds;
    const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
    EXPECT_TRUE(r.flattening.notes.empty());
    const Trace& trace = r.flattening.trace;
    EXPECT_EQ(trace.size(), static_cast<std::size_t>(rounds) + 1);
    for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_LT(trace[i].error, trace[i - 1].error);
    return measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.mean;
  };
  const double even = energy(0), once = energy(1);
  EXPECT_GT(even, 5);
  EXPECT_LT(once - 4, 0.2 * (even - 4));
  EXPECT_LT(energy(3), once);
}

TEST(Levy, RoundsOfLengthsEndWhereArapDoes) {
  const TriangleMesh mesh = test::dashboard_mesh(30, 12);
  LevyOptions options;
  options.length_rounds = 200;
  ReferenceOptions reference;
  reference.map = ReferenceMap::arap;
  reference.arap_iterations = 500;
  const auto energy = [&](const CornerAttribute<Vec2>& uv) {
    return measure_distortion(mesh, uv).symmetric_dirichlet.mean;
  };
  const double arap = energy(flatten_reference(mesh, test::one_chart(mesh), reference).uv);
  EXPECT_NEAR(energy(flatten_levy(mesh, test::one_chart(mesh), options).flattening.uv), arap, 0.01 * (arap - 4));
}

TEST(Levy, InteriorVerticesAreTheMeanOfTheirNeighbours) {
  const TriangleMesh mesh = test::saddle(10, 20, 4, 11);
  const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), convex(LevyWeights::uniform));
  EXPECT_LT(r.smoothness, 1e-20);
  const std::vector<Vec2> uv = per_vertex(mesh, r.flattening.uv);
  std::map<Index, std::map<Index, int>> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[t[k]][t[(k + 1) % 3]], ++edges[t[(k + 1) % 3]][t[k]];
  int interior = 0;
  for (const auto& [v, around] : edges) {
    Vec2 sum;
    bool border = false;
    for (const auto& [w, uses] : around) sum = sum + uv[w], border |= uses < 2;
    if (border) continue;
    ++interior;
    const Vec2 mean = (1 / static_cast<double>(around.size())) * sum;
    EXPECT_NEAR(mean.x, uv[v].x, 1e-9);
    EXPECT_NEAR(mean.y, uv[v].y, 1e-9);
  }
  EXPECT_EQ(interior, 34);
}

TEST(Levy, AgreesWithAnotherImplementation) {
  const TriangleMesh mesh = test::dashboard_mesh(30, 12);
  const auto distortion = [&](const CornerAttribute<Vec2>& uv) { return measure_distortion(mesh, uv); };
  const auto reference = [&](ReferenceMap map) {
    ReferenceOptions options;
    options.map = map;
    return distortion(flatten_reference(mesh, test::one_chart(mesh), options).uv);
  };
  const auto own = [&](LevyWeights weights) {
    return distortion(flatten_levy(mesh, test::one_chart(mesh), convex(weights)).flattening.uv);
  };
  const DistortionReport tutte = reference(ReferenceMap::tutte), uniform = own(LevyWeights::uniform);
  EXPECT_NEAR(uniform.symmetric_dirichlet.mean, tutte.symmetric_dirichlet.mean, 1e-5 * tutte.symmetric_dirichlet.mean);
  EXPECT_NEAR(uniform.maillot_length, tutte.maillot_length, 1e-5 * tutte.maillot_length);
  const DistortionReport floater = reference(ReferenceMap::mean_value), mean_value = own(LevyWeights::mean_value);
  EXPECT_NEAR(mean_value.maillot_length, floater.maillot_length, 1e-4 * floater.maillot_length);
}

TEST(Levy, DescentGoesWhereTheDirectSolutionIs) {
  const TriangleMesh mesh = test::saddle(10, 20, 4, 11);
  for (const LevyWeights weights : {LevyWeights::uniform, LevyWeights::cotangent, LevyWeights::mean_value}) {
    LevyOptions options = convex(weights);
    const std::vector<Vec2> direct = per_vertex(mesh, flatten_levy(mesh, test::one_chart(mesh), options).flattening.uv);
    options.solver = LevySolver::gauss_seidel;
    options.tolerance = 1e-14;
    options.max_sweeps = 20000;
    const LevyResult descent = flatten_levy(mesh, test::one_chart(mesh), options);
    const std::vector<Vec2> slow = per_vertex(mesh, descent.flattening.uv);
    for (std::size_t v = 0; v < direct.size(); ++v) {
      EXPECT_NEAR(slow[v].x, direct[v].x, 1e-3);
      EXPECT_NEAR(slow[v].y, direct[v].y, 1e-3);
    }
    EXPECT_LE(descent.flattening.trace.back().error, descent.flattening.trace.front().error);
  }
}

TEST(Levy, OrthogonalRoundsKeepAPlaneFlat) {
  const TriangleMesh mesh = test::plane(30, 20, 12, 8);
  LevyOptions options;
  options.coupling = LevyCoupling::orthogonal;
  for (const LevySolver solver : {LevySolver::direct, LevySolver::gauss_seidel}) {
    options.solver = solver;
    const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
    EXPECT_TRUE(r.flattening.notes.empty());
    EXPECT_NEAR(measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.mean, 4, 1e-6);
    EXPECT_LT(r.orthogonality + r.length, 1e-9);
  }
}

TEST(Levy, RoundsLowerTheSum) {
  const TriangleMesh mesh = test::hemisphere_mesh(12, 30);
  LevyOptions options;
  options.coupling = LevyCoupling::orthogonal;
  const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
  const Trace& trace = r.flattening.trace;
  ASSERT_GE(trace.size(), 2u);
  for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_LE(trace[i].error, trace[i - 1].error * (1 + 1e-9));
}

TEST(Levy, PinsKeepTheirPlaces) {
  const TriangleMesh mesh = test::dashboard_mesh(20, 8);
  for (const LevyCoupling coupling : {LevyCoupling::conformal, LevyCoupling::orthogonal}) {
    LevyOptions options;
    options.coupling = coupling;
    options.pins = {{0, {100, 50}}, {20, {1500, 80}}, {8 * 21, {60, 600}}};
    const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
    ASSERT_TRUE(r.flattening.notes.empty()) << r.flattening.notes.front().reason;
    const std::vector<Vec2> uv = per_vertex(mesh, r.flattening.uv);
    for (const LevyPin& pin : options.pins) {
      EXPECT_NEAR(uv[pin.vertex].x, pin.uv.x, 1e-6);
      EXPECT_NEAR(uv[pin.vertex].y, pin.uv.y, 1e-6);
    }
  }
}

TEST(Levy, IsoLinesShareACoordinate) {
  const TriangleMesh mesh = test::dashboard_mesh(20, 8);
  LevyOptions options;
  options.iso_lines.resize(2);
  options.iso_lines[0].is_u = true;
  options.iso_lines[0].value = 0.0;
  options.iso_lines[1].is_u = false;
  for (Index j = 0; j <= 8; ++j) options.iso_lines[0].vertices.push_back(21 * j);
  for (Index i = 0; i <= 20; ++i) options.iso_lines[1].vertices.push_back(i);
  options.pins = {{20, {1400, 0}}, {8 * 21, {0, 500}}};
  const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
  ASSERT_TRUE(r.flattening.notes.empty()) << r.flattening.notes.front().reason;
  const std::vector<Vec2> uv = per_vertex(mesh, r.flattening.uv);
  for (const Index v : options.iso_lines[0].vertices) EXPECT_NEAR(uv[v].x, 0, 1e-9);
  for (const Index v : options.iso_lines[1].vertices) EXPECT_NEAR(uv[v].y, 0, 1e-9);
}

TEST(Levy, IsoLinesAloneTurnTheMapAndLeaveItsScale) {
  const TriangleMesh mesh = test::dashboard_mesh(20, 8);
  const double plain =
      measure_distortion(mesh, flatten_levy(mesh, test::one_chart(mesh)).flattening.uv).symmetric_dirichlet.mean;
  for (const bool along_is_u : {false, true}) {
    LevyOptions options;
    options.iso_lines.resize(2);
    options.iso_lines[0].is_u = along_is_u;  // the long way, through the middle
    options.iso_lines[1].is_u = !along_is_u;
    options.iso_lines[1].value = 250.0;
    for (Index i = 0; i <= 20; ++i) options.iso_lines[0].vertices.push_back(21 * 4 + i);
    for (Index j = 0; j <= 8; ++j) options.iso_lines[1].vertices.push_back(21 * j);
    const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), options);
    ASSERT_TRUE(r.flattening.notes.empty()) << r.flattening.notes.front().reason;
    const std::vector<Vec2> uv = per_vertex(mesh, r.flattening.uv);
    double Vec2::*axis = along_is_u ? &Vec2::x : &Vec2::y;
    double Vec2::*other = along_is_u ? &Vec2::y : &Vec2::x;
    for (const Index v : options.iso_lines[0].vertices) EXPECT_NEAR(uv[v].*axis, uv[21 * 4].*axis, 1e-6);
    for (const Index v : options.iso_lines[1].vertices) EXPECT_NEAR(uv[v].*other, 250, 1e-6);
    EXPECT_NEAR(std::abs(uv[20].*other - 250), 1450, 60);  // 1400 wide, and crowned
    EXPECT_LT(measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.mean, plain + 0.2);
  }
}

/// F as the source writes it, from the uv alone: (4.25) with (4.27), (4.32) and the Y half of (4.35).
double sum_as_written(const TriangleMesh& mesh, const std::vector<Vec2>& uv) {
  const auto gradients = [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 p = mesh.positions[b] - mesh.positions[a], q = mesh.positions[c] - mesh.positions[a];
    const Vec3 n = cross(p, q);
    const Vec2 m = uv[b] - uv[a], k = uv[c] - uv[a];
    const auto gradient = [&](double by_p, double by_q) {
      return (by_p / dot(n, n)) * cross(q, n) + (by_q / dot(n, n)) * cross(n, p);
    };
    return std::array{gradient(m.x, k.x), gradient(m.y, k.y)};
  };
  std::map<Index, std::map<Index, int>> around;
  std::map<std::pair<Index, Index>, std::vector<std::size_t>> edges;
  double total = 0, area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges[std::minmax(a, b)].push_back(t);
      ++around[a][b], ++around[b][a];
    }
  const auto area_of = [&](std::size_t t) {
    return 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [du, dv] = gradients(t);
    area += area_of(t);
    total += area_of(t) * dot(du, dv) * dot(du, dv);
  }
  for (const auto& [v, ring] : around) {
    bool is_interior = true;
    Vec2 sum;
    for (const auto& [w, count] : ring) is_interior = is_interior && count == 2, sum = sum + (uv[w] - uv[v]);
    if (is_interior) total += dot(sum, sum);
  }
  for (const auto& [edge, sides] : edges) {
    if (sides.size() != 2) continue;
    const Vec3 along = normalized(mesh.positions[edge.second] - mesh.positions[edge.first]);
    std::array<Vec2, 2> across;  // derivatives away from the edge
    double h = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      Vec3 apex;
      for (const Index v : mesh.triangles[sides[k]])
        if (v != edge.first && v != edge.second) apex = mesh.positions[v];
      const Vec3 d = apex - mesh.positions[edge.first];
      const Vec3 away = normalized(d - dot(d, along) * along);
      const auto [du, dv] = gradients(sides[k]);
      across[k] = {dot(du, away), dot(dv, away)};
      h += norm(d - dot(d, along) * along) / 3;
    }
    const Vec2 jump = across[0] + across[1];
    total += 0.012 * area * (area_of(sides[0]) + area_of(sides[1])) / 3 * dot(jump, jump) / (h * h);
  }
  return total;
}

TEST(Levy, TheSourcesFunctionalIsWhatIsLowered) {
  const TriangleMesh mesh = test::saddle(10, 20, 4, 11);
  for (const LevyBorder border : {LevyBorder::convex, LevyBorder::released}) {
    const LevyResult r = flatten_levy(mesh, test::one_chart(mesh), levy_as_written(border, LevySolver::direct));
    ASSERT_TRUE(r.flattening.notes.empty()) << r.flattening.notes.front().reason;
    const Trace& trace = r.flattening.trace;
    ASSERT_GE(trace.size(), 3u);
    for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_LE(trace[i].error, trace[i - 1].error * (1 + 1e-9));
    EXPECT_LT(trace.back().error, 0.99 * trace.front().error);  // R = 0 is not the minimum of the whole
    EXPECT_NEAR(trace.back().error, r.smoothness + r.orthogonality + r.length, 1e-9 * trace.back().error);
  }
  const LevyResult convex = flatten_levy(mesh, test::one_chart(mesh), levy_as_written(LevyBorder::convex));
  const std::vector<Vec2> uv = per_vertex(mesh, convex.flattening.uv);
  // In the end the map is scaled to its chart's area and turned upright; the sum, in which turning counts, is that of
  // the circle of this area whose first border vertex lies at angle 0.
  const std::size_t n = uv.size(), border = 11;
  const Vec2 a = uv[n - 1], b = uv[n - 4], c = uv[n - 7];
  const double on = norm(b - a) * norm(c - b) * norm(a - c) / (2 * std::abs(cross(b - a, c - a)));
  const Vec2 p = b - a, q = c - a;
  const Vec2 middle =
      a + (0.5 / cross(p, q)) * Vec2{dot(p, p) * q.y - dot(q, q) * p.y, dot(q, q) * p.x - dot(p, p) * q.x};
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area += 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  double least_miss = 1e300;
  for (std::size_t first = n - border; first < n; ++first) {
    const Vec2 x = (1 / on) * (uv[first] - middle);
    std::vector<Vec2> solved;
    for (const Vec2 own : uv) {
      const Vec2 d = (std::sqrt(area / std::numbers::pi) / on) * (own - middle);
      solved.push_back({dot(x, d), cross(x, d)});
    }
    least_miss = std::min(least_miss, std::abs(sum_as_written(mesh, solved) - convex.flattening.trace.back().error));
  }
  EXPECT_LT(least_miss, 1e-6 * convex.flattening.trace.back().error);
}

TEST(Levy, TheSourcesDescentGoesWhereDirectRoundsGo) {
  const TriangleMesh mesh = test::saddle(10, 20, 4, 9);
  for (const LevyBorder border : {LevyBorder::convex, LevyBorder::released}) {
    LevyOptions direct = levy_as_written(border, LevySolver::direct), descent = levy_as_written(border);
    direct.tolerance = descent.tolerance = 1e-12;
    direct.max_rounds = descent.max_rounds = 3000;
    const double least = flatten_levy(mesh, test::one_chart(mesh), direct).flattening.trace.back().error;
    const double reached = flatten_levy(mesh, test::one_chart(mesh), descent).flattening.trace.back().error;
    EXPECT_NEAR(reached, least, 1e-3 * least);
  }
}

TEST(Levy, SaysWhichCouplingAChartGot) {
  const TriangleMesh mesh = test::dashboard_mesh(20, 8);
  const auto choice = [&](const LevyOptions& options) {
    const std::vector<ChartChoice> choices = flatten_levy(mesh, test::one_chart(mesh), options).choices;
    EXPECT_EQ(choices.size(), 1u);
    return choices.front().method + ": " + choices.front().reason;
  };
  LevyOptions options;
  EXPECT_EQ(choice(options), "levy conformal: one linear system");
  options.solver = LevySolver::gauss_seidel;
  EXPECT_EQ(choice(options), "levy orthogonal: the solver is Gauss-Seidel");
  options = {};
  options.border = LevyBorder::convex;
  EXPECT_EQ(choice(options), "levy orthogonal: the border is not free from the start");
  options.coupling = LevyCoupling::orthogonal;
  EXPECT_EQ(choice(options), "levy orthogonal: as asked");
  EXPECT_EQ(choice(convex(LevyWeights::uniform)), "levy smooth: smoothness alone has a weight");
  options = {};
  options.iso_lines.push_back({{0, 1, 2}, false, {}});
  EXPECT_EQ(choice(options), "levy orthogonal: iso lines are held");
}

TEST(Levy, AChartWithOnePinIsTheFreeMapMovedThere) {
  // Two plates; each has one of the two pins.
  TriangleMesh mesh = test::dashboard_mesh(12, 6);
  const auto vertices = static_cast<Index>(mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  for (Index v = 0; v < vertices; ++v) mesh.positions.push_back(mesh.positions[v] + Vec3{0, 3000, 0});
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({a + vertices, b + vertices, c + vertices});
  }
  ChartSet charts{std::vector<std::uint32_t>(2 * triangles, 0), 2};
  std::fill(charts.of_triangle.begin() + static_cast<std::ptrdiff_t>(triangles), charts.of_triangle.end(), 1);
  LevyOptions options;
  const std::vector<Vec2> plain = per_vertex(mesh, flatten_levy(mesh, charts, options).flattening.uv);
  options.coupling = LevyCoupling::conformal;
  options.pins = {{3, {100, 50}}, {vertices + 5, {-700, 900}}};
  const LevyResult r = flatten_levy(mesh, charts, options);
  ASSERT_TRUE(r.flattening.notes.empty()) << r.flattening.notes.front().reason;
  const std::vector<Vec2> uv = per_vertex(mesh, r.flattening.uv);
  for (Index v = 0; v < 2 * vertices; ++v) {
    const LevyPin& pin = options.pins[v < vertices ? 0 : 1];
    const Vec2 expected = plain[v] - plain[pin.vertex] + pin.uv;
    EXPECT_NEAR(uv[v].x, expected.x, 1e-6);
    EXPECT_NEAR(uv[v].y, expected.y, 1e-6);
  }
}

TEST(Levy, BadInputIsNamed) {
  const TriangleMesh mesh = test::plane(2, 2, 2, 2);
  const ChartSet chart = test::one_chart(mesh);
  const auto refused = [&](const LevyOptions& options, const std::string& word) {
    try {
      flatten_levy(mesh, chart, options);
      ADD_FAILURE() << word;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  LevyOptions options;
  options.pins = {{0, {0, 0}}, {1, {0, 0}}};
  refused(options, "on top of");
  options.pins = {{0, {0, 0}}, {0, {1, 1}}};
  refused(options, "on top of");
  options.pins = {{0, {0, 0}}};
  refused(options, "two pins");
  options.pins = {{0, {0, 0}}, {1, {1, 0}}};
  refused(options, "two pins");
  options.pins = {{99, {0, 0}}};
  refused(options, "99");
  options = {};
  options.orthogonality = options.length = 0;
  refused(options, "weights are 0");
  options = {};
  options.length = -1;
  refused(options, "length");
  options = {};
  options.length_rounds = -1;
  refused(options, "length_rounds");
  options = {};
  options.coupling = LevyCoupling::conformal;
  options.border = LevyBorder::convex;
  refused(options, "the coupling can't be conformal, the border is not free");
  options.border = LevyBorder::free;
  options.solver = LevySolver::gauss_seidel;
  refused(options, "the coupling can't be conformal, the solver is Gauss-Seidel");
  options.solver = LevySolver::direct;
  options.iso_lines.push_back({{0, 1}, true, {}});
  refused(options, "the coupling can't be conformal, iso lines are held");
  options = {};
  options.border = LevyBorder::released;
  options.smoothness = 1, options.orthogonality = options.length = 0;
  refused(options, "released border");
  EXPECT_TRUE(flatten_levy({}, {}).flattening.uv.empty());
}

}  // namespace
}  // namespace papilla
