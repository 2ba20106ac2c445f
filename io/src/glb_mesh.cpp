// SPDX-License-Identifier: MIT
#include "glb_mesh.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/vertex_normals.hpp"
#include "tangents.hpp"

namespace papilla {
namespace {

using Json = GlbBuffer::Json;

/// Which attributes a primitive has beside position and normal.
struct Layout {
  int tex_coords = 0;
  bool colors = false, tangents = false;
  int tangent_tex_coord = 0;
};

/// A vertex with everything that must agree for corners to share it. Texture coordinates are glTF's, v down.
struct Vertex {
  std::array<float, 3> position{}, normal{};
  std::array<float, 2> uv0{}, uv1{};
  std::array<std::uint16_t, 4> color{};
  float handedness = 0;  ///< 0 without tangents.
  friend bool operator==(const Vertex&, const Vertex&) = default;
};

struct VertexHash {
  std::size_t operator()(const Vertex& v) const noexcept {
    std::size_t hash = 0;
    const auto add = [&](auto value) {
      hash = (hash ^ std::bit_cast<std::conditional_t<sizeof value == 4, std::uint32_t, std::uint16_t>>(value)) *
             0x9e3779b97f4a7c15U;
      hash ^= hash >> 29;
    };
    for (const float x : v.position) add(x);
    for (const float x : v.normal) add(x);
    for (const float x : v.uv0) add(x);
    for (const float x : v.uv1) add(x);
    for (const std::uint16_t x : v.color) add(x);
    add(v.handedness);
    return hash;
  }
};

struct Primitive {
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
};

[[noreturn]] void fail(const Part& part, const std::string& reason) {
  throw InvalidInput(fmt::format("write_glb: part '{}': {}", part.name, reason));
}

/// 0 instead of −0, so that equal numbers are equal bytes.
float to_float(double value) { return static_cast<float>(value) + 0.0F; }

template <std::size_t N>
bool all_finite(const std::array<float, N>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

std::array<float, 3> position_of(const Part& part, Index vertex) {
  const Vec3 p = k_metres_per_mm * part.mesh.positions[vertex];
  const std::array<float, 3> position = {to_float(p.x), to_float(p.y), to_float(p.z)};
  if (!all_finite(position)) fail(part, fmt::format("position {} is not finite", vertex));
  return position;
}

std::array<float, 3> unit_floats(Vec3 normal, Vec3 fallback) {
  Vec3 n = normalized(normal);
  if (!is_finite(n) || n == Vec3{}) n = fallback;
  return {to_float(n.x), to_float(n.y), to_float(n.z)};
}

template <class T>
const T& value_at(const Part& part, const CornerAttribute<T>& attribute, std::size_t t, std::size_t k,
                  const char* name) {
  if (attribute.indices.size() != part.mesh.triangles.size())
    fail(part,
         fmt::format("{} has {} entries for {} triangles", name, attribute.indices.size(), part.mesh.triangles.size()));
  const Index index = attribute.indices[t][k];
  if (index >= attribute.values.size())
    fail(part, fmt::format("triangle {} names {} {} of {}", t, name, index, attribute.values.size()));
  return attribute.values[index];
}

std::array<float, 2> uv_at(const Part& part, const CornerAttribute<Vec2>& attribute, std::size_t t, std::size_t k) {
  if (!attribute.has_value(t)) return {0, 0};
  const Vec2 uv = value_at(part, attribute, t, k, "texture coordinate");
  const std::array<float, 2> result = {to_float(uv.x), to_float(1 - uv.y)};
  if (!all_finite(result)) fail(part, fmt::format("a texture coordinate of triangle {} is not finite", t));
  return result;
}

std::array<std::uint16_t, 4> color_at(const Part& part, std::size_t t, std::size_t k) {
  const Color c = part.mesh.colors.has_value(t) ? value_at(part, part.mesh.colors, t, k, "colour") : Color{};
  const auto quantised = [](float x) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(double{x}, 0.0, 1.0) * 65535));
  };
  return {quantised(c.r), quantised(c.g), quantised(c.b), quantised(c.a)};
}

Vec2 uv_up(const std::array<float, 2>& uv) { return {double{uv[0]}, 1 - double{uv[1]}}; }

/// The handedness of a triangle whose corners' texture coordinates are known.
float handedness_of(const std::array<Vertex, 3>& corners, int tex_coord) {
  std::array<Vec2, 3> uv;
  for (std::size_t k = 0; k < 3; ++k) uv[k] = uv_up(tex_coord == 0 ? corners[k].uv0 : corners[k].uv1);
  return tangent_handedness(uv);
}

