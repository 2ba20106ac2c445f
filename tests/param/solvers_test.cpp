// SPDX-License-Identifier: MIT
// What the maps are made of: energies against finite differences, the factorization against the matrix it factors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <set>

#include "border_guard.hpp"
#include "convex_map.hpp"
#include "disk_hierarchy.hpp"
#include "maillot_energy.hpp"
#include "map_descent.hpp"
#include "papilla_test/shapes.hpp"
#include "sparse_cholesky.hpp"
#include "support/formula_meshes.hpp"
#include "tube_map.hpp"

namespace papilla::param_detail {
namespace {

/// A mesh with a map that is neither isometric nor flipped.
struct Sample {
  TriangleMesh mesh = test::spherical_cap(2, 0.9, 3, 7);
  std::vector<RestShape> rest = rest_shapes(mesh.positions, mesh.triangles);
  std::vector<Vec2> uv;
  Sample() {
    for (const Vec3& p : mesh.positions) uv.push_back({1.2 * p.x + 0.1 * p.y * p.y, 0.9 * p.y - 0.2 * p.x});
  }
};

void expect_gradient_is_derivative(const DescentProblem& problem, std::vector<Vec2> uv) {
  const std::vector<Vec2> gradient = energy_gradient(problem, uv);
  const double step = 1e-5;
  for (std::size_t v = 0; v < uv.size(); ++v)
    for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
      const double at = uv[v].*axis;
      uv[v].*axis = at + step;
      const double ahead = total_energy(problem, uv);
      uv[v].*axis = at - step;
      const double behind = total_energy(problem, uv);
      uv[v].*axis = at;
      EXPECT_NEAR(gradient[v].*axis, (ahead - behind) / (2 * step), 1e-6 * (1 + std::abs(gradient[v].*axis)));
    }
}

TEST(Energies, GradientsAreDerivatives) {
  const Sample s;
  const SymmetricDirichlet dirichlet(s.rest);
  expect_gradient_is_derivative({s.mesh.triangles, &dirichlet}, s.uv);
  for (const double phi : {0.0, 0.3, 1.0}) {
    const MaillotEnergy maillot(s.mesh.positions, s.mesh.triangles, phi);
    expect_gradient_is_derivative({s.mesh.triangles, &maillot}, s.uv);
  }
}

void expect_hessian_is_derivative(double scale, double raised) {
  const Sample s;
  const SymmetricDirichlet energy(s.rest);
  std::vector<Vec2> uv = s.uv;
  for (Vec2& p : uv) p = scale * p;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    const auto [a, b, c] = s.mesh.triangles[t];
    std::array<Vec2, 3> at{uv[a], uv[b], uv[c]};
    CornerHessian h;
    energy.hessian(t, at[0], at[1], at[2], raised, h.data());
    const double step = 1e-6;
    for (std::size_t j = 0; j < 6; ++j) {
      double& x = j % 2 == 0 ? at[j / 2].x : at[j / 2].y;
      const double before = x;
      x = before + step;
      const CornerGradient ahead = energy.gradient(t, at[0], at[1], at[2]);
      x = before - step;
      const CornerGradient behind = energy.gradient(t, at[0], at[1], at[2]);
      x = before;
      for (std::size_t i = j; i < 6; ++i) {
        const auto part = [&](const CornerGradient& g) { return i % 2 == 0 ? g[i / 2].x : g[i / 2].y; };
        EXPECT_NEAR(h[6 * j + i], (part(ahead) - part(behind)) / (2 * step), 1e-4);
      }
    }
  }
}

TEST(Energies, DirichletHessianIsTheDerivative) {
  expect_hessian_is_derivative(2, 1);  // stretched maps have no negative curvature
  expect_hessian_is_derivative(0.8, 0);
}

