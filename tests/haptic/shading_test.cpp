// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {
namespace {

constexpr double k_radius = 0.05, k_length = 0.04, k_depth = 1e-3;

/// A drum of n facets around the z axis with its lids; corner normals are radial on the side and straight on the lids.
ContactMesh drum(int n) {
  ContactMesh mesh;
  const auto around = [n](int i) {
    const double angle = 2 * std::numbers::pi * i / n;
    return Vec3{std::cos(angle), std::sin(angle), 0};
  };
  const auto add = [&](std::array<Vec3, 3> corners, std::array<Vec3, 3> normals) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.corner_normals.insert(mesh.corner_normals.end(), normals.begin(), normals.end());
    mesh.triangles.push_back({base, base + 1, base + 2});
  };
  const Vec3 up{0, 0, 1}, high = k_length * up;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = around(i), b = around(i + 1), p = k_radius * a, q = k_radius * b;
    add({p, q, q + high}, {a, b, b});
    add({p, q + high, p + high}, {a, b, a});
    add({p + high, q + high, high}, {up, up, up});
    add({q, p, {}}, {-up, -up, -up});
  }
  return mesh;
}

ContactSurface surface_of(bool shading, double radius, int facets = 24) {
  ContactMaterial material;
  material.shading = shading;
  return ContactSurface(drum(facets), {material}, {}, radius);
}

struct Stroke {
  double largest_jump = 0;  ///< Of the force in one tick, over the force.
  double largest_tilt = 0;  ///< Of the force against the round drum's normal, radians.
};

/// Around the drum in steps of 5 µm.
Stroke stroke_around(const ContactSurface& surface) {
  Proxy proxy(surface);
  const double r = k_radius + surface.probe_radius_m();
  proxy.reset({r + 0.01, 0, 0.5 * k_length});
  Stroke stroke;
  Vec3 last;
  for (int i = 0; i < 12000; ++i) {
    const double angle = 1e-4 * i;
    const Vec3 out{std::cos(angle), std::sin(angle), 0};
    const Vec3 probe = (r - k_depth) * out + Vec3{0, 0, 0.5 * k_length};
    const Vec3 force = heightfield_force(surface, proxy.update(probe, 1e-3), probe, {});
    if (i > 0) stroke.largest_jump = std::max(stroke.largest_jump, norm(force - last) / norm(force));
    stroke.largest_tilt = std::max(stroke.largest_tilt, std::acos(std::min(1.0, dot(normalized(force), out))));
    last = force;
  }
  return stroke;
}

TEST(ForceShading, RemovesTheJumpsAtFacetEdges) {
  const double facet = 2 * std::numbers::pi / 24;
  for (const double radius : {0.0, 1e-3}) {
    const Stroke plain = stroke_around(surface_of(false, radius)), shaded = stroke_around(surface_of(true, radius));
    // A point slips off an edge at once: the force turns by the angle of the facets, which shading removes, and falls
    // by its cosine, which remains. A ball rolls over the edge.
    const double slip = radius > 0 ? 0 : 1 - std::cos(facet);
    EXPECT_GT(plain.largest_jump, radius > 0 ? 0.1 : 0.9 * facet) << radius;
    EXPECT_LT(shaded.largest_jump, slip + 2e-3) << radius;
    EXPECT_GT(plain.largest_tilt, 0.4 * facet) << radius;
    EXPECT_LT(shaded.largest_tilt, 0.005) << radius;
  }
}

/// Normals are packed by the octant that they point to: a drum turned about all axes has some of each.
TEST(ForceShading, IsTheSameHoweverTheDrumIsTurned) {
  const auto turned = [](Vec3 v) {
    return (1.0 / 3) * Vec3{v.x + 2 * v.y - 2 * v.z, 2 * v.x + v.y + 2 * v.z, 2 * v.x - 2 * v.y - v.z};
  };
  ContactMesh mesh = drum(24);
  for (Vec3& p : mesh.positions) p = turned(p);
  for (Vec3& n : mesh.corner_normals) n = turned(n);
  ContactMaterial material;
  material.shading = true;
  const ContactSurface plain = surface_of(true, 0), other(mesh, {material}, {}, 0);
  for (int i = 0; i < 24; ++i) {
    const auto around = [](double facet) {
      const double angle = 2 * std::numbers::pi / 24 * facet;
      return Vec3{std::cos(angle), std::sin(angle), 0};
    };
    const Vec3 out = around(i + 0.5);
    const Vec3 place = k_radius * (0.8 * around(i) + 0.2 * around(i + 1)) + Vec3{0, 0, 0.3 * k_length};
    const Vec3 shaded = plain.shaded_normal(place, out);
    EXPECT_GT(norm(shaded - out), 0.05) << i;
    EXPECT_LT(norm(other.shaded_normal(turned(place), turned(out)) - turned(shaded)), 1e-3) << i;
  }
}

TEST(ForceShading, SharpEdgesStaySharp) {
  // A ball around the rim: the force turns from radial to straight up as it does without shading.
  const ContactSurface plain = surface_of(false, 2e-3, 96), shaded = surface_of(true, 2e-3, 96);
  Proxy a(plain), b(shaded);
  const Vec3 rim{k_radius, 0, k_length};
  a.reset(rim + Vec3{0.01, 0, 0});
  b.reset(rim + Vec3{0.01, 0, 0});
  for (int i = 0; i <= 90; ++i) {
    const double angle = std::numbers::pi / 180 * i;
    const Vec3 probe = rim + 1.5e-3 * Vec3{std::cos(angle), 0, std::sin(angle)};
    const Vec3 f = heightfield_force(plain, a.update(probe, 1e-3), probe, {});
    const Vec3 g = heightfield_force(shaded, b.update(probe, 1e-3), probe, {});
    EXPECT_GT(norm(f), 0.2) << i;
    EXPECT_LT(norm(f - g), 0.04 * norm(f)) << i;
  }
}

TEST(ForceShading, ChangesNothingWithoutNormalsOrOnFlatFaces) {
  ContactMesh mesh = drum(24);
  ContactMaterial material;
  material.shading = true;
  const ContactSurface shaded(mesh, {material}, {}, 0);
  mesh.corner_normals = {};
  const ContactSurface bare(mesh, {material}, {}, 0);
  EXPECT_EQ(bare.shaded_normal({k_radius, 0.001, 0.02}, {1, 0, 0}), (Vec3{1, 0, 0}));
  const Vec3 lid{0.01, 0.005, k_length + shaded.contact_radius_m()};
  EXPECT_LT(norm(shaded.shaded_normal(lid, {0, 0, 1}) - Vec3{0, 0, 1}), 1e-4);
  EXPECT_LT(shaded.bytes() - bare.bytes(), 12 * shaded.triangles() + 1);
}

}  // namespace
}  // namespace papilla
