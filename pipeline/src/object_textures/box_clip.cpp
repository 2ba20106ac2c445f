// SPDX-License-Identifier: MIT
#include "object_textures/box_clip.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

double& axis_of(Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
double axis_of(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Where the line between two corners meets the face `axis` = `bound`. The result does not depend on their order.
ClippedCorner cut(ClippedCorner a, ClippedCorner b, int axis, double bound) {
  if (b.box < a.box) std::swap(a, b);
  const double da = axis_of(a.box, axis) - bound, db = axis_of(b.box, axis) - bound;
  const double share_a = db / (db - da), share_b = da / (da - db);
  ClippedCorner c;
  for (std::size_t k = 0; k < 3; ++k) c.weights[k] = share_a * a.weights[k] + share_b * b.weights[k];
  c.box = share_a * a.box + share_b * b.box;
  axis_of(c.box, axis) = bound;
  return c;
}

/// The side of a face that is kept: above 0, or below 1.
std::vector<ClippedCorner> cut_polygon(const std::vector<ClippedCorner>& polygon, int axis, double bound) {
  const auto depth = [&](const ClippedCorner& c) {
    return bound == 0 ? axis_of(c.box, axis) : 1 - axis_of(c.box, axis);
  };
  std::vector<ClippedCorner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClippedCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = depth(a), db = depth(b);
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(cut(a, b, axis, bound));
  }
  return kept;
}

template <class T>
T mixed(const std::array<double, 3>& weights, const T& a, const T& b, const T& c) {
  return weights[0] * a + weights[1] * b + weights[2] * c;
}

/// Linear part of a map, and its inverse applied to a direction.
Vec3 direction_before(const Transform& t, Vec3 d) {
  const Vec3 x{t[0], t[4], t[8]}, y{t[1], t[5], t[9]}, z{t[2], t[6], t[10]};
  const double det = dot(x, cross(y, z));
  return (1 / det) * Vec3{dot(d, cross(y, z)), dot(d, cross(z, x)), dot(d, cross(x, y))};
}

/// Collects the triangles of a patch; corners at one place with one normal are one vertex.
class PatchBuilder {
 public:
  explicit PatchBuilder(TriangleMesh& mesh) : mesh_(mesh) {}

  struct Corner {
    Vec3 position;
    Vec2 uv;
    std::optional<Vec3> normal;
  };

  void add(const Corner& a, const Corner& b, const Corner& c, std::uint32_t slot) {
    const Triangle corners{vertex(a), vertex(b), vertex(c)};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    mesh_.triangles.push_back(corners);
    mesh_.uv.indices.push_back(corners);
    mesh_.material.push_back(slot);
    if (!a.normal) return;
    const auto first = static_cast<Index>(mesh_.normals.values.size());
    mesh_.normals.values.insert(mesh_.normals.values.end(), {*a.normal, *b.normal, *c.normal});
    mesh_.normals.indices.push_back({first, first + 1, first + 2});
  }

 private:
  Index vertex(const Corner& corner) {
    const auto [it, is_new] = vertices_.try_emplace({corner.position, corner.uv}, Index{0});
    if (is_new) {
      it->second = static_cast<Index>(mesh_.positions.size());
      mesh_.positions.push_back(corner.position);
      mesh_.uv.values.push_back(corner.uv);
    }
    return it->second;
  }

  TriangleMesh& mesh_;
  std::map<std::pair<Vec3, Vec2>, Index> vertices_;
};

}  // namespace

ProjectorAxes projector_axes(Vec3 direction, Vec3 up) {
  constexpr double k_least_angle = 1e-6;
  const Vec3 forward = normalized(direction), right = cross(forward, normalized(up));
  if (!(norm(right) > k_least_angle)) throw InvalidInput("the direction is zero, or along up");
  return {normalized(right), cross(normalized(right), forward), forward};
}

Vec3 BoxFrame::to_box(Vec3 p) const noexcept {
  const Vec3 d = p - box_.at;
  return {0.5 + dot(d, axes_.right) / box_.width_mm, 0.5 + dot(d, axes_.up) / box_.height_mm,
          0.5 + dot(d, axes_.forward) / box_.depth_mm};
}

