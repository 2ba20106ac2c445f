// SPDX-License-Identifier: MIT
#include "papilla/param/natural.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

/// A quarter tube with an angle and a fraction of the height as parameters, in two faces.
TriangleMesh tube(bool clockwise) {
  TriangleMesh mesh = test::grid_mesh(40, 8, [](double s, double t) {
    const double a = 0.5 * std::numbers::pi * s;
    return Vec3{20 * std::cos(a), 20 * std::sin(a), 50 * t};
  });
  mesh.cad_uv.indices = mesh.triangles;
  for (const Vec3& p : mesh.positions)
    mesh.cad_uv.values.push_back({(clockwise ? -1 : 1) * std::atan2(p.y, p.x), p.z / 50});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.face.push_back(t < mesh.triangles.size() / 2 ? 3 : 9);
  return mesh;
}

TEST(Natural, ParametersBecomeArcLength) {
  for (const bool clockwise : {false, true}) {
    const TriangleMesh mesh = tube(clockwise);
    const Flattening f = flatten_natural(mesh);
    EXPECT_EQ(f.charts.count, 2u);
    EXPECT_TRUE(f.notes.empty());
    const DistortionReport r = measure_distortion(mesh, f.uv);
    EXPECT_NEAR(r.symmetric_dirichlet.max, 4, 1e-6);
    EXPECT_NEAR(r.uv_area, r.area_mm2, 1e-6 * r.area_mm2);
    EXPECT_EQ(r.mirrored_charts, 0u);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)  // What would be mirrored is turned about v.
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& corners = f.uv.indices[t];
        const double rise = mesh.corner(t, static_cast<int>((k + 1) % 3)).z - mesh.corner(t, static_cast<int>(k)).z;
        EXPECT_NEAR(f.uv.values[corners[(k + 1) % 3]].y - f.uv.values[corners[k]].y, rise, 1e-6);
      }
  }
}

TEST(Natural, TrianglesWithoutParametersAreProjected) {
  TriangleMesh mesh = tube(false);
  for (std::size_t t = 0; t < 5; ++t) mesh.cad_uv.indices[t] = {k_no_value, k_no_value, k_no_value};
  const Flattening f = flatten_natural(mesh);
  ASSERT_EQ(f.notes.size(), 1u);
  EXPECT_NE(f.notes[0].reason.find("5 triangles"), std::string::npos);
  for (const Vec2 p : f.uv.values) EXPECT_TRUE(is_finite(p));
  const DistortionReport r = measure_distortion(mesh, f.uv);
  EXPECT_EQ(r.degenerate_uv, 0u);
  NaturalOptions strict;
  strict.fall_back = false;
  EXPECT_THROW(flatten_natural(mesh, strict), InvalidInput);
}

TEST(Natural, MeshWithoutParametersIsRefused) {
  EXPECT_THROW(flatten_natural(test::cube(1)), InvalidInput);
  EXPECT_TRUE(flatten_natural({}).uv.empty());
}

}  // namespace
}  // namespace papilla