/// Where lengths and areas are kept, what the descent leaves out of the second derivative is 0.
TEST(Energies, MaillotHessianIsTheDerivativeOfAnIsometry) {
  const std::vector<Vec3> positions{{0, 0, 0}, {3, 0, 0}, {1, 4, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  for (const double phi : {0.0, 0.4, 1.0}) {
    const MaillotEnergy energy(positions, triangles, phi);
    std::array<Vec2, 3> at{Vec2{0, 0}, Vec2{3, 0}, Vec2{1, 4}};
    CornerHessian h;
    energy.hessian(0, at[0], at[1], at[2], 1, h.data());
    const double step = 1e-6;
    for (std::size_t j = 0; j < 6; ++j) {
      double& x = j % 2 == 0 ? at[j / 2].x : at[j / 2].y;
      const double before = x;
      x = before + step;
      const CornerGradient ahead = energy.gradient(0, at[0], at[1], at[2]);
      x = before - step;
      const CornerGradient behind = energy.gradient(0, at[0], at[1], at[2]);
      x = before;
      for (std::size_t i = 0; i < 6; ++i) {
        const auto part = [&](const CornerGradient& g) { return i % 2 == 0 ? g[i / 2].x : g[i / 2].y; };
        EXPECT_NEAR(h[6 * j + i], (part(ahead) - part(behind)) / (2 * step), 1e-6) << phi << ' ' << j << ' ' << i;
      }
    }
  }
}

TEST(Energies, MaillotOfOneTriangleByHand) {
  const std::vector<Vec3> positions{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const std::vector<Vec2> uv{{0, 0}, {2, 0}, {0, 4}};
  const MaillotEnergy lengths(positions, triangles, 1), areas(positions, triangles, 0);
  // d² = 4, 20, 16; D² = 9, 25, 16; det = 8, A = 12
  EXPECT_NEAR(total_energy({triangles, &lengths}, uv), 25.0 / 9 + 25.0 / 25, 1e-12);
  EXPECT_NEAR(total_energy({triangles, &areas}, uv), 16.0 / 12, 1e-12);
}

TEST(Energies, EveryEdgeCountsOnce) {
  const TriangleMesh mesh = test::plane(4, 3, 4, 3);
  const MaillotEnergy lengths(mesh.positions, mesh.triangles, 1);
  std::vector<Vec2> uv;
  for (const Vec3& p : mesh.positions) uv.push_back({std::sqrt(2.0) * p.x, std::sqrt(2.0) * p.y});
  // d² = 2 D², so every edge gives D²: 31 of length 1 and 12 diagonals of squared length 2.
  EXPECT_NEAR(total_energy({mesh.triangles, &lengths}, uv), 31 + 24, 1e-9);
}

TEST(Energies, FlippedTrianglesAreInfinite) {
  const Sample s;
  const SymmetricDirichlet energy(s.rest);
  std::vector<Vec2> mirrored = s.uv;
  for (Vec2& p : mirrored) p.x = -p.x;
  EXPECT_TRUE(std::isinf(total_energy({s.mesh.triangles, &energy}, mirrored)));
}

TEST(Descent, StepEndsAtTheFirstFlip) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const std::vector<Vec2> uv{{0, 0}, {1, 0}, {0, 1}}, down{{0, 0}, {0, 0}, {0, -4}}, up{{0, 0}, {0, 0}, {0, 4}};
  EXPECT_NEAR(step_to_first_flip(triangles, uv, down), 0.25, 1e-12);
  EXPECT_TRUE(std::isinf(step_to_first_flip(triangles, uv, up)));
  // Two corners that change places collapse the triangle half way.
  const std::vector<Vec2> turn{{0, 0}, {-1, 1}, {1, -1}};
  EXPECT_NEAR(step_to_first_flip(triangles, uv, turn), 0.5, 1e-12);
}

/// Half the squares of the distances to three places, with a Hessian that is ten times too large.
class StiffModel final : public MapEnergy {
 public:
  static constexpr std::array<Vec2, 3> k_places{{{1, 2}, {5, 2}, {1, 6}}};
  double value(std::size_t, Vec2 a, Vec2 b, Vec2 c) const override {
    const CornerGradient g = gradient(0, a, b, c);
    return 0.5 * (dot(g[0], g[0]) + dot(g[1], g[1]) + dot(g[2], g[2])) + 1;
  }
  CornerGradient gradient(std::size_t, Vec2 a, Vec2 b, Vec2 c) const override {
    return {a - k_places[0], b - k_places[1], c - k_places[2]};
  }
  void hessian(std::size_t, Vec2, Vec2, Vec2, double, double* matrix) const override {
    for (std::size_t i = 0; i < 36; ++i) matrix[i] = i % 7 == 0 ? 10 : 0;
  }
};

TEST(Descent, GoesFurtherWhereTheModelBendsTooMuch) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const StiffModel energy;
  std::vector<Vec2> uv{{0, 0}, {3, 0}, {0, 3}};
  const DescentResult result = descend({triangles, &energy}, uv, {.tolerance = 1e-9});
  for (std::size_t v = 0; v < 3; ++v) EXPECT_LT(norm(uv[v] - StiffModel::k_places[v]), 1e-3);
  EXPECT_NEAR(result.energy, 1, 1e-6);
  EXPECT_LT(result.iterations, 10);  // steps as long as the model says gain a fifth each
}

TEST(Descent, OfTheLogarithmIsFasterFarFromTheMinimum) {
  const Sample s;
  const SymmetricDirichlet energy(s.rest);
  double area = 0;
  for (const RestShape& rest : s.rest) area += rest.area;
  const auto run = [&](bool of_logarithm) {
    std::vector<Vec2> uv = s.uv;
    for (Vec2& p : uv) p = 1e-6 * p;  // the energy is 1e12 times too large
    return descend({s.mesh.triangles, &energy}, uv, {.tolerance = 1e-6, .of_logarithm = of_logarithm});
  };
  // Newton's step takes x⁻² to (4/3 x)⁻², that for the logarithm to (2 x)⁻².
  const DescentResult plain = run(false), quick = run(true);
  EXPECT_LT(quick.iterations, 0.65 * plain.iterations);
  EXPECT_NEAR(quick.energy, plain.energy, 1e-4 * plain.energy);
  EXPECT_LT(quick.energy, 4.5 * area);
}

MapLevel whole_level(const TriangleMesh& mesh) {
  const DiskHierarchy all(mesh.positions, mesh.triangles, mesh.positions.size());
  const std::vector<Vec2> nowhere(mesh.positions.size());
  return current_level(all, mesh.positions, nowhere, {});
}

TEST(ConvexMap, DeepDisksStayOpen) {
  // The hole of this sphere is 75 times narrower than the disk is deep; under a uniform pull, the smallest triangle
  // would be 6e-11 of the mean.
  const TriangleMesh mesh = test::sphere_mesh(60, 24, 3.1, [](Vec3) { return 1.0; });
  const MapLevel level = whole_level(mesh);
  const std::vector<Vec2> uv = map_to_circle(level, mesh.positions);
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (const auto& [a, b, c] : level.triangles) {
    const double doubled = cross(uv[b] - uv[a], uv[c] - uv[a]);
    least = std::min(least, doubled), sum += doubled;
  }
  EXPECT_GT(least, 1e-5 * sum / static_cast<double>(level.triangles.size()));
}

TEST(TubeMap, EndsAreCounted) {
  const auto spiky = [](std::vector<Vec3> spikes) {
    const TriangleMesh mesh = test::sphere_mesh(40, 40, 2.6, [&](Vec3 d) {
      double radius = 1;
      for (const Vec3 s : spikes) radius += 3 * std::exp(-20 * dot(d - s, d - s));
      return radius;
    });
    return has_one_end(whole_level(mesh), mesh.positions);
  };
  EXPECT_TRUE(spiky({}));
  EXPECT_TRUE(spiky({{0, 0, 1}}));
  EXPECT_FALSE(spiky({{0.8, 0, 0.6}, {-0.8, 0, 0.6}}));
}

TEST(TubeMap, IsValidAndNeedsARing) {
  // The hole is 75 times narrower than the disk is deep.
  const TriangleMesh sphere = test::sphere_mesh(60, 24, 3.1, [](Vec3) { return 1.0; });
  const MapLevel level = whole_level(sphere);
  const std::optional<TubeMap> tube = map_tube(level, sphere.positions);
  ASSERT_TRUE(tube);
  for (const auto& [a, b, c] : level.triangles)
    EXPECT_GT(cross(tube->uv[b] - tube->uv[a], tube->uv[c] - tube->uv[a]), 0);
  TriangleMesh fan;
  fan.positions = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
  fan.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  EXPECT_FALSE(map_tube(whole_level(fan), fan.positions));
}

TEST(Descent, ByRingsFindsTheRadii) {
  // A flat disk of rings whose radii are wrong.
  const TriangleMesh mesh = test::sphere_mesh(20, 60, 1.0, [](Vec3 d) { return 1 / d.z; });
  const MapLevel level = whole_level(mesh);
  const SymmetricDirichlet energy(level.rest);
  const DescentProblem problem{level.triangles, &energy, nullptr};
  const double outer = std::tan(1.0);
  RingScales scales{{}, 12};
  std::vector<Vec2> uv;
  for (const Index v : level.vertices) {
    const Vec3 p = mesh.positions[v];
    const double radius = std::hypot(p.x, p.y), at = std::min(radius / outer, 1 - 1e-9) * 11;
    const auto inner = static_cast<Index>(at);
    scales.place.push_back({inner, at - inner});
    uv.push_back((0.3 + 0.5 * radius) * Vec2{p.x, p.y});
  }
  ASSERT_GT(total_energy(problem, uv), 4.5 * level.area);
  const DescentResult result = descend_by_rings(problem, scales, uv, {.tolerance = 1e-6});
  EXPECT_EQ(result.stop, StopReason::converged);
  EXPECT_NEAR(result.energy, 4 * level.area, 1e-2 * level.area);
  EXPECT_NEAR(result.energy, total_energy(problem, uv), 1e-9 * level.area);
  // Directions from the middle stay.
  for (std::size_t v = 0; v < uv.size(); ++v)
    EXPECT_NEAR(cross(uv[v], Vec2{mesh.positions[level.vertices[v]].x, mesh.positions[level.vertices[v]].y}), 0, 1e-9);
}

TEST(Descent, ForeseesTheEnd) {
  const Sample s;
  const SymmetricDirichlet energy(s.rest);
  const auto run = [&](bool foresee) {
    std::vector<Vec2> uv = s.uv;
    return descend({s.mesh.triangles, &energy}, uv, {.tolerance = 1e-3, .foresee = foresee});
  };
  const DescentResult to_the_end = run(false), foreseen = run(true);
  EXPECT_EQ(foreseen.stop, StopReason::converged);
  EXPECT_LT(foreseen.iterations, to_the_end.iterations);
  EXPECT_LT(foreseen.energy, (1 + 1e-3) * to_the_end.energy);
}

template <class Scalar>
void expect_solution(int width, const TriangleMesh& mesh = test::dashboard_mesh(23, 17)) {
  const auto size = static_cast<std::size_t>(3 * width);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::vector<std::vector<Scalar>> matrices(mesh.triangles.size(), std::vector<Scalar>(size * size));
  for (auto& m : matrices)
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t i = j; i < size; ++i) {
        Scalar value = uniform(generator);
        if constexpr (!std::is_same_v<Scalar, double>) value += Scalar(0, i == j ? 0 : uniform(generator));
        if (i == j) value = 4;
        m[size * j + i] = value;
        if constexpr (std::is_same_v<Scalar, double>)
          m[size * i + j] = value;
        else
          m[size * i + j] = std::conj(value);
      }
  SparseCholesky<Scalar> factor(elements_of(mesh.triangles), mesh.positions, width);
  const auto w = static_cast<std::size_t>(width);
  std::vector<Scalar> x(w * mesh.positions.size()), b(x.size(), Scalar(0));
  for (Scalar& v : x) v = uniform(generator);
  for (std::size_t t = 0; t < matrices.size(); ++t)
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j)
        b[w * mesh.triangles[t][i / w] + i % w] += matrices[t][size * j + i] * x[w * mesh.triangles[t][j / w] + j % w];
  for (int round = 0; round < 2; ++round) {  // the structure serves again
    std::vector<Scalar> solution = b;
    EXPECT_EQ(factor.factor([&](std::size_t t, Scalar* m) { std::copy(matrices[t].begin(), matrices[t].end(), m); }),
              0u);
    factor.solve(solution);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(std::abs(solution[i] - x[i]), 1e-12);
  }
}

