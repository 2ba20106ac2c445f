// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_normals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "papilla/core/units.hpp"

namespace papilla {
namespace {

/// Corner k of triangle t is number 3 t + k; its edge runs to corner k + 1.
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct HalfEdge {
  Index low, high;
  std::uint32_t corner;
  friend auto operator<=>(const HalfEdge&, const HalfEdge&) = default;
};

std::vector<HalfEdge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      edges.push_back({low, high, static_cast<std::uint32_t>(3 * t + k)});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::uint32_t following(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

}  // namespace

CornerAttribute<Vec3> vertex_normals(const TriangleMesh& mesh, double crease_deg) {
  const std::size_t count = mesh.triangles.size();
  std::vector<Vec3> area(count), unit(count);
  for (std::size_t t = 0; t < count; ++t) {
    area[t] = cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
    unit[t] = normalized(area[t]);
  }
  const auto vertex = [&](std::uint32_t corner) { return mesh.triangles[corner / 3][corner % 3]; };

  CornerGroups groups(3 * count);
  const double least_cosine = std::cos(crease_deg * k_radians_per_degree);
  const std::vector<HalfEdge> edges = sorted_edges(mesh);
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high) ++last;
    if (last - first != 2) continue;
    const std::uint32_t a = edges[first].corner, b = edges[first + 1].corner;
    if (vertex(a) == vertex(b) || dot(unit[a / 3], unit[b / 3]) < least_cosine) continue;
    groups.unite(a, following(b));
    groups.unite(following(a), b);
  }

  std::vector<Vec3> sums(3 * count);
  for (std::uint32_t corner = 0; corner < 3 * count; ++corner) {
    Vec3& sum = sums[groups.find(corner)];
    sum = sum + area[corner / 3];
  }
  CornerAttribute<Vec3> normals;
  normals.indices.resize(count);
  std::vector<Index> number(3 * count);
  for (std::uint32_t corner = 0; corner < 3 * count; ++corner) {
    const std::uint32_t group = groups.find(corner);
    if (group == corner) {  // The smallest corner of a group stands for it and comes first.
      number[corner] = static_cast<Index>(normals.values.size());
      const Vec3 normal = normalized(sums[group]);
      normals.values.push_back(normal == Vec3{} ? Vec3{0, 0, 1} : normal);
    }
    normals.indices[corner / 3][corner % 3] = number[group];
  }
  return normals;
}

}  // namespace papilla
