// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangulate_loop.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>

namespace papilla::detail {

std::vector<Triangle> triangulate_loop(std::span<const Vec3> polygon) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  if (polygon.size() == 3) return {{0, 1, 2}};
  std::vector<Point> points;
  points.reserve(polygon.size());
  for (const Vec3& p : polygon) points.emplace_back(p.x, p.y, p.z);
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(found));
  std::vector<Triangle> triangles;
  triangles.reserve(found.size());
  for (const auto& t : found)
    triangles.push_back({static_cast<Index>(t.first), static_cast<Index>(t.second), static_cast<Index>(t.third)});
  return triangles;
}

}  // namespace papilla::detail
