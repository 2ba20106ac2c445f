// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::test {

/// Meshes by formula. All are welded, manifold, oriented (outward when closed) unless told otherwise.
TriangleMesh grid(int nx, int ny);                          ///< [0, nx] x [0, ny] in the plane z = 0.
TriangleMesh terrain(int n, double height, unsigned seed);  ///< n x n grid with random heights in [0, height].
TriangleMesh cube(int n = 1);                               ///< [0, 1]^3, n x n quadrangles a side.
TriangleMesh sphere(int n);                                 ///< Unit sphere: a cube with n x n a side, blown up.
TriangleMesh torus(int around, int across);                 ///< Radii 3 and 1.
TriangleMesh tube(int around, int along);                   ///< Cylinder without caps: radius 1, height 2.
TriangleMesh moebius(int n);                                ///< Not orientable; n quadrangles around.
using Voxel = std::tuple<int, int, int>;
TriangleMesh voxels(const std::set<Voxel>& filled);  ///< Surface of unit cubes, vertices welded by place.
TriangleMesh double_torus();                         ///< Genus 2: a slab with two holes.

/// Every triangle with its own three vertices.
TriangleMesh soup_of(const TriangleMesh& mesh);
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
TriangleMesh moved(TriangleMesh mesh, Vec3 by);
TriangleMesh reversed(TriangleMesh mesh);
/// Triangles with corners on a 4 x 4 x 4 lattice: full of duplicates, non-manifold edges, T-junctions, degenerates.
TriangleMesh lattice_soup(int triangles, unsigned seed);

/// uv of every corner = (x, y) of its position; a check that attributes follow their corners.
void set_uv_to_xy(TriangleMesh& mesh);
bool uv_is_xy(const TriangleMesh& mesh, double tolerance);

double area(const TriangleMesh& mesh);
double signed_volume(const TriangleMesh& mesh);

}  // namespace papilla::test
