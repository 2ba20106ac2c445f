// SPDX-License-Identifier: MIT
#include "papilla/meshing/mesh_assembly.hpp"

#include <algorithm>
#include <span>

namespace papilla {
namespace {

constexpr Triangle k_no_values = {k_no_value, k_no_value, k_no_value};

/// The numbers that `triangles` use lie in [first, second).
std::pair<Index, Index> used_range(std::span<const Triangle> indices, std::span<const Index> triangles) {
  Index first = k_no_value, last = 0;
  for (const Index t : triangles)
    for (const Index i : indices[t])
      if (i != k_no_value) {
        first = std::min(first, i);
        last = std::max(last, i + 1);
      }
  return {std::min(first, last), last};
}

/// Copies the values that `triangles` use, renumbered in order of first use.
template <class T>
void extract_values(std::span<const T> values, std::span<const Triangle> indices, std::span<const Index> triangles,
                    Values<T>& out_values, Values<Triangle>& out_indices) {
  const auto [first, last] = used_range(indices, triangles);
  std::vector<Index> number(last - first, k_no_value);
  out_values.reserve(std::min(number.size(), triangles.size()));
  out_indices.reserve(triangles.size());
  for (const Index t : triangles) {
    Triangle corners = indices[t];
    for (Index& corner : corners) {
      if (corner == k_no_value) continue;
      Index& seen = number[corner - first];
      if (seen == k_no_value) {
        seen = static_cast<Index>(out_values.size());
        out_values.push_back(values[corner]);
      }
      corner = seen;
    }
    out_indices.push_back(corners);
  }
}

template <class T>
CornerAttribute<T> extract(const CornerAttribute<T>& attribute, std::span<const Index> triangles) {
  CornerAttribute<T> out;
  if (!attribute.empty()) extract_values<T>(attribute.values, attribute.indices, triangles, out.values, out.indices);
  return out;
}

Values<std::uint32_t> extract(std::span<const std::uint32_t> numbers, std::span<const Index> triangles) {
  Values<std::uint32_t> out;
  if (numbers.empty()) return out;
  out.reserve(triangles.size());
  for (const Index t : triangles) out.push_back(numbers[t]);
  return out;
}

template <class T>
void append(CornerAttribute<T>& target, std::size_t target_triangles, const CornerAttribute<T>& piece,
            std::size_t piece_triangles) {
  if (target.empty() && piece.empty()) return;
  target.indices.resize(target_triangles, k_no_values);
  const auto base = static_cast<Index>(target.values.size());
  target.values.insert(target.values.end(), piece.values.begin(), piece.values.end());
  if (piece.empty()) {
    target.indices.resize(target_triangles + piece_triangles, k_no_values);
    return;
  }
  for (Triangle corners : piece.indices) {
    for (Index& corner : corners)
      if (corner != k_no_value) corner += base;
    target.indices.push_back(corners);
  }
}

void append(Values<std::uint32_t>& target, std::size_t target_triangles, std::span<const std::uint32_t> piece,
            std::size_t piece_triangles) {
  if (target.empty() && piece.empty()) return;
  target.resize(target_triangles, 0);
  if (piece.empty())
    target.resize(target_triangles + piece_triangles, 0);
  else
    target.insert(target.end(), piece.begin(), piece.end());
}

}  // namespace

TriangleMesh extract_triangles(const TriangleMesh& mesh, std::span<const Index> triangles) {
  TriangleMesh out;
  extract_values<Vec3>(mesh.positions, mesh.triangles, triangles, out.positions, out.triangles);
  out.normals = extract(mesh.normals, triangles);
  out.uv = extract(mesh.uv, triangles);
  out.uv1 = extract(mesh.uv1, triangles);
  out.cad_uv = extract(mesh.cad_uv, triangles);
  out.colors = extract(mesh.colors, triangles);
  out.material = extract(mesh.material, triangles);
  out.face = extract(mesh.face, triangles);
  return out;
}

void append_mesh(TriangleMesh& mesh, const TriangleMesh& piece) {
  const std::size_t before = mesh.triangles.size(), added = piece.triangles.size();
  append(mesh.normals, before, piece.normals, added);
  append(mesh.uv, before, piece.uv, added);
  append(mesh.uv1, before, piece.uv1, added);
  append(mesh.cad_uv, before, piece.cad_uv, added);
  append(mesh.colors, before, piece.colors, added);
  append(mesh.material, before, piece.material, added);
  append(mesh.face, before, piece.face, added);
  const auto base = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), piece.positions.begin(), piece.positions.end());
  for (const Triangle& t : piece.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

}  // namespace papilla
