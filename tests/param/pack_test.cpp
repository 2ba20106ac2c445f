// SPDX-License-Identifier: MIT
#include "papilla/param/pack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/triplanar.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

struct Rectangles {
  TriangleMesh mesh;
  CornerAttribute<Vec2> uv;
  ChartSet charts;
};

/// One chart of two triangles per size, all at the origin.
Rectangles rectangles(const std::vector<Vec2>& sizes) {
  Rectangles r;
  for (const Vec2 size : sizes) {
    const auto first = static_cast<Index>(r.mesh.positions.size());
    for (const Vec2 p : {Vec2{0, 0}, Vec2{size.x, 0}, size, Vec2{0, size.y}}) {
      r.mesh.positions.push_back({p.x, p.y, 1000.0 * r.charts.count});
      r.uv.values.push_back(p);
    }
    r.mesh.triangles.insert(r.mesh.triangles.end(),
                            {Triangle{first, first + 1, first + 2}, Triangle{first, first + 2, first + 3}});
    r.charts.of_triangle.insert(r.charts.of_triangle.end(), 2, r.charts.count++);
  }
  r.uv.indices = r.mesh.triangles;
  return r;
}

std::vector<Vec2> random_sizes(int count) {
  std::mt19937 generator(3);
  std::vector<Vec2> sizes;
  for (int i = 0; i < count; ++i)
    sizes.push_back({1 + static_cast<double>(generator() % 100), 1 + static_cast<double>(generator() % 40)});
  return sizes;
}

TEST(PackAtlas, EqualSquaresFillASquare) {
  const Rectangles r = rectangles(std::vector<Vec2>(16, {5, 5}));
  const Atlas atlas = pack_atlas(r.uv, r.charts, {.gutter_mm = 0});
  EXPECT_NEAR(atlas.fill_rate, 1, 1e-12);
  EXPECT_NEAR(atlas.size_mm.x, 20, 1e-9);
  EXPECT_EQ(measure_distortion(r.mesh, atlas.uv).overlap_area_fraction, 0);
}

TEST(PackAtlas, ChartsKeepTheirDistanceAndShape) {
  const std::vector<Vec2> sizes = random_sizes(300);
  const Rectangles r = rectangles(sizes);
  const Atlas atlas = pack_atlas(r.uv, r.charts, {.gutter_mm = 2});
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    EXPECT_EQ(atlas.uv.values[4 * c], atlas.offset[c]);
    EXPECT_NEAR(norm(atlas.uv.values[4 * c + 2] - atlas.offset[c] - sizes[c]), 0, 1e-9);
    EXPECT_GE(atlas.offset[c].x, 0);
    EXPECT_LE(atlas.offset[c].x + sizes[c].x, atlas.size_mm.x + 1e-9);
    for (std::size_t d = 0; d < c; ++d) {
      const double gap_x = std::max(atlas.offset[c].x - atlas.offset[d].x - sizes[d].x,
                                    atlas.offset[d].x - atlas.offset[c].x - sizes[c].x);
      const double gap_y = std::max(atlas.offset[c].y - atlas.offset[d].y - sizes[d].y,
                                    atlas.offset[d].y - atlas.offset[c].y - sizes[c].y);
      EXPECT_GE(std::max(gap_x, gap_y), 2 - 1e-9);
    }
  }
  EXPECT_GT(atlas.fill_rate, 0.6);
}

TEST(PackAtlas, MovesByWholeTiles) {
  const Rectangles r = rectangles(random_sizes(40));
  const Atlas atlas = pack_atlas(r.uv, r.charts, {.gutter_mm = 1, .tile_mm = {7, 3}});
  for (const Vec2 o : atlas.offset) {
    EXPECT_NEAR(std::remainder(o.x, 7), 0, 1e-9);
    EXPECT_NEAR(std::remainder(o.y, 3), 0, 1e-9);
  }
  EXPECT_EQ(measure_distortion(r.mesh, atlas.uv).overlapping_triangles, 0u);
}

