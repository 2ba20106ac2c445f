// SPDX-License-Identifier: MIT
#include "papilla/meshing/fill_holes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "repair_steps.hpp"
#include "triangle_shape.hpp"
#include "triangulate_loop.hpp"

namespace papilla {
namespace {

using namespace detail;

constexpr Index k_several = k_none - 1;

/// The boundary half-edge that leaves each vertex; k_none or k_several when there isn't exactly one.
std::vector<Index> leaving_halfedges(std::span<const Triangle> triangles, std::size_t vertex_count,
                                     const std::vector<Index>& boundary) {
  std::vector<Index> leaving(vertex_count, k_none);
  for (const Index h : boundary) {
    Index& first = leaving[from_vertex(triangles, h)];
    first = first == k_none ? h : k_several;
  }
  return leaving;
}

/// The boundary half-edges of an oriented mesh in the order of walking along them, loop by loop; loops begin with their
/// smallest half-edge and come in that order. Loops through a vertex where several borders meet are left out.
std::vector<std::vector<Index>> simple_boundary_loops(std::span<const Triangle> triangles, std::size_t vertex_count,
                                                      const EdgeTable& edges) {
  std::vector<Index> boundary = edges.boundary_halfedges();
  if (boundary.empty()) return {};
  const std::vector<Index> leaving = leaving_halfedges(triangles, vertex_count, boundary);
  std::sort(boundary.begin(), boundary.end());
  std::vector<std::uint8_t> seen(3 * triangles.size(), 0);
  std::vector<std::vector<Index>> loops;
  for (const Index start : boundary) {
    if (seen[start]) continue;
    std::vector<Index> loop;
    Index h = start;
    while (h < k_several && !seen[h]) {
      seen[h] = 1;
      loop.push_back(h);
      h = leaving[to_vertex(triangles, h)];
    }
    if (h == start) loops.push_back(std::move(loop));
  }
  return loops;
}

void check_options(const FillHolesOptions& options) {
  const auto require = [](double value, const char* name) {
    if (!(value >= 0 && std::isfinite(value)))
      throw InvalidInput(std::string("fill_holes: ") + name + " " + std::to_string(value) + " is out of range");
  };
  require(options.max_slit_width_mm, "max_slit_width_mm");
  require(options.max_diameter_mm, "max_diameter_mm");
}

/// A border to fill. Its vertices run against the boundary half-edges, the way the filling must.
struct Loop {
  std::vector<Index> halfedges;  ///< halfedges[i] runs from vertices[i + 1] to vertices[i].
  std::vector<Vec3> polygon;
  std::vector<Index> vertices;
  bool may_be_slit = false, may_be_hole = false;
};

Loop make_loop(const TriangleMesh& mesh, std::vector<Index> halfedges) {
  Loop loop;
  std::reverse(halfedges.begin(), halfedges.end());
  for (const Index h : halfedges) {
    loop.vertices.push_back(to_vertex(mesh.triangles, h));
    loop.polygon.push_back(mesh.positions[loop.vertices.back()]);
  }
  loop.halfedges = std::move(halfedges);
  return loop;
}

/// A filling nowhere wider than w has at most the area w / 2 · perimeter, and no less than the polygon's vector area.
bool may_be_slit(std::span<const Vec3> polygon, double width) {
  Vec3 twice_area{};
  double perimeter = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    twice_area = twice_area + cross(a - polygon[0], b - polygon[0]);
    perimeter += norm(b - a);
  }
  return width > 0 && norm(twice_area) <= width * perimeter;
}

double diameter(std::span<const Vec3> polygon) {
  Bounds3 bounds;
  for (const Vec3& p : polygon) bounds.add(p);
  return bounds.diagonal();
}

constexpr std::uint64_t edge_key(Index a, Index b) noexcept {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

double width_of(std::span<const Triangle> filling, std::span<const Vec3> polygon) {
  double width = 0;
  for (const Triangle& t : filling)
    width = std::max(width, triangle_shape(polygon[t[0]], polygon[t[1]], polygon[t[2]]).altitude);
  return width;
}

class Filler {
 public:
  Filler(TriangleMesh& mesh, const EdgeTable& edges, const FillHolesOptions& options, FillHolesResult& result)
      : mesh_(mesh),
        borders_(simple_boundary_loops(mesh.triangles, mesh.positions.size(), edges)),
        options_(options),
        result_(result) {}

  void run() {
    std::vector<Loop> loops = candidates();
    if (loops.empty()) return;
    note_edges_between_borders(loops);
    for (const Loop& loop : loops) fill(loop);
  }

 private:
  std::vector<Loop> candidates() {
    std::vector<Loop> loops;
    for (std::vector<Index>& halfedges : borders_) {
      if (halfedges.size() < 3 || halfedges.size() > options_.max_edges) continue;
      Loop loop = make_loop(mesh_, std::move(halfedges));
      loop.may_be_slit = may_be_slit(loop.polygon, options_.max_slit_width_mm);
      loop.may_be_hole = options_.max_diameter_mm > 0 && diameter(loop.polygon) <= options_.max_diameter_mm;
      if (loop.may_be_slit || loop.may_be_hole) loops.push_back(std::move(loop));
    }
    return loops;
  }

  void note_edges_between_borders(const std::vector<Loop>& loops) {
    std::vector<std::uint8_t> on_border(mesh_.positions.size(), 0);
    for (const Loop& loop : loops)
      for (const Index v : loop.vertices) on_border[v] = 1;
    for (const Triangle& t : mesh_.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (on_border[t[k]] && on_border[t[next_corner(k)]]) edges_.insert(edge_key(t[k], t[next_corner(k)]));
  }

  void fill(const Loop& loop) {
    const std::vector<Triangle> filling = triangulate_loop(loop.polygon);
    const double width = width_of(filling, loop.polygon);
    const bool slit = loop.may_be_slit && width <= options_.max_slit_width_mm;
    if (!slit && !loop.may_be_hole) return;
    if (filling.empty() || adds_known_edge(filling, loop) || folds_back(filling, loop)) {
      ++result_.refused;
      return;
    }
    for (const Triangle& t : filling) add(t, loop);
    result_.triangles += filling.size();
    ++(slit ? result_.slits : result_.holes);
    if (slit) result_.max_slit_width_mm = std::max(result_.max_slit_width_mm, width);
  }

  /// The side of the polygon that an edge of the filling is; k_none for an inner edge.
  static Index side_of(Index a, Index b, std::size_t sides) noexcept { return (a + 1) % sides == b ? a : k_none; }

  bool adds_known_edge(std::span<const Triangle> filling, const Loop& loop) const {
    for (const Triangle& t : filling)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[next_corner(k)];
        if (side_of(a, b, loop.polygon.size()) == k_none &&
            edges_.contains(edge_key(loop.vertices[a], loop.vertices[b])))
          return true;
      }
    return false;
  }

  bool folds_back(std::span<const Triangle> filling, const Loop& loop) const {
    double folded = 0, length = 0;
    for (const Triangle& t : filling)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index side = side_of(t[k], t[next_corner(k)], loop.polygon.size());
        if (side == k_none) continue;
        const double edge = norm(loop.polygon[t[next_corner(k)]] - loop.polygon[t[k]]);
        const Index neighbour = triangle_of(loop.halfedges[side]);
        const Vec3 outer =
            area_vector(mesh_.corner(neighbour, 0), mesh_.corner(neighbour, 1), mesh_.corner(neighbour, 2));
        const Vec3 inner = area_vector(loop.polygon[t[0]], loop.polygon[t[1]], loop.polygon[t[2]]);
        constexpr double k_folded_cosine = -0.9;
        length += edge;
        if (dot(normalized(outer), normalized(inner)) < k_folded_cosine) folded += edge;
      }
    return 2 * folded > length;
  }

  /// The half-edge of the surface at polygon corner i that starts or ends there.
  std::pair<Index, std::size_t> corner_at(const Loop& loop, Index i) const {
    const Index h = loop.halfedges[i];  // ends at vertex i
    return {triangle_of(h), next_corner(corner_of(h))};
  }

  void add(const Triangle& t, const Loop& loop) {
    mesh_.triangles.push_back({loop.vertices[t[0]], loop.vertices[t[1]], loop.vertices[t[2]]});
    for_each_corner_attribute(mesh_, [&](auto& attribute) {
      if (attribute.empty()) return;
      Triangle values;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [neighbour, corner] = corner_at(loop, t[k]);
        values[k] = attribute.indices[neighbour][corner];
      }
      if (std::find(values.begin(), values.end(), k_no_value) != values.end()) values.fill(k_no_value);
      attribute.indices.push_back(values);
    });
    const Index like = neighbour_with_longest_edge(t, loop);
    for_each_label(mesh_, [&](auto& labels) {
      if (!labels.empty()) labels.push_back(std::uint32_t{labels[like]});
    });
  }