/// A primitive carries an attribute only when one of its triangles has it.
template <class T>
bool any_value(const CornerAttribute<T>& attribute, const std::vector<std::size_t>& triangles) {
  return std::any_of(triangles.begin(), triangles.end(), [&](std::size_t t) { return attribute.has_value(t); });
}

Primitive collect(const Part& part, const std::vector<std::size_t>& triangles, const CornerAttribute<Vec3>& normals,
                  const Layout& layout) {
  const TriangleMesh& mesh = part.mesh;
  Primitive primitive;
  std::unordered_map<Vertex, Index, VertexHash> known;
  known.reserve(triangles.size());
  for (const std::size_t t : triangles) {
    const Vec3 flat = normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    std::array<Vertex, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k].position = position_of(part, mesh.triangles[t][k]);
      const Vec3 normal = normals.has_value(t) ? value_at(part, normals, t, k, "normal") : flat;
      corners[k].normal = unit_floats(normal, flat == Vec3{} ? Vec3{0, 0, 1} : flat);
      if (layout.tex_coords > 0) corners[k].uv0 = uv_at(part, mesh.uv, t, k);
      if (layout.tex_coords > 1) corners[k].uv1 = uv_at(part, mesh.uv1, t, k);
      if (layout.colors) corners[k].color = color_at(part, t, k);
    }
    Triangle indices{};
    const float handedness = layout.tangents ? handedness_of(corners, layout.tangent_tex_coord) : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k].handedness = handedness;
      const auto [entry, is_new] = known.try_emplace(corners[k], static_cast<Index>(primitive.vertices.size()));
      if (is_new) primitive.vertices.push_back(corners[k]);
      indices[k] = entry->second;
    }
    primitive.triangles.push_back(indices);
  }
  return primitive;
}

template <class T, std::size_t N>
std::size_t add_attribute(const std::vector<std::array<T, N>>& values, Json accessor, GlbBuffer& buffer) {
  const std::size_t view = buffer.add_view(std::as_bytes(std::span(values)), GlbBuffer::Target::vertices);
  Json full = {
      {"componentType", sizeof(T) == 4 ? 5126 : 5123}, {"count", values.size()}, {"type", "VEC" + std::to_string(N)}};
  full.update(accessor);
  return buffer.add_accessor(view, std::move(full));
}

template <class Member>
auto column(const std::vector<Vertex>& vertices, Member member) {
  std::vector<std::remove_cvref_t<decltype(vertices[0].*member)>> values;
  values.reserve(vertices.size());
  for (const Vertex& vertex : vertices) values.push_back(vertex.*member);
  return values;
}

Json bounds(const std::vector<std::array<float, 3>>& positions) {
  std::array<float, 3> low = positions.front(), high = low;
  for (const auto& p : positions)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  const auto exact = [](const std::array<float, 3>& p) {
    return Json::array({double{p[0]}, double{p[1]}, double{p[2]}});
  };
  return {{"min", exact(low)}, {"max", exact(high)}};
}

std::vector<std::array<float, 4>> tangents_of(const Primitive& primitive, int tex_coord) {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uv;
  const auto widened = [](const std::array<float, 3>& p) { return Vec3{double{p[0]}, double{p[1]}, double{p[2]}}; };
  for (const Vertex& vertex : primitive.vertices) {
    positions.push_back(widened(vertex.position));
    normals.push_back(widened(vertex.normal));
    uv.push_back(uv_up(tex_coord == 0 ? vertex.uv0 : vertex.uv1));
  }
  return vertex_tangents(positions, normals, uv, primitive.triangles);
}

std::size_t add_indices(const Primitive& primitive, GlbBuffer& buffer) {
  const Json accessor = {{"count", 3 * primitive.triangles.size()}, {"type", "SCALAR"}};
  // The largest number of each width is the primitive restart value.
  if (primitive.vertices.size() > std::numeric_limits<std::uint16_t>::max()) {
    const std::size_t view = buffer.add_view(std::as_bytes(std::span(primitive.triangles)), GlbBuffer::Target::indices);
    Json full = {{"componentType", 5125}};
    full.update(accessor);
    return buffer.add_accessor(view, std::move(full));
  }
  std::vector<std::uint16_t> narrow;
  narrow.reserve(3 * primitive.triangles.size());
  for (const Triangle& triangle : primitive.triangles)
    for (const Index index : triangle) narrow.push_back(static_cast<std::uint16_t>(index));
  const std::size_t view = buffer.add_view(std::as_bytes(std::span(narrow)), GlbBuffer::Target::indices);
  Json full = {{"componentType", 5123}};
  full.update(accessor);
  return buffer.add_accessor(view, std::move(full));
}