TEST(SparseCholesky, SolvesWhatItFactored) {
  expect_solution<double>(1);
  expect_solution<double>(2);
  expect_solution<std::complex<double>>(1);
}

TEST(SparseCholesky, SolvesInParallelBranches) {
  expect_solution<double>(2, test::dashboard_mesh(190, 70));  // oblong, halves of 6,500 vertices
}

TEST(Dissect, BranchesAreCoupledByTheirSeparatorsAlone) {
  const TriangleMesh mesh = test::dashboard_mesh(190, 70);
  const Elements elements = elements_of(mesh.triangles);
  const Dissection dissection = dissect(elements, mesh.positions, 24);
  std::vector<Index> sorted = dissection.order;
  std::sort(sorted.begin(), sorted.end());
  for (Index v = 0; v < sorted.size(); ++v) ASSERT_EQ(sorted[v], v);
  ASSERT_EQ(sorted.size(), mesh.positions.size());
  Index begin = 0;
  for (Index f = 0; f < dissection.fronts.size(); ++f) {
    const Front& front = dissection.fronts[f];
    EXPECT_EQ(front.begin, begin);
    begin = front.end;
    for (const Index child : {front.left, front.right})
      if (child != k_no_front) {
        EXPECT_LT(child, f);
        EXPECT_EQ(dissection.fronts[child].parent, f);
      }
  }
  EXPECT_EQ(begin, mesh.positions.size());
  // An element lies in one branch: the fronts of its vertices are ancestors of one another.
  std::vector<Index> front_of(mesh.positions.size());
  for (Index f = 0; f < dissection.fronts.size(); ++f)
    for (Index i = dissection.fronts[f].begin; i < dissection.fronts[f].end; ++i) front_of[i] = f;
  for (const Triangle& t : mesh.triangles) {
    std::array<Index, 3> fronts;
    for (std::size_t k = 0; k < 3; ++k) fronts[k] = front_of[dissection.position[t[k]]];
    std::sort(fronts.begin(), fronts.end());
    Index f = fronts[0];
    for (const Index above : fronts)
      while (f != above) {
        ASSERT_NE(f, k_no_front);
        f = dissection.fronts[f].parent;
      }
  }
}

