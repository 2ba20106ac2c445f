// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_mesh.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace papilla::app {
namespace {

/// What makes corners one vertex.
struct Corner {
  std::array<float, 3> position{}, normal{};
  std::array<float, 2> uv{}, uv1{};
};

/// A vertex as it goes into the stream; see PageMesh.
struct Packed {
  std::array<std::uint16_t, 4> position{};
  std::array<std::uint16_t, 2> uv{};
  std::array<std::int8_t, 4> normal{};
  std::array<std::uint16_t, 4> measured{};
};
static_assert(sizeof(Packed) == 24);

/// Sums of the triangles around a vertex.
struct Around {
  Vec3 normal;
  double weight = 0, stretch = 0, angle = 0, density = 0;
};

/// Share of the extent that simplification may move the surface; beyond it clustering takes over.
constexpr float k_most_error = 0.05F;
/// Clustering when simplification stays above this multiple of what was asked.
constexpr double k_too_many = 1.5;
/// Triangles shown while the camera moves, as a share of those shown at rest.
constexpr double k_coarse = 0.1;
/// No fewer triangles than this are asked of a mesh: a knob stays a knob.
constexpr std::size_t k_least_triangles = 64;

std::array<float, 3> floats(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::uint16_t unit16(double value) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(value, 0.0, 1.0)));
}

std::uint16_t log_code(double value) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(2048 * (std::log2(value) + 16)), 0L, 65534L));
}

std::uint16_t angle_code(double degrees) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(degrees / 180 * 65534), 0L, 65534L));
}

class Builder {
 public:
  Builder(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, bool needs_uv1, const DistortionReport& report)
      : mesh_(mesh), uv_(uv), needs_uv1_(needs_uv1 && !mesh.uv1.empty()), report_(report) {}

  PageMesh build(std::uint32_t slot, const std::vector<std::size_t>& triangles, double keep) {
    PageMesh out;
    out.slot = slot;
    out.triangles = triangles.size();
    gather(triangles, out);
    simplify(keep, out);
    find_bounds(out);
    encode(out);
    return out;
  }

 private:
  Corner corner(std::size_t t, std::size_t k) const {
    Corner c;
    c.position = floats(mesh_.positions[mesh_.triangles[t][k]]);
    if (mesh_.normals.has_value(t)) c.normal = floats(mesh_.normals.values[mesh_.normals.indices[t][k]]);
    c.uv = uv_at(uv_, t, k);
    if (needs_uv1_) c.uv1 = uv_at(mesh_.uv1, t, k);
    return c;
  }

  static std::array<float, 2> uv_at(const CornerAttribute<Vec2>& uv, std::size_t t, std::size_t k) {
    if (!uv.has_value(t)) return {};
    const Vec2 value = uv.values[uv.indices[t][k]];
    return {static_cast<float>(value.x), static_cast<float>(1 - value.y)};  // glTF's v runs down
  }

  void gather(const std::vector<std::size_t>& triangles, PageMesh& out) {
    std::vector<Corner> corners;
    corners.reserve(3 * triangles.size());
    for (const std::size_t t : triangles) {
      for (std::size_t k = 0; k < 3; ++k) corners.push_back(corner(t, k));
      out.has_uv = out.has_uv || uv_.has_value(t);
    }
    std::vector<unsigned int> remap(corners.size());
    const std::size_t count = meshopt_generateVertexRemap(remap.data(), nullptr, corners.size(), corners.data(),
                                                          corners.size(), sizeof(Corner));
    vertices_.assign(count, {});
    around_.assign(count, {});
    for (std::size_t i = 0; i < corners.size(); ++i) {
      vertices_[remap[i]] = corners[i];
      add_around(triangles[i / 3], around_[remap[i]]);
    }
    indices_ = std::move(remap);
  }

