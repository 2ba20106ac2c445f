// SPDX-License-Identifier: MIT
#include "wedge_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "exact_positions.hpp"
#include "mesh_attributes.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/union_find.hpp"
#include "papilla/core/units.hpp"

namespace papilla::detail {
namespace {

template <class T>
bool same_value(const CornerAttribute<T>& attribute, Index a, Index b) {
  if (attribute.empty()) return true;
  const Index i = attribute.indices[a / 3][a % 3], j = attribute.indices[b / 3][b % 3];
  if (i == j) return true;
  return i != k_no_value && j != k_no_value && attribute.values[i] == attribute.values[j];
}

bool same_label(std::span<const std::uint32_t> labels, Index a, Index b) {
  return labels.empty() || labels[a / 3] == labels[b / 3];
}

/// Decides which corners of neighbouring triangles are joined.
class SmoothEdges {
 public:
  SmoothEdges(const TriangleMesh& mesh, const WedgeMesh& wedges, std::span<const Triangle> triangles,
              double feature_angle_deg, bool keep_faces)
      : mesh_(mesh),
        cos_feature_(std::cos(std::min(feature_angle_deg, 180.0) * k_radians_per_degree)),
        has_features_(feature_angle_deg < 180),
        keep_faces_(keep_faces),
        normals_(mesh.triangles.size()) {
    Bounds3 bounds;
    for (const Vec3& p : wedges.positions) bounds.add(p);
    // Below this altitude the single-precision noise of files turns a normal by more than about 3 degrees.
    const double least_altitude = 1e-6 * bounds.diagonal();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Vec3 &a = wedges.positions[triangles[t][0]], &b = wedges.positions[triangles[t][1]],
                 &c = wedges.positions[triangles[t][2]];
      const Vec3 n = cross(b - a, c - a);
      const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
      if (norm(n) > least_altitude * longest) normals_[t] = normalized(n);
    }
  }

  bool operator()(Index corner_a, Index corner_b, Index other_a, Index other_b) const {
    return same_label(mesh_.material, corner_a, other_a) &&
           (!keep_faces_ || same_label(mesh_.face, corner_a, other_a)) && same(corner_a, other_a) &&
           same(corner_b, other_b) && is_flat(corner_a / 3, other_a / 3);
  }

 private:
  bool same(Index a, Index b) const {
    return same_value(mesh_.uv, a, b) && same_value(mesh_.uv1, a, b) && same_value(mesh_.cad_uv, a, b) &&
           same_value(mesh_.colors, a, b);
  }
  bool is_flat(std::size_t a, std::size_t b) const {
    const bool known = dot(normals_[a], normals_[a]) > 0 && dot(normals_[b], normals_[b]) > 0;
    return !has_features_ || !known || dot(normals_[a], normals_[b]) >= cos_feature_;
  }

  const TriangleMesh& mesh_;
  double cos_feature_;
  bool has_features_, keep_faces_;
  std::vector<Vec3> normals_;  ///< Zero where it can't be trusted.
};

void average_normals(const TriangleMesh& mesh, WedgeMesh& wedges) {
  wedges.normal_of_wedge.assign(wedges.position_of_wedge.size(), Vec3{});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.normals.has_value(t)) continue;
    const double area = norm(area_vector(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)));
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& sum = wedges.normal_of_wedge[wedges.wedge_of_corner[3 * t + k]];
      sum = sum + area * mesh.normals.values[mesh.normals.indices[t][k]];
    }
  }
  for (Vec3& n : wedges.normal_of_wedge) n = normalized(n);
}

/// Copies values on first use.
template <class T>
class AttributeExtractor {
 public:
  AttributeExtractor(const CornerAttribute<T>& source, CornerAttribute<T>& target)
      : source_(source), target_(target), moved_(source.values.size(), k_no_value) {}

  void add(const Triangle& corners) {
    if (source_.empty()) return;
    Triangle indices;
    for (std::size_t k = 0; k < 3; ++k) indices[k] = move(source_.indices[corners[k] / 3][corners[k] % 3]);
    const bool complete = std::find(indices.begin(), indices.end(), k_no_value) == indices.end();
    target_.indices.push_back(complete ? indices : Triangle{k_no_value, k_no_value, k_no_value});
  }