Json write_primitive(const Primitive& primitive, const Layout& layout, GlbBuffer& buffer) {
  Json attributes = Json::object();
  const auto& vertices = primitive.vertices;
  const auto positions = column(vertices, &Vertex::position);
  attributes["POSITION"] = add_attribute(positions, bounds(positions), buffer);
  attributes["NORMAL"] = add_attribute(column(vertices, &Vertex::normal), Json::object(), buffer);
  if (layout.tangents)
    attributes["TANGENT"] = add_attribute(tangents_of(primitive, layout.tangent_tex_coord), Json::object(), buffer);
  if (layout.tex_coords > 0)
    attributes["TEXCOORD_0"] = add_attribute(column(vertices, &Vertex::uv0), Json::object(), buffer);
  if (layout.tex_coords > 1)
    attributes["TEXCOORD_1"] = add_attribute(column(vertices, &Vertex::uv1), Json::object(), buffer);
  if (layout.colors)
    attributes["COLOR_0"] = add_attribute(column(vertices, &Vertex::color), {{"normalized", true}}, buffer);
  return {{"attributes", std::move(attributes)}, {"indices", add_indices(primitive, buffer)}};
}

void check_triangles(const Part& part) {
  const TriangleMesh& mesh = part.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index vertex : mesh.triangles[t])
      if (vertex >= mesh.positions.size())
        fail(part, fmt::format("triangle {} names position {} of {}", t, vertex, mesh.positions.size()));
  if (!mesh.material.empty() && mesh.material.size() != mesh.triangles.size())
    fail(part, fmt::format("{} materials for {} triangles", mesh.material.size(), mesh.triangles.size()));
}

std::vector<std::vector<std::size_t>> triangles_by_slot(const Part& part) {
  std::vector<std::vector<std::size_t>> slots(std::max<std::size_t>(part.materials.size(), 1));
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    const std::size_t slot = part.mesh.material.empty() ? 0 : part.mesh.material[t];
    if (slot >= slots.size())
      fail(part, fmt::format("triangle {} names material slot {} of {}", t, slot, slots.size()));
    slots[slot].push_back(t);
  }
  return slots;
}

}  // namespace

Json glb_mesh(const Part& part, const std::vector<MaterialNeeds>& materials, const GlbWriteOptions& options,
              GlbBuffer& buffer) {
  if (part.mesh.triangles.empty()) return nullptr;
  check_triangles(part);
  const CornerAttribute<Vec3> made =
      part.mesh.normals.empty() ? vertex_normals(part.mesh, options.crease_deg) : CornerAttribute<Vec3>{};
  const CornerAttribute<Vec3>& normals = part.mesh.normals.empty() ? made : part.mesh.normals;
  Json mesh = Json::object();
  if (!part.name.empty()) mesh["name"] = part.name;
  const auto slots = triangles_by_slot(part);
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    if (slots[slot].empty()) continue;
    const TriangleMesh& triangles = part.mesh;
    Layout layout{any_value(triangles.uv, slots[slot]) ? 1 : 0, any_value(triangles.colors, slots[slot]), false, 0};
    if (any_value(triangles.uv1, slots[slot])) layout.tex_coords = 2;
    if (slot < part.materials.size()) {
      const std::uint32_t number = part.materials[slot];
      if (number >= materials.size()) fail(part, fmt::format("names material {} of {}", number, materials.size()));
      layout.tex_coords = std::max(layout.tex_coords, materials[number].tex_coords);
      layout.tangents = materials[number].tangents;
      layout.tangent_tex_coord = materials[number].tangent_tex_coord;
    }
    Json primitive = write_primitive(collect(part, slots[slot], normals, layout), layout, buffer);
    if (slot < part.materials.size()) primitive["material"] = part.materials[slot];
    mesh["primitives"].push_back(std::move(primitive));
  }
  if (!part.extras_json.empty())
    mesh["extras"] = parse_scene_json(part.extras_json, fmt::format("part '{}'.extras", part.name));
  return mesh;
}

}  // namespace papilla