  void add_around(std::size_t t, Around& around) const {
    const Vec3 area = 0.5 * cross(mesh_.corner(t, 1) - mesh_.corner(t, 0), mesh_.corner(t, 2) - mesh_.corner(t, 0));
    around.normal = around.normal + area;
    if (t >= report_.per_triangle.size() || !report_.per_triangle[t].measured) return;
    const TriangleDistortion& distortion = report_.per_triangle[t];
    around.weight += distortion.area_mm2;
    around.stretch += distortion.area_mm2 * distortion.stretch_l2;
    around.angle += distortion.area_mm2 * distortion.angle_error_deg;
    around.density += distortion.area_mm2 * distortion.texels_per_mm;
  }

  /// Triangles over the same vertices, about `keep` times as many; all of them when fewer make no surface.
  std::vector<unsigned int> fewer(double keep, double& error_mm) const {
    const auto wanted = static_cast<std::size_t>(keep * static_cast<double>(indices_.size() / 3));
    const std::size_t target = 3 * std::max(wanted, k_least_triangles);
    if (keep >= 1 || target >= indices_.size()) return indices_;
    const float* positions = vertices_.front().position.data();
    std::vector<unsigned int> result(indices_.size());
    float error = 0;
    result.resize(meshopt_simplify(result.data(), indices_.data(), indices_.size(), positions, vertices_.size(),
                                   sizeof(Corner), target, k_most_error, 0, &error));
    if (static_cast<double>(result.size()) > k_too_many * static_cast<double>(target)) {
      result.resize(indices_.size());
      result.resize(meshopt_simplifySloppy(result.data(), indices_.data(), indices_.size(), positions, vertices_.size(),
                                           sizeof(Corner), target, 1, &error));
    }
    if (result.empty()) return indices_;
    error_mm = static_cast<double>(error * meshopt_simplifyScale(positions, vertices_.size(), sizeof(Corner)));
    return result;
  }

  void simplify(double keep, PageMesh& out) {
    indices_ = fewer(keep, out.error_mm);
    out.shown = indices_.size() / 3;
    meshopt_optimizeVertexCache(indices_.data(), indices_.data(), indices_.size(), vertices_.size());
    double unused = 0;
    coarse_ = fewer(k_coarse, unused);
    out.coarse = coarse_.size() / 3;
    order_.resize(vertices_.size());
    std::vector<unsigned int> used = indices_;  // clustering may choose vertices that the finer triangles have not
    used.insert(used.end(), coarse_.begin(), coarse_.end());
    out.vertices = meshopt_optimizeVertexFetchRemap(order_.data(), used.data(), used.size(), vertices_.size());
    for (std::vector<unsigned int>* list : {&indices_, &coarse_})
      meshopt_remapIndexBuffer(list->data(), list->data(), list->size(), order_.data());
  }