 private:
  Index move(Index index) {
    if (index == k_no_value) return k_no_value;
    if (moved_[index] == k_no_value) {
      moved_[index] = static_cast<Index>(target_.values.size());
      target_.values.push_back(source_.values[index]);
    }
    return moved_[index];
  }

  const CornerAttribute<T>& source_;
  CornerAttribute<T>& target_;
  std::vector<Index> moved_;
};

/// The wedges' normals as an attribute of corners.
CornerAttribute<Vec3> normals_by_wedge(const WedgeMesh& wedges) {
  CornerAttribute<Vec3> normals;
  normals.values = wedges.normal_of_wedge;
  if (normals.values.empty()) return normals;
  normals.indices.resize(wedges.wedge_of_corner.size() / 3);
  for (std::size_t c = 0; c < wedges.wedge_of_corner.size(); ++c) {
    const Index wedge = wedges.wedge_of_corner[c];
    const Vec3& n = normals.values[wedge];
    normals.indices[c / 3][c % 3] = dot(n, n) > 0 ? wedge : k_no_value;
  }
  return normals;
}

}  // namespace

WedgeMesh make_wedges(const TriangleMesh& mesh, double feature_angle_deg, bool keep_faces) {
  WedgeMesh wedges;
  const ExactPositions exact = exact_positions(mesh);
  wedges.positions.reserve(exact.first.size());
  for (const Index v : exact.first) wedges.positions.push_back(mesh.positions[v]);
  std::vector<Triangle> triangles(mesh.triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) triangles[t][k] = exact.of_position[mesh.triangles[t][k]];

  const EdgeTable edges(triangles, wedges.positions.size());
  const SmoothEdges is_smooth(mesh, wedges, triangles, feature_angle_deg, keep_faces);
  UnionFind corners(3 * triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto pair = edges.halfedges(e);
    if (pair.size() != 2 || runs_up(triangles, pair[0]) == runs_up(triangles, pair[1])) continue;
    const Index a = pair[0], b = next_halfedge(pair[0]), other_b = pair[1], other_a = next_halfedge(pair[1]);
    if (!is_smooth(a, b, other_a, other_b)) continue;
    corners.unite(a, other_a);
    corners.unite(b, other_b);
  }
  Index count = 0;
  wedges.wedge_of_corner = corners.labels(count);
  wedges.position_of_wedge.resize(count);
  wedges.corner_of_wedge.resize(count);
  for (Index c = 0; c < wedges.wedge_of_corner.size(); ++c) {
    wedges.position_of_wedge[wedges.wedge_of_corner[c]] = triangles[c / 3][c % 3];
    wedges.corner_of_wedge[wedges.wedge_of_corner[c]] = c;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!repeats_corner(triangles[t]))
      wedges.indices.insert(wedges.indices.end(), wedges.wedge_of_corner.begin() + static_cast<std::ptrdiff_t>(3 * t),
                            wedges.wedge_of_corner.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
  if (!mesh.normals.empty()) average_normals(mesh, wedges);
  return wedges;
}

TriangleMesh extract(const WedgeMesh& wedges, const TriangleMesh& source, std::span<const Index> indices) {
  TriangleMesh mesh;
  const CornerAttribute<Vec3> normals = normals_by_wedge(wedges);
  AttributeExtractor<Vec3> add_normals(normals, mesh.normals);
  AttributeExtractor<Vec2> add_uv(source.uv, mesh.uv), add_uv1(source.uv1, mesh.uv1),
      add_cad_uv(source.cad_uv, mesh.cad_uv);
  AttributeExtractor<Color> add_colors(source.colors, mesh.colors);
  std::vector<Index> moved(wedges.positions.size(), k_no_value);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    Triangle place, corners;
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = wedges.position_of_wedge[indices[i + k]];
      corners[k] = wedges.corner_of_wedge[indices[i + k]];
    }
    if (repeats_corner(place)) continue;
    for (Index& v : place) {
      if (moved[v] == k_no_value) {
        moved[v] = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back(wedges.positions[v]);
      }
      v = moved[v];
    }
    mesh.triangles.push_back(place);
    add_normals.add(corners);
    add_uv.add(corners);
    add_uv1.add(corners);
    add_cad_uv.add(corners);
    add_colors.add(corners);
    if (!source.material.empty()) mesh.material.push_back(source.material[corners[0] / 3]);
    if (!source.face.empty()) mesh.face.push_back(source.face[corners[0] / 3]);
  }
  return mesh;
}

}  // namespace papilla::detail