std::vector<ClippedCorner> clip_to_unit_cube(const std::array<Vec3, 3>& corners) {
  std::vector<ClippedCorner> polygon{{{1, 0, 0}, corners[0]}, {{0, 1, 0}, corners[1]}, {{0, 0, 1}, corners[2]}};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax({axis_of(corners[0], axis), axis_of(corners[1], axis), axis_of(corners[2], axis)});
    if (high < 0 || low > 1) return {};
  }
  for (int axis = 0; axis < 3 && !polygon.empty(); ++axis)
    for (const double bound : {0.0, 1.0}) polygon = cut_polygon(polygon, axis, bound);
  if (polygon.size() < 3) polygon.clear();
  return polygon;
}

bool may_meet(const Bounds3& part, const Transform& world, const BoxFrame& frame) {
  constexpr double k_rounding = 1e-6;  // of the box
  if (part.is_empty()) return false;
  Bounds3 in_box;
  for (const double x : {part.low.x, part.high.x})
    for (const double y : {part.low.y, part.high.y})
      for (const double z : {part.low.z, part.high.z}) in_box.add(frame.to_box(transform_point(world, {x, y, z})));
  return in_box.overlaps({{0, 0, 0}, {1, 1, 1}}, k_rounding);
}

bool is_within(const TriangleMesh& mesh, Index triangle, const Transform& world, const BoxFrame& frame) noexcept {
  for (int k = 0; k < 3; ++k) {
    const Vec3 b = frame.to_box(transform_point(world, mesh.corner(triangle, k)));
    if (!(b.x >= 0 && b.x <= 1 && b.y >= 0 && b.y <= 1 && b.z >= 0 && b.z <= 1)) return false;
  }
  return true;
}

DecalPatch cut_decal(const TriangleMesh& mesh, const std::vector<std::uint32_t>& slots, const Transform& world,
                     const BoxFrame& frame, double max_angle_deg, double offset_mm) {
  DecalPatch patch;
  PatchBuilder builder(patch.mesh);
  const double least_cosine = std::cos(max_angle_deg * std::numbers::pi / 180);
  const double sense = determinant(world) < 0 ? -1 : 1;
  const Vec3 offset = direction_before(world, -offset_mm * frame.axes().forward);
  const bool with_normals = !mesh.normals.empty();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t slot = mesh.material.empty() ? 0 : mesh.material[t];
    if (std::find(slots.begin(), slots.end(), slot) == slots.end()) continue;
    std::array<Vec3, 3> in_scene, in_box;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      in_scene[i] = transform_point(world, mesh.corner(t, k));
      in_box[i] = frame.to_box(in_scene[i]);
    }
    const std::vector<ClippedCorner> polygon = clip_to_unit_cube(in_box);
    if (polygon.empty()) continue;
    const Vec3 doubled = sense * cross(in_scene[1] - in_scene[0], in_scene[2] - in_scene[0]);
    if (!(-dot(normalized(doubled), frame.axes().forward) >= least_cosine) || !(norm(doubled) > 0)) {
      ++patch.turned_off;
      continue;
    }
    const auto normal_at = [&](std::size_t k) { return mesh.normals.values[mesh.normals.indices[t][k]]; };
    const auto corner = [&](const ClippedCorner& c) {
      PatchBuilder::Corner made;
      made.position = mixed(c.weights, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) + offset;
      made.uv = {c.box.x, c.box.y};
      if (with_normals)
        made.normal =
            mesh.normals.has_value(t)
                ? normalized(mixed(c.weights, normal_at(0), normal_at(1), normal_at(2)))
                : normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
      return made;
    };
    const auto place = [&](const ClippedCorner& c) { return mixed(c.weights, in_scene[0], in_scene[1], in_scene[2]); };
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      const Vec3 origin = place(polygon[0]);
      patch.area_mm2 += 0.5 * norm(cross(place(polygon[k]) - origin, place(polygon[k + 1]) - origin));
      builder.add(corner(polygon[0]), corner(polygon[k]), corner(polygon[k + 1]), slot);
    }
  }
  return patch;
}

}  // namespace papilla
