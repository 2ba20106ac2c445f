// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "papilla/core/union_find.hpp"
#include "papilla/core/units.hpp"

namespace papilla {
namespace {

/// Corner k of triangle t is number 3 t + k. Those at vertex v are list[first[v]] … list[first[v + 1] − 1], ascending.
struct CornersOfVertices {
  std::vector<std::uint32_t> first, list;
};

CornersOfVertices corners_of_vertices(const TriangleMesh& mesh) {
  CornersOfVertices corners;
  corners.first.assign(mesh.positions.size() + 2, 0);
  for (const Triangle& triangle : mesh.triangles)
    for (const Index vertex : triangle) ++corners.first[vertex + 2];
  std::partial_sum(corners.first.begin(), corners.first.end(), corners.first.begin());
  corners.list.resize(3 * mesh.triangles.size());
  std::uint32_t corner = 0;
  for (const Triangle& triangle : mesh.triangles)
    for (const Index vertex : triangle) corners.list[corners.first[vertex + 1]++] = corner++;
  corners.first.pop_back();
  return corners;
}

/// An edge at a vertex, as one of its corners sees it.
struct Spoke {
  Index other;           ///< The vertex at the far end.
  std::uint32_t corner;  ///< Number among the vertex's corners.
  bool outgoing;         ///< The corner's triangle runs through it away from the vertex.
  friend auto operator<=>(const Spoke&, const Spoke&) = default;
};

/// The corners of one vertex, parted into groups of smooth shading. Reused from vertex to vertex.
class Fan {
 public:
  Fan(const TriangleMesh& mesh, double crease_deg)
      : mesh_(mesh), least_cosine_(std::cos(crease_deg * k_radians_per_degree)) {}

  void gather(std::span<const std::uint32_t> corners) {
    area_.clear();
    spokes_.clear();
    groups_.reset(corners.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const std::size_t t = corners[i] / 3, k = corners[i] % 3;
      const Triangle& triangle = mesh_.triangles[t];
      area_.push_back(cross(mesh_.corner(t, 1) - mesh_.corner(t, 0), mesh_.corner(t, 2) - mesh_.corner(t, 0)));
      spokes_.push_back({triangle[(k + 1) % 3], i, true});
      spokes_.push_back({triangle[(k + 2) % 3], i, false});
    }
  }

  /// Joins corners over edges that exactly two triangles share, in opposite directions, at less than the crease angle.
  void join() {
    std::sort(spokes_.begin(), spokes_.end());
    for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
      while (end < spokes_.size() && spokes_[end].other == spokes_[begin].other) ++end;
      const Spoke &a = spokes_[begin], &b = spokes_[end - 1];
      if (end - begin == 2 && a.outgoing != b.outgoing && is_smooth(area_[a.corner], area_[b.corner]))
        groups_.unite(a.corner, b.corner);
    }
  }

  /// The sum of each group's area vectors, at the place of its smallest corner.
  const std::vector<Vec3>& sums() {
    sums_.assign(area_.size(), Vec3{});
    for (std::uint32_t i = 0; i < area_.size(); ++i) {
      Vec3& sum = sums_[groups_.find(i)];
      sum = sum + area_[i];
    }
    return sums_;
  }

  /// The smallest corner of the group of a corner.
  std::uint32_t group_of(std::uint32_t corner) { return groups_.find(corner); }

 private:
  /// False when a triangle has no area.
  bool is_smooth(Vec3 a, Vec3 b) const { return dot(normalized(a), normalized(b)) >= least_cosine_; }

  const TriangleMesh& mesh_;
  double least_cosine_;
  std::vector<Vec3> area_, sums_;
  std::vector<Spoke> spokes_;
  UnionFind groups_;
};

}  // namespace

CornerAttribute<Vec3> vertex_normals(const TriangleMesh& mesh, double crease_deg) {
  const CornersOfVertices corners = corners_of_vertices(mesh);
  CornerAttribute<Vec3> normals;
  normals.indices.resize(mesh.triangles.size());
  normals.values.reserve(mesh.positions.size());
  Fan fan(mesh, crease_deg);
  std::vector<Index> number;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto at = std::span(corners.list).subspan(corners.first[v], corners.first[v + 1] - corners.first[v]);
    fan.gather(at);
    fan.join();
    const std::vector<Vec3>& sums = fan.sums();
    number.resize(at.size());
    for (std::uint32_t i = 0; i < at.size(); ++i) {
      const std::uint32_t group = fan.group_of(i);
      if (group == i) {  // The smallest corner of a group stands for it and comes first.
        number[i] = static_cast<Index>(normals.values.size());
        const Vec3 normal = normalized(sums[i]);
        normals.values.push_back(normal == Vec3{} ? Vec3{0, 0, 1} : normal);
      }
      normals.indices[at[i] / 3][at[i] % 3] = number[group];
    }
  }
  return normals;
}

}  // namespace papilla
