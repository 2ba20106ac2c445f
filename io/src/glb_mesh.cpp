// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "glb_compression.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/vertex_normals.hpp"
#include "papilla/meshing/triangle_mesh.hpp"
#include "tangents.hpp"

namespace papilla {
namespace {

/// Which attributes a primitive has beside position and normal.
struct GlbLayout {
  int tex_coords = 0;
  bool colors = false, tangents = false;
  int tangent_tex_coord = 0;
  bool cad_uv = false;
  std::optional<VertexGrid> grid;  ///< Nothing: vertices are not rounded.
};

/// A vertex with everything that must agree for corners to share it. Texture coordinates are glTF's, v down. Zeros are
/// positive, so that equal numbers are equal bits; what the layout leaves out is zero.
struct GlbVertex {
  std::array<float, 3> position{}, normal{};
  std::array<float, 2> uv0{}, uv1{}, cad_uv{};
  std::array<std::uint16_t, 4> color{};
  float handedness = 0;  ///< 0 without tangents.
};

/// The vertices of a primitive, an array per attribute as glTF wants them; equal vertices are stored once and numbered
/// in the order of first use. A hash table of 4-byte numbers with linear probing finds them.
class GlbVertices {
 public:
  GlbVertices(const GlbLayout& layout, std::size_t expected_vertices);

  /// The number of each corner's vertex. Many corners at a time are faster: their memory is fetched together.
  void add(std::span<const GlbVertex> corners, std::span<Index> numbers);

  std::size_t size() const noexcept { return positions.size(); }

  /// Frees the table; nothing may be added any more.
  void finish();

  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<float, 2>> uv0, uv1, cad_uv;
  std::vector<std::array<std::uint16_t, 4>> colors;
  std::vector<float> handedness;

 private:
  GlbVertex vertex(Index number) const;
  bool equals(Index number, const GlbVertex& vertex) const;
  Index add_at(const GlbVertex& vertex, std::size_t slot);
  void append(const GlbVertex& vertex);
  void reserve_slots(std::size_t further_vertices);

  GlbLayout layout_;
  std::vector<Index> table_;
};

constexpr Index k_free = std::numeric_limits<Index>::max();

/// Corners whose memory is fetched together; more would drive each other out of the first-level cache.
constexpr std::size_t k_batch = 48;

using Words = std::array<std::uint32_t, 15>;
static_assert(sizeof(GlbVertex) == sizeof(Words));

/// Odd numbers without pattern: the outputs of splitmix64 [Steele, Lea, Flood 2014].
constexpr std::array<std::uint64_t, 15> k_factors = [] {
  std::array<std::uint64_t, 15> factors{};
  std::uint64_t state = 0;
  for (std::uint64_t& factor : factors) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    factor = (z ^ (z >> 31)) | 1U;
  }
  return factors;
}();

std::uint64_t hash(const GlbVertex& vertex) noexcept {
  const Words words = std::bit_cast<Words>(vertex);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < words.size(); ++i) sum += words[i] * k_factors[i];
  sum = (sum ^ (sum >> 32)) * 0xbf58476d1ce4e5b9U;
  return sum ^ (sum >> 29);
}

GlbVertices::GlbVertices(const GlbLayout& layout, std::size_t expected_vertices)
    : layout_(layout), table_(std::bit_ceil(2 * expected_vertices + 16), k_free) {
  positions.reserve(expected_vertices);
  normals.reserve(expected_vertices);
  if (layout.tex_coords > 0) uv0.reserve(expected_vertices);
  if (layout.tex_coords > 1) uv1.reserve(expected_vertices);
  if (layout.cad_uv) cad_uv.reserve(expected_vertices);
  if (layout.colors) colors.reserve(expected_vertices);
  if (layout.tangents) handedness.reserve(expected_vertices);
}

GlbVertex GlbVertices::vertex(Index number) const {
  GlbVertex vertex;
  vertex.position = positions[number];
  vertex.normal = normals[number];
  if (layout_.tex_coords > 0) vertex.uv0 = uv0[number];
  if (layout_.tex_coords > 1) vertex.uv1 = uv1[number];
  if (layout_.cad_uv) vertex.cad_uv = cad_uv[number];
  if (layout_.colors) vertex.color = colors[number];
  if (layout_.tangents) vertex.handedness = handedness[number];
  return vertex;
}