TEST(SparseCholesky, PivotsThatAreNotPositiveAreCountedAndHeld) {
  Elements elements;
  elements.add(std::array<Index, 1>{0});
  elements.add(std::array<Index, 1>{1});
  const std::vector<Vec3> where{{0, 0, 0}, {1, 0, 0}};
  SparseCholesky<double> factor(elements, where, 1);
  EXPECT_EQ(factor.factor([](std::size_t e, double* m) { *m = e == 0 ? 2 : -1; }), 1u);
  std::vector<double> b{4, 5};
  factor.solve(b);
  EXPECT_NEAR(b[0], 2, 1e-12);
  EXPECT_NEAR(b[1], 0, 1e-100);
}

/// Every edge has two triangles at most and runs through them in both directions, and the Euler number is a disk's.
void expect_disk(const DiskHierarchy& hierarchy) {
  std::set<std::pair<Index, Index>> halfedges;
  std::size_t alive = 0, border = 0;
  for (Index t = 0; t < hierarchy.triangles().size(); ++t) {
    if (!hierarchy.alive(t)) continue;
    ++alive;
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_TRUE(halfedges.insert({hierarchy.triangles()[t][k], hierarchy.triangles()[t][(k + 1) % 3]}).second)
          << "an edge is there twice in one direction, with " << hierarchy.vertex_count() << " vertices";
  }
  for (const auto& [from, to] : halfedges) border += !halfedges.contains({to, from});
  ASSERT_GE(border, 3u);
  ASSERT_EQ(hierarchy.vertex_count() + alive, (halfedges.size() + border) / 2 + 1);
}

