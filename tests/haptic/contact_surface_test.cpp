// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using testing::box;
using testing::plate;
using testing::sphere;

TEST(ContactSurface, SweepStopsAtTheSkinAbovePlane) {
  const ContactSurface surface(plate(10, 10, 0.1, 0.1), {ContactMaterial{}}, {}, 0);
  const auto hit = surface.sweep({0.033, 0.042, 0.01}, {0.053, 0.042, -0.01});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(0.01 - 0.02 * hit->t, surface.skin_m(), 1e-10);
  EXPECT_NEAR(hit->normal.z, 1, 1e-12);
}

TEST(ContactSurface, FromBehindTheNormalPointsBack) {
  const ContactSurface surface(plate(10, 10, 0.1, 0.1), {ContactMaterial{}}, {}, 1e-3);
  const auto hit = surface.sweep({0.033, 0.042, -0.01}, {0.033, 0.042, 0.01});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(-0.01 + 0.02 * hit->t, -surface.contact_radius_m(), 1e-10);
  EXPECT_NEAR(hit->normal.z, -1, 1e-12);
}

TEST(ContactSurface, BallRollsOverAnEdge) {
  const ContactSurface surface(box({0, 0, 0}, {0.1, 0.1, 0.1}), {ContactMaterial{}}, {}, 2e-3);
  const double r = surface.contact_radius_m(), s = r / std::sqrt(2.0);
  const auto hit =
      surface.sweep({-0.01, 0.05, 0.11}, {0.01, 0.05, 0.09});  // Towards the edge x = 0, z = 0.1 at 45 degrees.
  ASSERT_TRUE(hit);
  EXPECT_NEAR(-0.01 + 0.02 * hit->t, -s, 1e-9);
  EXPECT_NEAR(hit->normal.x, -std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(hit->normal.z, std::sqrt(0.5), 1e-6);
}

/// Two planes that rise from the y axis, or fall, with the slopes `left` and `right`.
ContactMesh fold(double left, double right) {
  return testing::height_grid(8, 8, 0.1, 0.1,
                              [=](double x, double) { return x < 0.05 ? left * (0.05 - x) : right * (x - 0.05); });
}

TEST(ContactSurface, SweepIntoACreaseFindsBothFaces) {
  const double left = 0.3, right = 0.1;
  const ContactSurface surface(fold(left, right), {ContactMaterial{}}, {}, 0);
  // The point at the contact radius from both planes.
  const double r = surface.contact_radius_m();
  const double a = std::sqrt(1 + left * left), b = std::sqrt(1 + right * right);
  const double x = r * (a - b) / (left + right), z = r * b + right * x;
  const auto hit = surface.sweep({0.05 + x, 0.043, 0.01}, {0.05 + x, 0.043, -0.01});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(0.01 - 0.02 * hit->t, z, 1e-8);
  ASSERT_TRUE(hit->crease);
  const Vec3 normals[] = {{left / a, 0, 1 / a}, {-right / b, 0, 1 / b}};
  const bool left_first = hit->normal.x > 0;
  EXPECT_LT(norm(hit->normal - normals[left_first ? 0 : 1]), 1e-6);
  EXPECT_LT(norm(hit->crease->normal - normals[left_first ? 1 : 0]), 1e-6);
}

TEST(ContactSurface, FlatGroundRidgesAndSlopesAreNoCrease) {
  for (const auto& [left, right] : {std::pair{0.0, 0.0}, {-0.3, -0.1}, {-0.2, 0.2}}) {
    const ContactSurface surface(fold(left, right), {ContactMaterial{}}, {}, 0);
    for (const double x : {0.05, 0.05 + 1e-7, 0.05 - 1e-6, 0.05 + 1e-5, 0.0625, 0.0625 + 1e-7, 0.07})
      for (const double y : {0.043, 0.05, 0.05 + 1e-7, 0.0625 - 1e-6}) {
        const auto hit = surface.sweep({x, y, 0.01}, {x, y, -0.02});
        ASSERT_TRUE(hit);
        EXPECT_FALSE(hit->crease) << left << " " << right << " " << x << " " << y;
      }
  }
}

TEST(ContactSurface, LeavingAndSlidingAreFree) {
  const ContactSurface surface(plate(10, 10, 0.1, 0.1), {ContactMaterial{}}, {}, 0);
  const double s = surface.skin_m();
  EXPECT_FALSE(surface.sweep({0.03, 0.03, s}, {0.06, 0.07, s}));
  EXPECT_FALSE(surface.sweep({0.03, 0.03, s * 0.99}, {0.03, 0.03, 0.01}));
  EXPECT_TRUE(surface.sweep({0.03, 0.03, s}, {0.06, 0.07, 0}));
}

TEST(ContactSurface, ClosestPointIsTheSpheres) {
  const ContactSurface surface(sphere(200, 0.1), {ContactMaterial{}}, {}, 0);
  const Vec3 p{0.03, 0.05, 0.04};
  const auto near = surface.closest_point(p, 0.1);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->distance_m, 0.1 - norm(p), 5e-5);
  EXPECT_GT(dot(near->face_normal, normalized(p)), 0.99);
  EXPECT_FALSE(surface.closest_point(p, 0.01));
}