bool GlbVertices::equals(Index number, const GlbVertex& v) const {
  return positions[number] == v.position && normals[number] == v.normal &&
         (layout_.tex_coords < 1 || uv0[number] == v.uv0) && (layout_.tex_coords < 2 || uv1[number] == v.uv1) &&
         (!layout_.cad_uv || cad_uv[number] == v.cad_uv) && (!layout_.colors || colors[number] == v.color) &&
         (!layout_.tangents || handedness[number] == v.handedness);
}

void GlbVertices::append(const GlbVertex& vertex) {
  positions.push_back(vertex.position);
  normals.push_back(vertex.normal);
  if (layout_.tex_coords > 0) uv0.push_back(vertex.uv0);
  if (layout_.tex_coords > 1) uv1.push_back(vertex.uv1);
  if (layout_.cad_uv) cad_uv.push_back(vertex.cad_uv);
  if (layout_.colors) colors.push_back(vertex.color);
  if (layout_.tangents) handedness.push_back(vertex.handedness);
}

Index GlbVertices::add_at(const GlbVertex& vertex, std::size_t slot) {
  const std::size_t mask = table_.size() - 1;
  while (table_[slot] != k_free) {
    if (equals(table_[slot], vertex)) return table_[slot];
    slot = (slot + 1) & mask;
  }
  table_[slot] = static_cast<Index>(positions.size());
  append(vertex);
  return table_[slot];
}

void GlbVertices::add(std::span<const GlbVertex> corners, std::span<Index> numbers) {
  std::array<std::size_t, k_batch> slots;
  for (std::size_t begin = 0; begin < corners.size(); begin += k_batch) {
    const auto batch = corners.subspan(begin, std::min(k_batch, corners.size() - begin));
    reserve_slots(batch.size());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      slots[i] = hash(batch[i]) & (table_.size() - 1);
      __builtin_prefetch(&table_[slots[i]]);
    }
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (const Index number = table_[slots[i]]; number != k_free) {
        __builtin_prefetch(&positions[number]);
        __builtin_prefetch(&normals[number]);
      }
    for (std::size_t i = 0; i < batch.size(); ++i) numbers[begin + i] = add_at(batch[i], slots[i]);
  }
}

/// Keeps the table at most half full.
void GlbVertices::reserve_slots(std::size_t further_vertices) {
  const std::size_t needed = 2 * (size() + further_vertices);
  if (needed <= table_.size()) return;
  table_.assign(std::bit_ceil(needed), k_free);
  const std::size_t mask = table_.size() - 1;
  for (Index i = 0; i < size(); ++i) {
    std::size_t slot = hash(vertex(i)) & mask;
    while (table_[slot] != k_free) slot = (slot + 1) & mask;
    table_[slot] = i;
  }
}

void GlbVertices::finish() { table_ = {}; }

using Json = GlbBuffer::Json;