TEST(DiskHierarchy, IsADiskOnTheWayAndGoesBackToTheMeshItCameFrom) {
  for (const TriangleMesh& mesh : {test::dashboard_mesh(20, 10), test::hemisphere_mesh(20, 40),
                                   test::grid_mesh(12, 40, test::grab_handle, 0.15)}) {
    DiskHierarchy hierarchy(mesh.positions, mesh.triangles, 10);
    EXPECT_LT(hierarchy.vertex_count(), 40u);
    while (hierarchy.removed_count() > 0) {
      expect_disk(hierarchy);
      if (HasFatalFailure()) return;
      for (int i = 0; i < 20 && hierarchy.removed_count() > 0; ++i) hierarchy.restore();
    }
    EXPECT_TRUE(std::ranges::equal(hierarchy.triangles(), mesh.triangles));
    EXPECT_EQ(hierarchy.vertex_count(), mesh.positions.size());
  }
}

TEST(DiskHierarchy, RemovalsThatLieApartComeBackTogether) {
  const TriangleMesh mesh = test::hemisphere_mesh(30, 60);
  DiskHierarchy together(mesh.positions, mesh.triangles, 10), alone(mesh.positions, mesh.triangles, 10);
  std::size_t most = 0;
  while (together.removed_count() > 0) {
    const std::size_t count = together.apart();
    ASSERT_GE(count, 1U);
    most = std::max(most, count);
    std::set<Index> triangles;
    for (const Removal& removal : together.restore(count))
      for (const Index t : together.around(removal)) EXPECT_TRUE(triangles.insert(t).second);
    for (std::size_t i = 0; i < count; ++i) alone.restore();
    ASSERT_EQ(together.removed_count(), alone.removed_count());
    ASSERT_EQ(together.vertex_count(), alone.vertex_count());
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      ASSERT_EQ(together.alive(t), alone.alive(t));
      if (alone.alive(t)) {
        ASSERT_EQ(together.triangles()[t], alone.triangles()[t]);
      }
    }
  }
  EXPECT_GT(most, 200U);
}

