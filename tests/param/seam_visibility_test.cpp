// SPDX-License-Identifier: MIT
#include "papilla/param/seam_visibility.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

/// Two triangles with a common edge of length 10 along y at x = 0; the right one's uv are moved.
struct TwoTriangles {
  TriangleMesh mesh;
  CornerAttribute<Vec2> uv;
  explicit TwoTriangles(Vec2 jump) {
    mesh.positions = {{0, 0, 0}, {0, 10, 0}, {-10, 0, 0}, {10, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    uv.values = {{0, 0}, {0, 10}, {-10, 0}, jump, jump + Vec2{0, 10}, jump + Vec2{10, 0}};
    uv.indices = {{0, 1, 2}, {4, 3, 5}};
  }
};

TEST(SeamVisibility, JumpsCountAgainstTheGrain) {
  const TwoTriangles s({0.3, 0.4});
  const SeamVisibility fine = seam_visibility(s.mesh, s.uv, {.grain_mm = 0.5});
  EXPECT_NEAR(fine.seam_mm, 10, 1e-12);
  EXPECT_NEAR(fine.visible_mm, 10, 1e-12);
  EXPECT_NEAR(fine.mean_jump_mm, 0.5, 1e-12);
  EXPECT_NEAR(fine.max_jump_mm, 0.5, 1e-12);
  EXPECT_NEAR(fine.mean_turn_deg, 0, 1e-9);
  EXPECT_NEAR(fine.per_size, 1, 1e-12);  // an area of 100
  EXPECT_NEAR(seam_visibility(s.mesh, s.uv, {.grain_mm = 5}).visible_mm, 1, 1e-12);
}

TEST(SeamVisibility, WholeRepeatsAreNoJump) {
  const TwoTriangles s({8, -12});
  const SeamVisibility v = seam_visibility(s.mesh, s.uv, {.tile_mm = {4, 6}, .grain_mm = 1});
  EXPECT_NEAR(v.seam_mm, 10, 1e-12);
  EXPECT_NEAR(v.visible_mm, 0, 1e-12);
  const TwoTriangles other({8, -18});  // Of the tile's height, not of its width.
  EXPECT_NEAR(seam_visibility(other.mesh, other.uv, {.tile_mm = {4, 6}, .grain_mm = 1}).max_jump_mm, 0, 1e-12);
}

TEST(SeamVisibility, TurnsAreMeasured) {
  TwoTriangles s({0, 0});
  for (std::size_t i = 3; i < 6; ++i) s.uv.values[i] = {-s.uv.values[i].y, s.uv.values[i].x};
  EXPECT_NEAR(seam_visibility(s.mesh, s.uv).mean_turn_deg, 90, 1e-9);
}

TEST(SeamVisibility, ATurnCountsWhereTheSurfaceIsSmooth) {
  const auto turned_by = [](double degrees) {
    TwoTriangles s({0, 0});
    const double c = std::cos(degrees * std::numbers::pi / 180), t = std::sin(degrees * std::numbers::pi / 180);
    for (std::size_t i = 3; i < 6; ++i) {
      const Vec2 p = s.uv.values[i];
      s.uv.values[i] = {c * p.x - t * p.y, t * p.x + c * p.y};
    }
    return s;
  };
  EXPECT_EQ(seam_visibility(turned_by(14).mesh, turned_by(14).uv).turned_mm, 0);
  TwoTriangles chevron = turned_by(16);
  EXPECT_NEAR(seam_visibility(chevron.mesh, chevron.uv).turned_mm, 10, 1e-12);
  EXPECT_NEAR(seam_visibility(chevron.mesh, chevron.uv).mean_turn_deg, 16, 1e-9);
  chevron.mesh.positions[3] = {0, 0, 10};  // A right angle.
  EXPECT_EQ(seam_visibility(chevron.mesh, chevron.uv).turned_mm, 0);
}

TEST(SeamVisibility, SheetsWithoutSeamsAndBadInput) {
  const TwoTriangles s({0, 0});
  EXPECT_EQ(seam_visibility(s.mesh, s.uv).seam_mm, 0);  // other values, the same place
  EXPECT_THROW(seam_visibility(s.mesh, s.uv, {.grain_mm = 0}), InvalidInput);
  EXPECT_THROW(seam_visibility(s.mesh, s.uv, {.tile_mm = {-1, 1}}), InvalidInput);
  EXPECT_THROW(seam_visibility(s.mesh, {}), InvalidInput);
  EXPECT_EQ(seam_visibility({}, {}).seam_mm, 0);
}

}  // namespace
}  // namespace papilla
