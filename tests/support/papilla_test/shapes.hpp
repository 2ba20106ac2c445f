// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/meshing/triangle_mesh.hpp"

/// Test surfaces made by formula, in millimetres, each with its known area and volume.
///
/// All are welded (a position is stored once), free of degenerate triangles, and counter-clockwise seen
/// from outside; open surfaces are counter-clockwise seen from +z, or from outside their axis. The axis of
/// revolution is z. `A` is the area and `V` the volume of the *polyhedron* returned, not of the smooth
/// surface, unless it says "tends to"; with a rounding error of about 1e-14 relative. Same arguments, same bits.
/// @throws InvalidInput for lengths that are not positive and finite, or too few subdivisions.
namespace papilla::test {

/// Axis-parallel cube [0, edge]^3: 8 vertices, 12 triangles. A = 6 edge^2, V = edge^3. Closed, genus 0.
TriangleMesh cube(double edge_mm);

/// Flat rectangle [0, width] x [0, height] in z = 0, 2 columns rows triangles; `uv` = (x, y) in millimetres, an
/// isometry. A = width height. Open, one boundary loop.
TriangleMesh plane(double width_mm, double height_mm, Index columns, Index rows);

/// Sphere around the origin: `rings` >= 2 bands of latitude, `segments` >= 3 of longitude, 2 segments (rings - 1)
/// triangles. A tends to 4 pi r^2; V = segments sin(2 pi / segments) / 3 (1 + cos(pi / rings)) r^3. Closed, genus 0.
TriangleMesh uv_sphere(double radius_mm, Index rings, Index segments);

/// Torus around z: centre circle R = major, tube r = minor < R, n = `segments` >= 3 around z, m = `sides` >= 3 around
/// the tube, 2 n m triangles. A tends to 4 pi^2 R r; V = n sin(2 pi / n) R (m / 2) r^2 sin(2 pi / m). Closed, genus 1.
TriangleMesh torus(double major_mm, double minor_mm, Index segments, Index sides);

/// Tube without lids, 0 <= z <= height, n = `segments` >= 3, 2 n rows triangles.
/// A = 2 n r sin(pi / n) height. Developable: `uv` = (chord length along the rim, z) in millimetres is an isometry,
/// cut along the triangle edges of the half-plane y = 0, x > 0. Open, two boundary loops.
TriangleMesh cylinder(double radius_mm, double height_mm, Index segments, Index rows);

/// Cone mantle without base, rim in z = 0, tip (0, 0, height), n = `segments` >= 3, n triangles.
/// A = n r sin(pi / n) sqrt(height^2 + r^2 cos^2(pi / n)). One boundary loop. All curvature sits in the tip: its
/// angle defect is 2 pi - 2 n asin(r sin(pi / n) / sqrt(r^2 + height^2)).
TriangleMesh cone(double radius_mm, double height_mm, Index segments);

/// Möbius strip around z, centre circle of `radius`, `width` < 2 radius, `segments` >= 3, 2 segments rows triangles.
/// Non-orientable: Euler characteristic 0, one boundary loop, and `rows` interior edges are run through
/// in the same direction by both their triangles, whatever is flipped at least one stays.
TriangleMesh moebius_strip(double radius_mm, double width_mm, Index segments, Index rows);

/// Double-curved patch bent both ways (negative Gaussian curvature): z = (x^2 - y^2) / (2 rho) over the disc
/// of `radius`, rho = `curvature_radius`; `rings` >= 1 circles of `segments` >= 3 vertices around a centre vertex,
/// segments (2 rings - 1) triangles. A tends to (2 pi / 3) rho^2 ((1 + radius^2 / rho^2)^(3/2) - 1).
TriangleMesh saddle(double radius_mm, double curvature_radius_mm, Index rings, Index segments);

/// Double-curved patch bent one way: the cap of half angle `half_angle_rad` in (0, pi) around +z of a sphere around
/// the origin, meshed like saddle(). A tends to 2 pi r^2 (1 - cos(half angle)). One boundary loop.
TriangleMesh spherical_cap(double radius_mm, double half_angle_rad, Index rings, Index segments);

/// Flat rectangle [0, length] x [0, width] in z = 0 made of `count` slivers as long as the whole and width / count
/// wide, 2 count triangles; `uv` = (x, y). A = length width. The longest edge of each triangle is sqrt(length^2 +
/// (width / count)^2), its height on that edge length (width / count) / longest.
TriangleMesh needle_strip(double length_mm, double width_mm, Index count);

/// Sum of the triangles' areas [mm^2].
double surface_area(const TriangleMesh& mesh);

/// Signed volume by the divergence theorem, sum of a . (b x c) / 6 [mm^3]; meaningful for closed oriented surfaces.
double enclosed_volume(const TriangleMesh& mesh);

}  // namespace papilla::test