TEST(PackAtlas, WholePartsDoNotOverlap) {
  const TriangleMesh mesh = test::torus(1000, 250, 60, 30);
  const Flattening f = flatten_triplanar(mesh).flattening;
  const Atlas atlas = pack_atlas(f.uv, f.charts);
  const DistortionReport r = measure_distortion(mesh, atlas.uv);
  EXPECT_EQ(r.charts, f.charts.count);
  EXPECT_EQ(r.overlapping_triangles, 0u);
  EXPECT_NEAR(r.uv_area / std::pow(std::max(atlas.size_mm.x, atlas.size_mm.y), 2), atlas.fill_rate, 1e-9);
}

TEST(PackAtlas, EmptyAndBadInput) {
  EXPECT_EQ(pack_atlas({}, {}).fill_rate, 0);
  const Rectangles r = rectangles({{1, 1}, {2, 2}});
  EXPECT_THROW(pack_atlas(r.uv, r.charts, {.gutter_mm = -1}), InvalidInput);
  EXPECT_THROW(pack_atlas(r.uv, {}), InvalidInput);
  auto shared = r.uv;
  shared.indices[2] = shared.indices[0];  // two charts with one value can't be moved apart
  EXPECT_THROW(pack_atlas(shared, r.charts), InvalidInput);
}

/// A plane cut into four strips, the uv of each moved.
Flattening shifted_strips(const TriangleMesh& mesh) {
  Flattening f;
  f.charts = {{}, 4, 0};
  for (const Triangle& t : mesh.triangles) {
    const double x = (mesh.positions[t[0]].x + mesh.positions[t[1]].x + mesh.positions[t[2]].x) / 3;
    const auto strip = static_cast<std::uint32_t>(x / 10);
    f.charts.of_triangle.push_back(strip);
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<Index>(f.uv.values.size());
      f.uv.values.push_back({mesh.positions[t[k]].x + 17.3 * strip, mesh.positions[t[k]].y - 5.1 * strip * strip});
    }
    f.uv.indices.push_back(corners);
  }
  return f;
}

TEST(AlignPhase, StripsOfOnePlaneAreJoinedAgain) {
  const TriangleMesh mesh = test::plane(40, 20, 8, 4);
  const AlignedPhase aligned = align_phase(mesh, shifted_strips(mesh));
  EXPECT_NEAR(aligned.seam_mm, 60, 1e-9);
  EXPECT_NEAR(aligned.continued_mm, 60, 1e-9);
  EXPECT_NEAR(aligned.mean_jump_mm, 0, 1e-9);
  EXPECT_EQ(aligned.offset[0], (Vec2{0, 0}));
  EXPECT_NEAR(aligned.offset[3].x, -3 * 17.3, 1e-9);
}

TEST(AlignPhase, GrainRunsUpTheFrontAndOverTheTop) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4, 0, 10}, {0, 0, 10}, {4, 7, 10}, {0, 7, 10}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
  const Flattening f = flatten_triplanar(mesh).flattening;
  const AlignedPhase aligned = align_phase(mesh, f);
  EXPECT_NEAR(aligned.continued_mm, 4, 1e-12);
  EXPECT_EQ(aligned.offset[1] - aligned.offset[0], (Vec2{0, 10}));
}

TEST(AlignPhase, TakesTheLongestSeamFirst) {
  const TriangleMesh mesh = test::cube(10);
  const AlignedPhase aligned = align_phase(mesh, flatten_triplanar(mesh).flattening);
  EXPECT_NEAR(aligned.seam_mm, 120, 1e-9);
  EXPECT_GE(aligned.continued_mm, 50 - 1e-9);  // a spanning tree of six faces
}

TEST(AlignPhase, RefusesBadOptions) {
  EXPECT_THROW(align_phase({}, {}, {.tolerance_mm = 0}), InvalidInput);
  EXPECT_THROW(align_phase(test::cube(1), {}), InvalidInput);
}

}  // namespace
}  // namespace papilla