  /// Across the triangle's longest side; across the side after its first corner when it has none.
  Index neighbour_with_longest_edge(const Triangle& t, const Loop& loop) const {
    Index best = triangle_of(loop.halfedges[t[0]]);
    double longest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index side = side_of(t[k], t[next_corner(k)], loop.polygon.size());
      if (side == k_none) continue;
      const double length = norm(loop.polygon[t[next_corner(k)]] - loop.polygon[t[k]]);
      if (length <= longest) continue;
      longest = length;
      best = triangle_of(loop.halfedges[side]);
    }
    return best;
  }

  TriangleMesh& mesh_;
  std::vector<std::vector<Index>> borders_;
  const FillHolesOptions& options_;
  FillHolesResult& result_;
  std::unordered_set<std::uint64_t> edges_;
};

}  // namespace

namespace detail {

bool fill_borders(TriangleMesh& mesh, const EdgeTable& edges, const FillHolesOptions& options,
                  FillHolesResult& result) {
  if (!(options.max_slit_width_mm > 0 || options.max_diameter_mm > 0)) return false;
  Filler(mesh, edges, options, result).run();
  return result.triangles > 0;
}

}  // namespace detail

FillHolesResult fill_holes(TriangleMesh mesh, const FillHolesOptions& options) {
  check_options(options);
  check_mesh(mesh, "fill_holes");
  FillHolesResult result;
  fill_borders(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), options, result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
