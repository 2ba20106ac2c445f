// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "glb_compression.hpp"
#include "papilla/core/error.hpp"

#ifdef PAPILLA_HAVE_DRACO
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#endif

namespace papilla {
#ifdef PAPILLA_HAVE_DRACO
namespace {

using Json = GlbBuffer::Json;
using Type = draco::GeometryAttribute::Type;

constexpr int k_direction_bits = 8;  // Of octahedral coordinates: the directions of to_octahedron().
/// Tangents, which Draco has no type for, as multiples of 2^−7, so that the handedness stays 1 or −1.
constexpr int k_tangent_exponent = -7;

/// A mesh of Draco with the attributes of a primitive, and how their values are rounded: not at all, as they are.
class DracoPrimitive {
 public:
  explicit DracoPrimitive(const GlbArrays& arrays) : points_(static_cast<std::uint32_t>(arrays.positions.size())) {
    mesh_.set_num_points(points_);
    mesh_.SetNumFaces(arrays.triangles.size());
    for (std::uint32_t t = 0; t < arrays.triangles.size(); ++t) {
      draco::Mesh::Face face;
      for (std::size_t k = 0; k < 3; ++k) face[k] = arrays.triangles[t][k];
      mesh_.SetFace(draco::FaceIndex(t), face);
    }
  }

  /// @param unused  values that no vertex has.
  /// @returns the id of the attribute in the stream.
  template <class T, std::size_t N>
  int add(Type type, const std::vector<std::array<T, N>>& values, const std::vector<std::array<T, N>>& unused = {}) {
    constexpr bool k_is_float = std::is_same_v<T, float>;
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, N, k_is_float ? draco::DT_FLOAT32 : draco::DT_UINT16, !k_is_float, sizeof(T) * N, 0);
    const int id = mesh_.AddAttribute(attribute, false, points_ + static_cast<std::uint32_t>(unused.size()));
    draco::PointAttribute& added = *mesh_.attribute(id);
    for (std::uint32_t i = 0; i < points_; ++i) {
      added.SetPointMapEntry(draco::PointIndex(i), draco::AttributeValueIndex(i));
      added.SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
    }
    for (std::uint32_t i = 0; i < unused.size(); ++i)
      added.SetAttributeValue(draco::AttributeValueIndex(points_ + i), unused[i].data());
    return id;
  }

  /// Values that are multiples of 2^exponent, which Draco then keeps exactly. Its steps are the values' range over
  /// 2^bits − 1: an unused value makes them 2^exponent. (The range that its options can hold has six decimals.)
  template <std::size_t N>
  int add_on_grid(Type type, const std::vector<std::array<float, N>>& values, int exponent) {
    std::array<float, N> low = values.front(), high = low;
    for (const auto& value : values)
      for (std::size_t k = 0; k < N; ++k) {
        low[k] = std::min(low[k], value[k]);
        high[k] = std::max(high[k], value[k]);
      }
    double steps = 1;
    for (std::size_t k = 0; k < N; ++k)
      steps = std::max(steps, std::ldexp(double{high[k]} - double{low[k]}, -exponent));
    const int bits = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(steps)));
    std::array<float, N> last = low;
    last[0] = static_cast<float>(double{low[0]} + std::ldexp(std::ldexp(1.0, bits) - 1, exponent));
    const int id = add(type, values, {last});
    bits_.emplace_back(id, bits);
    return id;
  }

  int add_directions(Type type, const std::vector<std::array<float, 3>>& values) {
    const int id = add(type, values);
    bits_.emplace_back(id, k_direction_bits);
    return id;
  }

  /// @param points, triangles  get the numbers of the decoded mesh.
  std::vector<unsigned char> encode(std::size_t& points, std::size_t& triangles) {
    // Edgebreaker takes the connectivity from positions that several points share.
    if (!mesh_.DeduplicateAttributeValues()) throw InvalidInput("write_glb: libdraco can't encode a mesh");
    draco::ExpertEncoder encoder(mesh_);
    encoder.SetTrackEncodedProperties(true);
    encoder.SetSpeedOptions(k_speed, k_speed);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    for (const auto& [attribute, bits] : bits_) encoder.SetAttributeQuantization(attribute, bits);
    draco::EncoderBuffer stream;
    if (const draco::Status status = encoder.EncodeToBuffer(&stream); !status.ok())
      throw InvalidInput("write_glb: libdraco: " + status.error_msg_string());
    points = encoder.num_encoded_points();
    triangles = encoder.num_encoded_faces();
    return {stream.data(), stream.data() + stream.size()};
  }

 private:
  static constexpr int k_speed = 0;  // The smallest streams.

  std::uint32_t points_;
  draco::Mesh mesh_;
  std::vector<std::pair<int, int>> bits_;  ///< Attributes whose values are rounded, and to what.
};

}  // namespace

