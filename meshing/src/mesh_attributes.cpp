// SPDX-License-Identifier: MIT
#include "mesh_attributes.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace papilla::detail {
namespace {

template <class T>
void keep_flagged(Values<T>& values, const std::vector<std::uint8_t>& keep) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < values.size(); ++from)
    if (keep[from]) values[to++] = values[from];
  values.resize(to);
}

template <class T>
void drop_unused_values(Values<T>& values, Values<Triangle>& indices) {
  std::vector<Index> new_index(values.size(), k_none);
  for (const Triangle& t : indices)
    for (const Index v : t)
      if (v != k_no_value) new_index[v] = 0;
  Index count = 0;
  for (std::size_t v = 0; v < values.size(); ++v)
    if (new_index[v] != k_none) {
      values[count] = values[v];
      new_index[v] = count++;
    }
  if (count == values.size()) return;
  values.resize(count);
  for (Triangle& t : indices)
    for (Index& v : t)
      if (v != k_no_value) v = new_index[v];
}

void negate_normals(CornerAttribute<Vec3>& normals, const std::vector<std::uint8_t>& reverse) {
  if (normals.empty()) return;
  std::vector<Index> negated(normals.values.size(), k_none);
  for (std::size_t t = 0; t < reverse.size(); ++t) {
    if (!reverse[t] || !normals.has_value(t)) continue;
    for (Index& n : normals.indices[t]) {
      if (negated[n] == k_none) {
        negated[n] = static_cast<Index>(normals.values.size());
        normals.values.push_back(-normals.values[n]);
      }
      n = negated[n];
    }
  }
}

Vec3 mix(const Vec3& a, const Vec3& b, double s) { return (1 - s) * a + s * b; }
Vec2 mix(const Vec2& a, const Vec2& b, double s) { return (1 - s) * a + s * b; }
Color mix(const Color& a, const Color& b, double s) {
  const float t = static_cast<float>(s);
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), a.a + t * (b.a - a.a)};
}

}  // namespace

void keep_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& keep) {
  if (std::find(keep.begin(), keep.end(), std::uint8_t{0}) == keep.end()) return;
  keep_flagged(mesh.triangles, keep);
  for_each_corner_attribute(mesh, [&](auto& attribute) { keep_flagged(attribute.indices, keep); });
  for_each_label(mesh, [&](auto& labels) { keep_flagged(labels, keep); });
}

std::size_t drop_repeated_corners(TriangleMesh& mesh) {
  const std::size_t before = mesh.triangles.size();
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), repeats_corner)) return 0;
  std::vector<std::uint8_t> keep(before);
  for (std::size_t t = 0; t < before; ++t) keep[t] = !repeats_corner(mesh.triangles[t]);
  keep_triangles(mesh, keep);
  return before - mesh.triangles.size();
}

void drop_unused(TriangleMesh& mesh) {
  drop_unused_values(mesh.positions, mesh.triangles);
  for_each_corner_attribute(mesh, [](auto& attribute) { drop_unused_values(attribute.values, attribute.indices); });
}

void reverse_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& reverse) {
  const auto reverse_corners = [&](std::span<Triangle> triangles) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (reverse[t]) std::swap(triangles[t][1], triangles[t][2]);
  };
  reverse_corners(mesh.triangles);
  for_each_corner_attribute(mesh, [&](auto& attribute) { reverse_corners(attribute.indices); });
  negate_normals(mesh.normals, reverse);
}

Index split_triangle(TriangleMesh& mesh, Index triangle, std::size_t k, Index vertex, double s) {
  const std::size_t next = next_corner(k);
  const auto split_indices = [&](Values<Triangle>& triangles, Index value) {
    Triangle second = triangles[triangle];
    second[k] = value;
    triangles[triangle][next] = value;
    triangles.push_back(second);
  };
  const Index second = static_cast<Index>(mesh.triangles.size());
  split_indices(mesh.triangles, vertex);
  for_each_corner_attribute(mesh, [&](auto& attribute) {
    if (attribute.empty()) return;
    const Triangle t = attribute.indices[triangle];
    if (!attribute.has_value(triangle)) {
      attribute.indices.push_back(t);
      return;
    }
    attribute.values.push_back(mix(attribute.values[t[k]], attribute.values[t[next]], s));
    split_indices(attribute.indices, static_cast<Index>(attribute.values.size() - 1));
  });
  if (mesh.normals.has_value(triangle)) mesh.normals.values.back() = normalized(mesh.normals.values.back());
  for_each_label(mesh, [&](auto& labels) {
    if (!labels.empty()) labels.push_back(std::uint32_t{labels[triangle]});
  });
  return second;
}

}  // namespace papilla::detail