struct Primitive {
  GlbVertices vertices;
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

std::array<float, 2> cad_uv_at(const Part& part, std::size_t t, std::size_t k) {
  if (!part.mesh.cad_uv.has_value(t)) return {0, 0};
  const Vec2 uv = value_at(part, part.mesh.cad_uv, t, k, "CAD (u,v)");
  const std::array<float, 2> result = {to_float(uv.x), to_float(uv.y)};
  if (!all_finite(result)) fail(part, fmt::format("a CAD (u,v) of triangle {} is not finite", t));
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
float handedness_of(std::span<const GlbVertex, 3> corners, int tex_coord) {
  std::array<Vec2, 3> uv;
  for (std::size_t k = 0; k < 3; ++k) uv[k] = uv_up(tex_coord == 0 ? corners[k].uv0 : corners[k].uv1);
  return tangent_handedness(uv);
}

/// A primitive carries an attribute only when one of its triangles has it.
template <class T>
bool any_value(const CornerAttribute<T>& attribute, std::span<const Index> triangles) {
  return std::any_of(triangles.begin(), triangles.end(), [&](Index t) { return attribute.has_value(t); });
}

/// Turns corners of triangles into vertices, a block of triangles at a time.
class Collector {
 public:
  Collector(const Part& part, const CornerAttribute<Vec3>& normals, const GlbLayout& layout)
      : part_(part), normals_(normals), layout_(layout) {}

  Primitive collect(std::span<const Index> triangles) const {
    // Closed meshes have half as many vertices as triangles.
    Primitive primitive{GlbVertices(layout_, std::min(triangles.size() / 2, part_.mesh.positions.size())), {}};
    primitive.triangles.resize(triangles.size());
    constexpr std::size_t k_block = 64;
    std::array<GlbVertex, 3 * k_block> corners;
    std::array<Index, 3 * k_block> numbers;
    for (std::size_t begin = 0; begin < triangles.size(); begin += k_block) {
      const std::size_t count = std::min(k_block, triangles.size() - begin);
      for (std::size_t i = 0; i < count; ++i) fill(triangles[begin + i], std::span(corners).subspan(3 * i).first<3>());
      primitive.vertices.add(std::span(corners).first(3 * count), numbers);
      for (std::size_t i = 0; i < count; ++i)
        primitive.triangles[begin + i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    }
    primitive.vertices.finish();
    if (layout_.grid) drop_collapsed(primitive);
    return primitive;
  }

 private:
  /// Leaves out triangles of which rounding makes a line or a point.
  static void drop_collapsed(Primitive& primitive) {
    const auto& at = primitive.vertices.positions;
    std::erase_if(primitive.triangles, [&](const Triangle& t) {
      return at[t[0]] == at[t[1]] || at[t[1]] == at[t[2]] || at[t[2]] == at[t[0]];
    });
  }

  static void round(const VertexGrid& grid, GlbVertex& vertex) {
    for (float& x : vertex.position) x = to_grid(x, grid.position);
    for (float& x : vertex.uv0) x = to_grid(x, grid.uv[0]);
    for (float& x : vertex.uv1) x = to_grid(x, grid.uv[1]);
    for (float& x : vertex.cad_uv) x = to_grid(x, grid.cad_uv);
    vertex.normal = to_octahedron(vertex.normal);
  }

  void fill(std::size_t t, std::span<GlbVertex, 3> corners) const {
    const TriangleMesh& mesh = part_.mesh;
    for (std::size_t k = 0; k < 3; ++k) {
      GlbVertex& corner = corners[k];
      corner.position = position_of(part_, mesh.triangles[t][k]);
      corner.normal = normal_of(t, k);
      if (layout_.tex_coords > 0) corner.uv0 = uv_at(part_, mesh.uv, t, k);
      if (layout_.tex_coords > 1) corner.uv1 = uv_at(part_, mesh.uv1, t, k);
      if (layout_.cad_uv) corner.cad_uv = cad_uv_at(part_, t, k);
      if (layout_.colors) corner.color = color_at(part_, t, k);
      if (layout_.grid) round(*layout_.grid, corner);
    }
    const float handedness = layout_.tangents ? handedness_of(corners, layout_.tangent_tex_coord) : 0;
    for (GlbVertex& corner : corners) corner.handedness = handedness;
  }

  /// The corner's own normal, or else the triangle's.
  std::array<float, 3> normal_of(std::size_t t, std::size_t k) const {
    Vec3 n = normals_.has_value(t) ? normalized(value_at(part_, normals_, t, k, "normal")) : Vec3{};
    if (!is_finite(n) || n == Vec3{}) {
      const TriangleMesh& mesh = part_.mesh;
      n = normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
      if (!is_finite(n) || n == Vec3{}) n = {0, 0, 1};
    }
    return {to_float(n.x), to_float(n.y), to_float(n.z)};
  }

  const Part& part_;
  const CornerAttribute<Vec3>& normals_;
  GlbLayout layout_;
};

template <class T, std::size_t N>
std::size_t add_attribute(std::vector<std::array<T, N>>&& values, Json accessor, GlbBuffer& buffer) {
  Json full = {
      {"componentType", sizeof(T) == 4 ? 5126 : 5123}, {"count", values.size()}, {"type", "VEC" + std::to_string(N)}};
  full.update(accessor);
  return buffer.add_accessor(buffer.add_view(std::move(values), GlbBuffer::Target::vertices), std::move(full));
}

std::vector<std::array<float, 4>> tangents_of(const Primitive& primitive, int tex_coord) {
  const GlbVertices& vertices = primitive.vertices;
  const auto widened = [](const std::vector<std::array<float, 3>>& values) {
    std::vector<Vec3> result;
    result.reserve(values.size());
    for (const auto& v : values) result.push_back({double{v[0]}, double{v[1]}, double{v[2]}});
    return result;
  };
  std::vector<Vec2> uv;
  uv.reserve(vertices.size());
  for (const auto& value : tex_coord == 0 ? vertices.uv0 : vertices.uv1) uv.push_back(uv_up(value));
  return vertex_tangents(widened(vertices.positions), widened(vertices.normals), uv, primitive.triangles);
}

std::size_t add_indices(Primitive& primitive, GlbBuffer& buffer) {
  Json accessor = {{"componentType", 5125}, {"count", 3 * primitive.triangles.size()}, {"type", "SCALAR"}};
  // The largest number of each width is the primitive restart value.
  if (primitive.vertices.size() > std::numeric_limits<std::uint16_t>::max())
    return buffer.add_accessor(buffer.add_view(std::move(primitive.triangles), GlbBuffer::Target::indices),
                               std::move(accessor));
  std::vector<std::uint16_t> narrow;
  narrow.reserve(3 * primitive.triangles.size());
  for (const Triangle& triangle : primitive.triangles)
    for (const Index index : triangle) narrow.push_back(static_cast<std::uint16_t>(index));
  accessor["componentType"] = 5123;
  return buffer.add_accessor(buffer.add_view(std::move(narrow), GlbBuffer::Target::indices), std::move(accessor));
}

/// What a primitive takes without compression.
std::size_t plain_bytes(const Primitive& primitive, const GlbLayout& layout) {
  const std::size_t count = primitive.vertices.size();
  const std::size_t vertex =
      sizeof(float) * (6 + (layout.tangents ? 4 : 0) +
                       2 * (static_cast<std::size_t>(layout.tex_coords) + (layout.cad_uv ? 1 : 0))) +
      (layout.colors ? sizeof(std::array<std::uint16_t, 4>) : 0);
  const std::size_t index = count > std::numeric_limits<std::uint16_t>::max() ? 4 : 2;
  return count * vertex + 3 * primitive.triangles.size() * index;
}

Json write_plain(Primitive primitive, std::vector<std::array<float, 4>> tangents, const GlbLayout& layout,
                 GlbBuffer& buffer) {
  Json attributes = Json::object();
  GlbVertices& vertices = primitive.vertices;
  const std::size_t indices = add_indices(primitive, buffer);
  const Json box = bounds_json(vertices.positions);
  attributes["POSITION"] = add_attribute(std::move(vertices.positions), box, buffer);
  attributes["NORMAL"] = add_attribute(std::move(vertices.normals), Json::object(), buffer);
  if (layout.tangents) attributes["TANGENT"] = add_attribute(std::move(tangents), Json::object(), buffer);
  if (layout.tex_coords > 0) attributes["TEXCOORD_0"] = add_attribute(std::move(vertices.uv0), Json::object(), buffer);
  if (layout.tex_coords > 1) attributes["TEXCOORD_1"] = add_attribute(std::move(vertices.uv1), Json::object(), buffer);
  if (layout.cad_uv) attributes["_CAD_UV"] = add_attribute(std::move(vertices.cad_uv), Json::object(), buffer);
  if (layout.colors) attributes["COLOR_0"] = add_attribute(std::move(vertices.colors), {{"normalized", true}}, buffer);
  return {{"attributes", std::move(attributes)}, {"indices", indices}};
}

Json write_primitive(Primitive primitive, std::vector<std::array<float, 4>> tangents, const GlbLayout& layout,
                     MeshCoding coding, GlbBuffer& buffer) {
  GlbVertices& vertices = primitive.vertices;
  const std::size_t plain = plain_bytes(primitive, layout);
  buffer.count_mesh(layout.grid ? 0 : plain, plain);
  if (!layout.grid) return write_plain(std::move(primitive), std::move(tangents), layout, buffer);
  for (auto& tangent : tangents) {
    const std::array<float, 3> direction = to_octahedron({tangent[0], tangent[1], tangent[2]});
    std::copy(direction.begin(), direction.end(), tangent.begin());
  }
  GlbArrays arrays{std::move(vertices.positions), std::move(vertices.normals), std::move(tangents), {}, {}, {}, {}, {}};
  if (layout.tex_coords > 0) arrays.uv0 = std::move(vertices.uv0);
  if (layout.tex_coords > 1) arrays.uv1 = std::move(vertices.uv1);
  if (layout.cad_uv) arrays.cad_uv = std::move(vertices.cad_uv);
  if (layout.colors) arrays.colors = std::move(vertices.colors);
  arrays.triangles = std::move(primitive.triangles);
  return write_compressed(std::move(arrays), *layout.grid, coding, buffer);
}

/// Along the longest side of a part: such errors are asked for, and such are always enough, with 16 bits for
/// MeshCoding::quantize: a step is at least 1/√3 of the error.
constexpr double k_steps = 16384, k_enough_steps = 32768;
constexpr double k_most_rounding_mm = 0.02;
constexpr double k_cad_uv_share = 1.0 / 65536;
constexpr double k_texel_share = 0.1;            ///< Of the finest texel: farthest that rounding moves a picture.
constexpr double k_unseen_texels_per_uv = 4096;  ///< Where no picture lies on texture coordinates.

/// Positions, and CAD (u,v), are rounded alike in a whole part.
VertexGrid grid_of_part(const Part& part, const GlbWriteOptions& options) {
  VertexGrid grid;
  Bounds3 box;
  for (const Vec3& p : part.mesh.positions)
    if (is_finite(p)) box.add(k_metres_per_mm * p);
  const Vec3 size = box.size(), far = upper(box.high, -box.low);
  const double side = std::max({size.x, size.y, size.z}), largest = std::max({far.x, far.y, far.z, 0.0});
  const double most = options.most_rounding_mm > 0
                          ? k_metres_per_mm * options.most_rounding_mm
                          : std::clamp(k_metres_per_mm * k_most_rounding_mm, side / k_enough_steps, side / k_steps);
  grid.position = grid_exponent(most, 3, largest);
  if (options.meshes == MeshCoding::quantize) {
    std::array<std::int64_t, 3> origin{};
    const std::array<double, 3> low = {box.low.x, box.low.y, box.low.z}, high = {box.high.x, box.high.y, box.high.z};
    bool fits = !box.is_empty();
    for (std::size_t k = 0; fits && k < 3; ++k) {
      origin[k] = std::llround(std::floor(std::ldexp(low[k], -grid.position)));
      fits = std::ldexp(high[k], -grid.position) - static_cast<double>(origin[k]) <
             std::numeric_limits<std::uint16_t>::max();
    }
    if (fits) grid.origin = origin;
  }
  Bounds2 cad;
  for (const Vec2& uv : part.mesh.cad_uv.values)
    if (std::isfinite(uv.x) && std::isfinite(uv.y)) cad.add(uv);
  const Vec2 span = cad.size(), most_cad = upper(cad.high, Vec2{} - cad.low);
  grid.cad_uv = grid_exponent(k_cad_uv_share * std::max(span.x, span.y), 1, std::max({most_cad.x, most_cad.y, 0.0}));
  return grid;
}

/// By the pictures that lie on them.
int uv_exponent(const CornerAttribute<Vec2>& uv, std::span<const Index> triangles, double texels_per_uv) {
  double largest = 1;
  for (const Index t : triangles) {
    if (!uv.has_value(t)) continue;
    for (const Index i : uv.indices[t])
      if (i < uv.values.size()) largest = std::max({largest, std::abs(uv.values[i].x), std::abs(1 - uv.values[i].y)});
  }
  return grid_exponent(k_texel_share / (texels_per_uv > 0 ? texels_per_uv : k_unseen_texels_per_uv), 2, largest);
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

std::vector<std::vector<Index>> triangles_by_slot(const Part& part) {
  std::vector<std::vector<Index>> slots(std::max<std::size_t>(part.materials.size(), 1));
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    const std::size_t slot = part.mesh.material.empty() ? 0 : part.mesh.material[t];
    if (slot >= slots.size())
      fail(part, fmt::format("triangle {} names material slot {} of {}", t, slot, slots.size()));
    slots[slot].push_back(static_cast<Index>(t));
  }
  return slots;
}

/// A primitive of a slot, and its tangents where its material asks for them.
struct SlotPrimitive {
  std::size_t slot;
  GlbLayout layout;
  Primitive primitive;
  std::vector<std::array<float, 4>> tangents;
};

/// Which attributes the primitive of a slot has. @param grid of the part.
GlbLayout layout_of(const Part& part, std::size_t slot, std::span<const Index> triangles,
                    const std::vector<MaterialNeeds>& materials, const GlbWriteOptions& options,
                    const std::optional<VertexGrid>& grid) {
  const TriangleMesh& mesh = part.mesh;
  GlbLayout layout{any_value(mesh.uv, triangles) ? 1 : 0,
                   any_value(mesh.colors, triangles),
                   false,
                   0,
                   options.cad_uv && any_value(mesh.cad_uv, triangles),
                   grid};
  if (any_value(mesh.uv1, triangles)) layout.tex_coords = 2;
  MaterialNeeds needs;
  if (slot < part.materials.size()) {
    const std::uint32_t number = part.materials[slot];
    if (number >= materials.size()) fail(part, fmt::format("names material {} of {}", number, materials.size()));
    needs = materials[number];
    layout.tex_coords = std::max(layout.tex_coords, needs.tex_coords);
    layout.tangents = needs.tangents;
    layout.tangent_tex_coord = needs.tangent_tex_coord;
  }
  if (grid)
    layout.grid->uv = {uv_exponent(mesh.uv, triangles, needs.texels_per_uv[0]),
                       uv_exponent(mesh.uv1, triangles, needs.texels_per_uv[1])};
  return layout;
}

}  // namespace

struct GlbPrimitives {
  std::optional<VertexGrid> grid;
  std::vector<SlotPrimitive> slots;
};

std::shared_ptr<GlbPrimitives> glb_primitives(const Part& part, const std::vector<MaterialNeeds>& materials,
                                              const GlbWriteOptions& options) {
  auto result = std::make_shared<GlbPrimitives>();
  if (part.mesh.triangles.empty()) return result;
  check_triangles(part);
  const CornerAttribute<Vec3> made =
      part.mesh.normals.empty() ? vertex_normals(part.mesh, options.crease_deg) : CornerAttribute<Vec3>{};
  const CornerAttribute<Vec3>& normals = part.mesh.normals.empty() ? made : part.mesh.normals;
  if (options.meshes != MeshCoding::none) result->grid = grid_of_part(part, options);
  const auto slots = triangles_by_slot(part);
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    if (slots[slot].empty()) continue;
    const GlbLayout layout = layout_of(part, slot, slots[slot], materials, options, result->grid);
    Primitive primitive = Collector(part, normals, layout).collect(slots[slot]);
    if (primitive.triangles.empty()) continue;
    std::vector<std::array<float, 4>> tangents;
    if (layout.tangents) tangents = tangents_of(primitive, layout.tangent_tex_coord);
    result->slots.push_back({slot, layout, std::move(primitive), std::move(tangents)});
  }
  return result;
}

GlbMesh glb_mesh(const Part& part, std::shared_ptr<GlbPrimitives> primitives, MeshCoding coding, GlbBuffer& buffer) {
  GlbMesh result;
  if (primitives->slots.empty()) return result;
  Json mesh = Json::object();
  if (!part.name.empty()) mesh["name"] = part.name;
  for (auto& [slot, layout, content, tangents] : primitives->slots) {
    Json primitive = write_primitive(std::move(content), std::move(tangents), layout, coding, buffer);
    if (slot < part.materials.size()) primitive["material"] = part.materials[slot];
    mesh["primitives"].push_back(std::move(primitive));
  }
  if (!part.extras_json.empty())
    mesh["extras"] = parse_scene_json(part.extras_json, fmt::format("part '{}'.extras", part.name));
  result.json = std::move(mesh);
  if (const auto& grid = primitives->grid; grid && grid->origin) {
    const double step = std::ldexp(1.0, grid->position);
    const auto& [x, y, z] = *grid->origin;
    result.positions = {
        step, (step / k_metres_per_mm) * Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}};
  }
  return result;
}

}  // namespace papilla