  void find_bounds(PageMesh& out) const {
    constexpr double far = std::numeric_limits<double>::max();
    out.low = {far, far, far}, out.high = {-far, -far, -far};
    out.uv_low = out.uv1_low = {far, far}, out.uv_high = out.uv1_high = {-far, -far};
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (order_[i] == ~0U) continue;
      const auto& [x, y, z] = vertices_[i].position;
      const auto& [u, v] = vertices_[i].uv;
      const auto& [u1, v1] = vertices_[i].uv1;
      out.low = {std::min<double>(out.low.x, x), std::min<double>(out.low.y, y), std::min<double>(out.low.z, z)};
      out.high = {std::max<double>(out.high.x, x), std::max<double>(out.high.y, y), std::max<double>(out.high.z, z)};
      out.uv_low = {std::min<double>(out.uv_low.x, u), std::min<double>(out.uv_low.y, v)};
      out.uv_high = {std::max<double>(out.uv_high.x, u), std::max<double>(out.uv_high.y, v)};
      out.uv1_low = {std::min<double>(out.uv1_low.x, u1), std::min<double>(out.uv1_low.y, v1)};
      out.uv1_high = {std::max<double>(out.uv1_high.x, u1), std::max<double>(out.uv1_high.y, v1)};
    }
  }

  static std::uint16_t within(double value, double low, double high) {
    return high > low ? unit16((value - low) / (high - low)) : 0;
  }

  Packed pack(const Corner& corner, const Around& around, const PageMesh& mesh) const {
    Packed packed;
    const auto& [x, y, z] = corner.position;
    packed.position = {within(x, mesh.low.x, mesh.high.x), within(y, mesh.low.y, mesh.high.y),
                       within(z, mesh.low.z, mesh.high.z), 0};
    packed.uv = {within(corner.uv[0], mesh.uv_low.x, mesh.uv_high.x),
                 within(corner.uv[1], mesh.uv_low.y, mesh.uv_high.y)};
    const Vec3 given{corner.normal[0], corner.normal[1], corner.normal[2]};
    const Vec3 normal = normalized(norm(given) > 0 ? given : around.normal);
    const auto unit8 = [](double value) {
      return static_cast<std::int8_t>(std::lround(127 * std::clamp(value, -1.0, 1.0)));
    };
    packed.normal = {unit8(normal.x), unit8(normal.y), unit8(normal.z), 0};
    packed.measured = {k_page_no_value, k_page_no_value, k_page_no_value, 0};
    if (around.weight > 0)
      packed.measured = {log_code(around.stretch / around.weight), angle_code(around.angle / around.weight),
                         log_code(around.density / around.weight), 0};
    return packed;
  }

  std::vector<std::array<std::uint16_t, 2>> packed_uv1(const PageMesh& out) const {
    std::vector<std::array<std::uint16_t, 2>> packed(out.vertices);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      if (order_[i] != ~0U)
        packed[order_[i]] = {within(vertices_[i].uv1[0], out.uv1_low.x, out.uv1_high.x),
                             within(vertices_[i].uv1[1], out.uv1_low.y, out.uv1_high.y)};
    return packed;
  }

  void encode(PageMesh& out) const {
    std::vector<Packed> packed(out.vertices);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      if (order_[i] != ~0U) packed[order_[i]] = pack(vertices_[i], around_[i], out);
    const auto bytes = [](std::vector<std::byte>& stream) { return reinterpret_cast<unsigned char*>(stream.data()); };
    const auto encode_vertices = [&](const auto& values, std::vector<std::byte>& stream) {
      constexpr std::size_t k_size = sizeof(values[0]);
      stream.resize(meshopt_encodeVertexBufferBound(values.size(), k_size));
      stream.resize(meshopt_encodeVertexBuffer(bytes(stream), stream.size(), values.data(), values.size(), k_size));
    };
    encode_vertices(packed, out.vertex_stream);
    if (needs_uv1_) encode_vertices(packed_uv1(out), out.uv1_stream);
    const auto encode_indices = [&](const std::vector<unsigned int>& indices, std::vector<std::byte>& stream) {
      stream.resize(meshopt_encodeIndexBufferBound(indices.size(), packed.size()));
      stream.resize(meshopt_encodeIndexBuffer(bytes(stream), stream.size(), indices.data(), indices.size()));
    };
    encode_indices(indices_, out.index_stream);
    encode_indices(coarse_, out.coarse_stream);
  }

  const TriangleMesh& mesh_;
  const CornerAttribute<Vec2>& uv_;
  bool needs_uv1_;
  const DistortionReport& report_;
  std::vector<Corner> vertices_;
  std::vector<Around> around_;
  std::vector<unsigned int> indices_, coarse_, order_;
};

}  // namespace

std::vector<PageMesh> page_meshes(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                                  const std::vector<bool>& needs_uv1, const DistortionReport& report, double keep) {
  std::map<std::uint32_t, std::vector<std::size_t>> by_slot;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    by_slot[mesh.material.empty() ? 0 : mesh.material[t]].push_back(t);
  std::vector<PageMesh> meshes;
  for (const auto& [slot, triangles] : by_slot)
    meshes.push_back(
        Builder(mesh, uv, slot < needs_uv1.size() && needs_uv1[slot], report).build(slot, triangles, keep));
  return meshes;
}

}  // namespace papilla::app