TEST(DiskHierarchy, RemoveAgainUndoesRestore) {
  const TriangleMesh mesh = test::hemisphere_mesh(6, 12);
  DiskHierarchy hierarchy(mesh.positions, mesh.triangles, 10);
  const std::vector<Triangle> coarse = hierarchy.triangles();
  const std::size_t vertices = hierarchy.vertex_count(), removed = hierarchy.removed_count();
  while (hierarchy.removed_count() > 0) hierarchy.restore();
  while (hierarchy.removed_count() < removed) hierarchy.remove_again();
  EXPECT_EQ(hierarchy.vertex_count(), vertices);
  for (Index t = 0; t < coarse.size(); ++t)
    if (hierarchy.alive(t)) {
      EXPECT_EQ(hierarchy.triangles()[t], coarse[t]);
    }
}

/// A square with a notch that nearly closes: vertices 3 and 5 face each other.
struct Notch {
  std::vector<BorderPair> border;
  std::vector<Vec2> uv{{0, 0}, {10, 0}, {10, 10}, {5.2, 10}, {5, 2}, {4.8, 10}, {0, 10}};
  Notch() {
    for (Index v = 0; v < uv.size(); ++v) border.push_back({v, (v + 1) % static_cast<Index>(uv.size())});
  }
};

TEST(BorderGuard, SeesEdgesMeet) {
  const Notch notch;
  BorderGuard guard(notch.border, notch.uv);
  EXPECT_TRUE(guard.may_move(3, {5.1, 10}));
  EXPECT_FALSE(guard.may_move(3, {4.5, 9}));
  guard.move(5, {3, 10});
  EXPECT_TRUE(guard.may_move(3, {4.5, 9.5}));
  std::vector<Vec2> uv = notch.uv;
  uv.push_back({5, -1});
  BorderGuard splitting(notch.border, uv);
  EXPECT_TRUE(splitting.may_split(0, 1, 7, {5, -1}));
  EXPECT_FALSE(splitting.may_split(0, 1, 7, {5, 5}));  // through the notch
  splitting.split(0, 1, 7, {5, -1});
  EXPECT_TRUE(splitting.on_border(7));
  EXPECT_FALSE(splitting.may_move(4, {5, -0.999}));
}

TEST(BorderBarrier, GradientIsTheDerivative) {
  Notch notch;
  notch.uv[3] = {5.05, 10}, notch.uv[5] = {4.95, 9.9}, notch.uv[4] = {5, 9.5};
  const BorderBarrier barrier(notch.border, notch.uv, 0.7);
  const auto pairs = barrier.near_pairs(notch.uv);
  ASSERT_FALSE(pairs.empty());
  for (const auto& pair : pairs) {
    const auto gradient = barrier.gradient(pair, notch.uv);
    const std::array<Index, 3> members{pair.vertex, pair.from, pair.to};
    for (std::size_t k = 0; k < 3; ++k)
      for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
        std::vector<Vec2> uv = notch.uv;
        uv[members[k]].*axis += 1e-7;
        const double ahead = barrier.value(pair, uv);
        uv[members[k]].*axis -= 2e-7;
        const double behind = barrier.value(pair, uv);
        EXPECT_NEAR(gradient[k].*axis, (ahead - behind) / 2e-7, 1e-4 * (1 + std::abs(gradient[k].*axis)));
      }
  }
}

}  // namespace
}  // namespace papilla::param_detail