TEST(ContactSurface, ReliefReachesBelowThePlate) {
  ContactMaterial material;
  material.height = 0;
  HeightFieldOptions options;
  options.scale_m = 2e-4;
  options.offset_m = -1e-4;
  const std::vector<std::uint16_t> samples = {0, 65535, 0, 65535};  // Stripes along v.
  const ContactSurface surface(plate(10, 10, 0.1, 0.1), {material}, {HeightField(2, 2, samples, options)}, 0);
  const double s = surface.skin_m();
  // uv = 0.25 is a valley at −0.1 mm, uv = 0.75 a ridge at +0.1 mm.
  EXPECT_NEAR(surface.clearance({0.025, 0.05, s - 1e-4}, 0.01), 0, 1e-9);
  EXPECT_NEAR(surface.clearance({0.075, 0.05, s + 1e-4}, 0.01), 0, 1e-9);
  const auto hit = surface.sweep({0.075, 0.05, 0.01}, {0.075, 0.05, -0.01});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(0.01 - 0.02 * hit->t, s + 1e-4, surface.tolerance_m());
}

/// A relief that lies 0.1 mm deep nearly everywhere: the box is smaller by that on every side, up to its corners,
/// though some sides have one and some two triangles there.
TEST(ContactSurface, ASunkOblongBoxIsTheSmallerBox) {
  const Vec3 low{-0.01, 0.02, 0.005}, high{0.02, 0.07, 0.025};
  ContactMaterial material;
  material.height = 0;
  HeightFieldOptions options;
  options.scale_m = 2e-4;
  options.offset_m = -1e-4;
  options.interpolation = Interpolation::bilinear;
  std::vector<std::uint16_t> samples(8 * 8, 0);
  samples[8 * 4 + 4] = 65535;
  ContactMesh mesh = box(low, high);
  mesh.corner_uv.assign(3 * mesh.triangles.size(), {});  // All of it is at the first texel.
  const ContactSurface surface(mesh, {material}, {HeightField(8, 8, samples, options)}, 0);
  const Vec3 size = high - low;
  for (const double a : {0.02, 0.5, 0.97})
    for (const double b : {0.03, 0.4, 0.98}) {
      const double out = surface.skin_m() - 1e-4;
      for (const Vec3 p : {Vec3{low.x - out, low.y + a * size.y, low.z + b * size.z},
                           Vec3{high.x + out, low.y + a * size.y, low.z + b * size.z},
                           Vec3{low.x + a * size.x, low.y - out, low.z + b * size.z},
                           Vec3{low.x + a * size.x, high.y + out, low.z + b * size.z},
                           Vec3{low.x + a * size.x, low.y + b * size.y, low.z - out},
                           Vec3{low.x + a * size.x, low.y + b * size.y, high.z + out}})
        EXPECT_NEAR(surface.clearance(p, 0.01), 0, 1e-8) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

/// A map of 24 × 10 texels that is turned and unevenly scaled, on a triangle without a right angle.
TEST(ContactSurface, AStimulusOfATurnedOblongMapIsThatOfItsPlace) {
  std::mt19937 random(3);
  std::vector<std::uint16_t> samples(24 * 10);
  for (auto& v : samples) v = static_cast<std::uint16_t>(20000 + random() % 20000);
  HeightFieldOptions options;
  options.scale_m = 2e-4;
  options.interpolation = Interpolation::bspline;
  options.uv_transform = {{0.13, -0.4}, 0.7, {1.7, 0.6}};
  ContactMesh mesh;
  mesh.positions = {{0.01, 0.02, 0.03}, {0.06, 0.01, 0.05}, {0.03, 0.07, 0.02}};
  mesh.triangles = {{0, 1, 2}};
  mesh.corner_uv = {{0.1, 0.2}, {0.9, 0.5}, {0.3, 1.4}};
  ContactMaterial material;
  material.stimulus = 0;
  const ContactSurface surface(mesh, {material}, {HeightField(24, 10, samples, options)}, 0);
  const Vec3 ab = mesh.positions[1] - mesh.positions[0], ac = mesh.positions[2] - mesh.positions[0];
  const auto at = [&](double v, double w) { return mesh.positions[0] + v * ab + w * ac; };
  const auto uv = [&](double v, double w) {
    return mesh.corner_uv[0] + v * (mesh.corner_uv[1] - mesh.corner_uv[0]) +
           w * (mesh.corner_uv[2] - mesh.corner_uv[0]);
  };
  const auto rows = options.uv_transform.rows(24, 10);
  const auto texel = [&](double v, double w) { return Vec2{dot(rows[0], uv(v, w)), dot(rows[1], uv(v, w))}; };
  const double texels = std::abs(cross(texel(1, 0) - texel(0, 0), texel(0, 1) - texel(0, 0)));
  constexpr double e = 1e-5;
  for (const Vec2 f : {Vec2{0.2, 0.3}, Vec2{0.5, 0.1}, Vec2{0.15, 0.7}}) {
    const auto here = surface.stimulus(at(f.x, f.y), 1e-3);
    ASSERT_TRUE(here);
    EXPECT_NEAR(here->column, texel(f.x, f.y).x, 1e-5);
    EXPECT_NEAR(here->pixel_m * here->pixel_m * texels, norm(cross(ab, ac)), 1e-6 * norm(cross(ab, ac)));
    EXPECT_NEAR(dot(here->slope, here->normal), 0, 1e-9 * norm(here->slope));
    for (const Vec2 way : {Vec2{e, 0}, Vec2{0, e}}) {
      const auto on = surface.stimulus(at(f.x + way.x, f.y + way.y), 1e-3),
                 back = surface.stimulus(at(f.x - way.x, f.y - way.y), 1e-3);
      const Vec3 moved = at(f.x + way.x, f.y + way.y) - at(f.x - way.x, f.y - way.y);
      EXPECT_NEAR(on->grey - back->grey, dot(here->slope, moved), 1e-3 * norm(here->slope) * norm(moved));
    }
  }
}

/// Sweeps over a relief end in contact and never penetrate by more than the tolerance before, sampled in steps of 1/16
/// texel.
TEST(ContactSurface, SweepsOverReliefDoNotPassThroughIt) {
  constexpr int k_texels = 64, k_looks = 16;
  constexpr double k_size = 6.4e-3;
  std::mt19937 random(1);
  const std::vector<std::uint16_t> samples = testing::wave_samples(k_texels, k_texels);
  HeightFieldOptions options;
  options.scale_m = 2e-4;
  options.offset_m = -5e-5;  // The base is below the plate.
  ContactMaterial material;
  material.height = 0;
  std::uniform_real_distribution<double> place(0.2 * k_size, 0.8 * k_size), over(1.6e-4, 1e-3), down(-3e-4, 4e-4);
  int hits = 0;
  for (const int squares : {1, 8, 40})
    for (const double radius : {0.0, 4e-4}) {
      const ContactSurface surface(plate(squares, squares, k_size, k_size), {material},
                                   {HeightField(k_texels, k_texels, samples, options)}, radius);
      const double tolerance = surface.tolerance_m();
      const auto clearance = [&](Vec3 x) { return surface.clearance(x, 5e-3); };
      for (int i = 0; i < 40; ++i) {
        const Vec3 from{place(random), place(random), radius + over(random)};
        const Vec3 to{place(random), place(random), radius + down(random)};
        if (clearance(from) < 0) continue;
        const auto hit = surface.sweep(from, to);
        hits += hit.has_value();
        const double end = hit ? hit->t : 1;
        const int looks = static_cast<int>(end * norm(to - from) / k_size * k_texels * k_looks);
        for (int k = 0; k < looks; ++k)
          ASSERT_GT(clearance(from + (end * k / looks) * (to - from)), -1.05 * tolerance) << squares << ' ' << k;
        if (hit) {
          EXPECT_NEAR(clearance(from + hit->t * (to - from)), 0, tolerance);
        }
      }
    }
  EXPECT_GT(hits, 100);
}

TEST(ContactSurface, CrossingsCountWallsOnceAtEdgesAndDuplicates) {
  ContactMesh mesh = box({0, 0, 0}, {0.1, 0.1, 0.1});
  const auto once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  const ContactSurface surface(mesh, {ContactMaterial{}}, {}, 0);
  EXPECT_EQ(surface.crossings({0.05, 0.05, 0.2}, {0.05, 0.05, 0.05}), 1);  // On the diagonal of the lid.
  EXPECT_EQ(surface.crossings({0.05, 0.05, 0.2}, {0.05, 0.05, -0.2}), 2);
  EXPECT_EQ(surface.crossings({0.2, 0.2, 0.2}, {0.3, 0.2, 0.2}), 0);
}

TEST(ContactSurface, LeavesOutTrianglesWithoutArea) {
  ContactMesh mesh = plate(2, 2, 0.1, 0.1);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 1, 2});  // Three vertices on a line.
  mesh.positions.push_back({std::nan(""), 0, 0});
  mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.positions.size() - 1)});
  mesh.corner_uv.clear();
  const ContactSurface surface(mesh, {ContactMaterial{}}, {}, 0);
  EXPECT_EQ(surface.triangles(), 8U);
  EXPECT_EQ(surface.skipped_triangles(), 3U);
}

