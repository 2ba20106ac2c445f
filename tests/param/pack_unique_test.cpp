// SPDX-License-Identifier: MIT
#include "papilla/param/pack_unique.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/triplanar.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

/// One chart of one right-angled triangle per size.
struct Triangles {
  TriangleMesh mesh;
  CornerAttribute<Vec2> uv;
  ChartSet charts;
};

Triangles random_triangles(int count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(1, 20);
  Triangles r;
  for (int i = 0; i < count; ++i) {
    const double a = uniform(generator), b = uniform(generator), z = 100.0 * i;
    const auto first = static_cast<Index>(r.uv.values.size());
    for (const Vec2 p : {Vec2{0, 0}, Vec2{a, 0}, Vec2{0, b}}) {
      r.uv.values.push_back(p);
      r.mesh.positions.push_back({p.x, p.y, z});
    }
    r.mesh.triangles.push_back({first, first + 1, first + 2});
    r.charts.of_triangle.push_back(r.charts.count++);
  }
  r.uv.indices = r.mesh.triangles;
  return r;
}

double distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double s = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
  return norm(p - a - s * d);
}

TEST(PackUnique, ChartsKeepTheGutterShapeAndHand) {
  const Triangles r = random_triangles(120);
  const UniqueAtlasOptions options{.texture_px = 1024, .gutter_px = 6};
  const UniqueAtlas atlas = pack_unique(r.uv, r.charts, options);
  EXPECT_GE(atlas.gutter_px, 6);
  const double scale = atlas.texels_per_mm / options.texture_px;
  const auto at = [&](std::size_t t, std::size_t k) { return atlas.uv.values[atlas.uv.indices[t][k]]; };
  for (std::size_t t = 0; t < r.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GE(std::min(at(t, k).x, at(t, k).y) * options.texture_px, 3 - 1e-9);
      EXPECT_LE(std::max(at(t, k).x, at(t, k).y) * options.texture_px, 1024 - 3 + 1e-9);
      EXPECT_NEAR(norm(at(t, (k + 1) % 3) - at(t, k)),
                  scale * norm(r.uv.values[3 * t + (k + 1) % 3] - r.uv.values[3 * t + k]), 1e-12);
      for (std::size_t s = 0; s < t; ++s)
        for (std::size_t l = 0; l < 3; ++l) {
          EXPECT_GE(distance(at(t, k), at(s, l), at(s, (l + 1) % 3)) * options.texture_px, 6 - 1e-6);
          EXPECT_GE(distance(at(s, l), at(t, k), at(t, (k + 1) % 3)) * options.texture_px, 6 - 1e-6);
        }
    }
  const DistortionReport d = measure_distortion(r.mesh, atlas.uv);
  EXPECT_EQ(d.mirrored_charts, 0u);
  EXPECT_EQ(d.overlapping_triangles, 0u);
  EXPECT_NEAR(d.uv_area, atlas.fill_rate, 1e-12);
  EXPECT_GT(atlas.fill_rate, 0.5);
}

TEST(PackUnique, DensityScalesSingleCharts) {
  const Triangles r = random_triangles(20);
  std::vector<double> density(20, 1.0);
  density[4] = 3;
  const UniqueAtlas atlas = pack_unique(r.uv, r.charts, {.texture_px = 512, .gutter_px = 2, .density = density});
  const auto edge = [&](std::size_t t) { return norm(atlas.uv.values[3 * t + 1] - atlas.uv.values[3 * t]); };
  const auto in_mm = [&](std::size_t t) { return norm(r.uv.values[3 * t + 1] - r.uv.values[3 * t]); };
  EXPECT_NEAR(edge(4) / in_mm(4), 3 * edge(5) / in_mm(5), 1e-12);
  EXPECT_NEAR(edge(5) * 512, atlas.texels_per_mm * in_mm(5), 1e-9);
}

TEST(PackUnique, WholePartsDoNotOverlap) {
  const TriangleMesh mesh = test::torus(1000, 250, 60, 30);
  const Flattening f = flatten_triplanar(mesh).flattening;
  const UniqueAtlas atlas = pack_unique(f.uv, f.charts);
  const DistortionReport r = measure_distortion(mesh, atlas.uv);
  EXPECT_EQ(r.overlapping_triangles, 0u);
  EXPECT_EQ(r.mirrored_charts, 0u);
  EXPECT_NEAR(r.uv_area, atlas.fill_rate, 1e-9);
}

TEST(PackUnique, BadInputIsNamed) {
  EXPECT_EQ(pack_unique({}, {}).fill_rate, 0);
  const Triangles r = random_triangles(3);
  EXPECT_THROW(pack_unique(r.uv, r.charts, {.texture_px = 0}), InvalidInput);
  EXPECT_THROW(pack_unique(r.uv, r.charts, {.texture_px = 64, .gutter_px = 17}), InvalidInput);
  EXPECT_THROW(pack_unique(r.uv, r.charts, {.density = {1, 2}}), InvalidInput);
  EXPECT_THROW(pack_unique(r.uv, r.charts, {.density = {1, 2, 0}}), InvalidInput);
  const Triangles many = random_triangles(500);
  EXPECT_THROW(pack_unique(many.uv, many.charts, {.texture_px = 64, .gutter_px = 16}), InvalidInput);
}

}  // namespace
}  // namespace papilla