bool has_draco_encoder() noexcept { return true; }

Json write_draco(const GlbArrays& arrays, const VertexGrid& grid, GlbBuffer& buffer) {
  DracoPrimitive primitive(arrays);
  Json ids = Json::object(), attributes = Json::object();
  struct Described {
    const char* name;
    Json accessor;
  };
  std::vector<Described> described;
  const auto describe = [&](const char* name, int id, int component, const char* type, Json further) {
    ids[name] = id;
    Json accessor = {{"componentType", component}, {"count", 0}, {"type", type}};
    accessor.update(further);
    described.push_back({name, std::move(accessor)});
  };
  constexpr int k_float = 5126, k_unsigned_short = 5123, k_unsigned_int = 5125;
  describe("POSITION", primitive.add_on_grid(Type::POSITION, arrays.positions, grid.position), k_float, "VEC3",
           bounds_json(arrays.positions));
  describe("NORMAL", primitive.add_directions(Type::NORMAL, arrays.normals), k_float, "VEC3", Json::object());
  if (!arrays.tangents.empty()) {
    std::vector<std::array<float, 4>> tangents = arrays.tangents;
    for (auto& tangent : tangents)
      for (float& x : tangent) x = to_grid(x, k_tangent_exponent);
    describe("TANGENT", primitive.add_on_grid(Type::GENERIC, tangents, k_tangent_exponent), k_float, "VEC4",
             Json::object());
  }
  if (!arrays.uv0.empty())
    describe("TEXCOORD_0", primitive.add_on_grid(Type::TEX_COORD, arrays.uv0, grid.uv[0]), k_float, "VEC2",
             Json::object());
  if (!arrays.uv1.empty())
    describe("TEXCOORD_1", primitive.add_on_grid(Type::TEX_COORD, arrays.uv1, grid.uv[1]), k_float, "VEC2",
             Json::object());
  if (!arrays.cad_uv.empty())
    describe("_CAD_UV", primitive.add_on_grid(Type::GENERIC, arrays.cad_uv, grid.cad_uv), k_float, "VEC2",
             Json::object());
  if (!arrays.colors.empty())
    describe("COLOR_0", primitive.add(Type::COLOR, arrays.colors), k_unsigned_short, "VEC4", {{"normalized", true}});
  std::size_t points = 0, triangles = 0;
  std::vector<unsigned char> stream = primitive.encode(points, triangles);
  for (Described& one : described) {
    one.accessor["count"] = points;
    attributes[one.name] = buffer.add_accessor(std::move(one.accessor));
  }
  const std::size_t indices =
      buffer.add_accessor({{"componentType", points > 0xffff ? k_unsigned_int : k_unsigned_short},
                           {"count", 3 * triangles},
                           {"type", "SCALAR"}});
  buffer.count_mesh(stream.size(), 0);
  const std::size_t view = buffer.add_view(std::move(stream), GlbBuffer::Target::none);
  Json json = {{"attributes", std::move(attributes)}, {"indices", indices}};
  json["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view}, {"attributes", std::move(ids)}};
  return json;
}

#else

bool has_draco_encoder() noexcept { return false; }

GlbBuffer::Json write_draco(const GlbArrays&, const VertexGrid&, GlbBuffer&) {
  throw InvalidInput("write_glb: this build was made without libdraco");
}

#endif

}  // namespace papilla
