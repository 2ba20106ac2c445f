// SPDX-License-Identifier: MIT
#include "triplanar_labels.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/cpu_clones.hpp"

namespace papilla::param_detail {
namespace {

/// Relative distance below which two normal components count as equal, so that rounding does not decide.
constexpr double k_tie = 1 + 1e-6;

/// A triangle is without area when its doubled area is below this fraction of its longest edge squared;
/// its normal would be rounding noise.
constexpr double k_no_area = 1e-12;

struct Normal {
  Vec3 direction;             ///< Of the length of the doubled area.
  double squared_length = 0;  ///< 0 when the triangle is without area.
};

inline Normal normal_of(const TriangleMesh& mesh, std::size_t t) {
  const Triangle& corners = mesh.triangles[t];
  const Vec3 a = mesh.positions[corners[0]];
  const Vec3 p = mesh.positions[corners[1]] - a, q = mesh.positions[corners[2]] - a;
  const Vec3 n = cross(p, q);
  const double square = dot(n, n), longest = dot(p, p) + dot(q, q);
  return {n, square > k_no_area * k_no_area * longest * longest ? square : 0};
}

/// Triangles whose normals are found side by side.
constexpr std::size_t k_batch = 64;

/// Two edges of each triangle, coordinate by coordinate.
struct EdgeBatch {
  double px[k_batch] = {}, py[k_batch] = {}, pz[k_batch] = {}, qx[k_batch] = {}, qy[k_batch] = {}, qz[k_batch] = {};
};

struct LabelBatch {
  std::uint8_t label[k_batch];
  float doubled_area[k_batch];
};

/// The same as normal_of() and the largest component of it, without branches.
PAPILLA_CPU_CLONES("arch=x86-64-v3")
void label_batch(const EdgeBatch& e, LabelBatch& result) {
  double label[k_batch], squared[k_batch];
  for (std::size_t i = 0; i < k_batch; ++i) {
    const double x = e.py[i] * e.qz[i] - e.pz[i] * e.qy[i], y = e.pz[i] * e.qx[i] - e.px[i] * e.qz[i],
                 z = e.px[i] * e.qy[i] - e.py[i] * e.qx[i];
    const double square = x * x + y * y + z * z;
    const double longest = e.px[i] * e.px[i] + e.py[i] * e.py[i] + e.pz[i] * e.pz[i] + e.qx[i] * e.qx[i] +
                           e.qy[i] * e.qy[i] + e.qz[i] * e.qz[i];
    const double ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
    const bool by_y = ay > k_tie * ax;
    const double most = by_y ? ay : ax;
    const bool by_z = az > k_tie * most;
    const double along = by_z ? z : by_y ? y : x, axis = by_z ? 4 : by_y ? 2 : 0;
    const bool has_area = square > k_no_area * k_no_area * longest * longest;
    label[i] = has_area ? (along < 0 ? axis + 1 : axis) : k_no_label;
    squared[i] = has_area ? square : 0;
  }
  for (std::size_t i = 0; i < k_batch; ++i) {
    result.label[i] = static_cast<std::uint8_t>(static_cast<int>(label[i]));
    result.doubled_area[i] = static_cast<float>(std::sqrt(squared[i]));
  }
}

}  // namespace

LabelledTriangles label_triangles(const TriangleMesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  LabelledTriangles result;
  result.label.reserve(count);
  result.doubled_area.reserve(count);
  EdgeBatch edges;
  LabelBatch labels;
  for (std::size_t begin = 0; begin < count; begin += k_batch) {
    const std::size_t size = std::min(k_batch, count - begin);
    for (std::size_t i = 0; i < size; ++i) {
      const Triangle& corners = mesh.triangles[begin + i];
      const Vec3 a = mesh.positions[corners[0]];
      const Vec3 p = mesh.positions[corners[1]] - a, q = mesh.positions[corners[2]] - a;
      edges.px[i] = p.x, edges.py[i] = p.y, edges.pz[i] = p.z;
      edges.qx[i] = q.x, edges.qy[i] = q.y, edges.qz[i] = q.z;
    }
    label_batch(edges, labels);
    result.label.insert(result.label.end(), labels.label, labels.label + size);
    result.doubled_area.insert(result.doubled_area.end(), labels.doubled_area, labels.doubled_area + size);
  }
  return result;
}

bool accepts(const TriangleMesh& mesh, Index t, std::uint8_t label, double cosine) {
  const Normal n = normal_of(mesh, t);
  const int axis = label >> 1;
  const double along = axis == 0 ? n.direction.x : axis == 1 ? n.direction.y : n.direction.z;
  return n.squared_length == 0 || (label & 1 ? -along : along) >= cosine * std::sqrt(n.squared_length);
}

void fill_missing_labels(const Adjacency& across, LabelledTriangles& triangles) {
  std::vector<std::uint8_t>& label = triangles.label;
  std::vector<Index> front;
  for (Index t = 0; t < label.size(); ++t) {
    if (label[t] != k_no_label) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across[3 * std::size_t{t} + k];
      if (other == k_no_triangle || label[other] == k_no_label) continue;
      front.push_back(other);
    }
  }
  for (std::size_t i = 0; i < front.size(); ++i) {
    const Index t = front[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across[3 * std::size_t{t} + k];
      if (other == k_no_triangle || label[other] != k_no_label) continue;
      label[other] = label[t];
      front.push_back(other);
    }
  }
  for (std::uint8_t& l : label)
    if (l == k_no_label) l = 0;
}

std::size_t smooth_labels_once(const TriangleMesh& mesh, const Adjacency& across, double cosine,
                               LabelledTriangles& triangles) {
  std::vector<std::uint8_t>& label = triangles.label;
  std::size_t changed = 0;
  for (Index t = 0; t < label.size(); ++t) {
    const Index* neighbour = &across[3 * std::size_t{t}];
    const std::uint8_t own = label[t];
    Index unlike[3];
    int unlike_count = 0;
    for (int k = 0; k < 3; ++k)
      if (neighbour[k] != k_no_triangle && label[neighbour[k]] != own) unlike[unlike_count++] = neighbour[k];
    if (unlike_count < 2) continue;
    std::uint8_t wanted = k_no_label;
    float weight = -1;
    for (int i = 0; i < unlike_count; ++i)
      for (int j = i + 1; j < unlike_count; ++j) {
        if (label[unlike[i]] != label[unlike[j]]) continue;
        const float both = triangles.doubled_area[unlike[i]] + triangles.doubled_area[unlike[j]];
        if (both > weight) weight = both, wanted = label[unlike[i]];
      }
    if (wanted == k_no_label || !accepts(mesh, t, wanted, cosine)) continue;
    label[t] = wanted;
    ++changed;
  }
  return changed;
}

std::size_t count_lone_triangles(const Adjacency& across, const LabelledTriangles& triangles) {
  std::size_t lone = 0;
  for (Index t = 0; t < triangles.label.size(); ++t) {
    bool has_neighbour = false, has_like = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across[3 * std::size_t{t} + k];
      if (other == k_no_triangle) continue;
      has_neighbour = true;
      has_like |= triangles.label[other] == triangles.label[t];
    }
    lone += has_neighbour && !has_like;
  }
  return lone;
}

}  // namespace papilla::param_detail