TEST(ContactSurface, RefusesBrokenInput) {
  const ContactMesh good = plate(2, 2, 0.1, 0.1);
  const std::vector<ContactMaterial> materials(1);
  EXPECT_THROW(ContactSurface(ContactMesh{}, materials, {}, 0), InvalidInput);
  EXPECT_THROW(ContactSurface(good, {}, {}, 0), InvalidInput);
  EXPECT_THROW(ContactSurface(good, materials, {}, -1), InvalidInput);
  ContactMesh mesh = good;
  mesh.triangles[0][0] = 1000;
  EXPECT_THROW(ContactSurface(mesh, materials, {}, 0), InvalidInput);
  mesh = good;
  mesh.material.assign(mesh.triangles.size(), 3);
  EXPECT_THROW(ContactSurface(mesh, materials, {}, 0), InvalidInput);
  mesh = good;
  for (Vec3& position : mesh.positions) position.x += 2e6;
  EXPECT_THROW(ContactSurface(mesh, materials, {}, 0), InvalidInput) << "farther than 1000 km";
  std::vector<ContactMaterial> odd(1);
  odd[0].stiffness = std::nan("");
  EXPECT_THROW(ContactSurface(good, odd, {}, 0), InvalidInput);
  odd[0] = ContactMaterial{};
  odd[0].static_friction = -0.1;
  EXPECT_THROW(ContactSurface(good, odd, {}, 0), InvalidInput);
  odd[0] = ContactMaterial{};
  odd[0].height = 0;
  EXPECT_THROW(ContactSurface(good, odd, {}, 0), InvalidInput);
}

}  // namespace
}  // namespace papilla
