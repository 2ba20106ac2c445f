// SPDX-License-Identifier: MIT
#include "glb_compression.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"

#ifdef PAPILLA_HAVE_MESHOPT
#include <meshoptimizer.h>
#endif

namespace papilla {
namespace {

using Json = GlbBuffer::Json;

constexpr int k_float = 5126, k_unsigned_int = 5125, k_unsigned_short = 5123, k_byte = 5120;

}  // namespace

int grid_exponent(double most, int dimensions, double largest) {
  // 24 bits with sign, of which rounding up may take one more; what floats hold with full precision.
  constexpr int k_mantissa = 22, k_least = -100;
  int exponent = k_least;
  if (most > 0) exponent = std::max(exponent, std::ilogb(2 * most / std::sqrt(dimensions)));
  if (largest > 0) exponent = std::max(exponent, std::ilogb(largest) + 1 - k_mantissa);
  return exponent;
}

float to_grid(float value, int exponent) {
  return static_cast<float>(std::ldexp(std::nearbyint(std::ldexp(double{value}, -exponent)), exponent)) + 0.0F;
}

std::array<float, 3> to_octahedron(const std::array<float, 3>& direction) {
  constexpr int k_radius = 127;
  std::array<double, 3> wanted{};
  const double length =
      std::abs(double{direction[0]}) + std::abs(double{direction[1]}) + std::abs(double{direction[2]});
  std::array<int, 3> point{};
  int missing = k_radius;
  for (std::size_t k = 0; k < 3; ++k) {
    wanted[k] = k_radius * std::abs(double{direction[k]}) / length;
    point[k] = static_cast<int>(std::lround(wanted[k]));
    missing -= point[k];
  }
  // The coordinate that was rounded farthest the other way takes what is missing: the lattice's closest point.
  while (missing != 0) {
    const int step = missing > 0 ? 1 : -1;
    std::size_t farthest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (step * (wanted[k] - point[k]) > step * (wanted[farthest] - point[farthest])) farthest = k;
    point[farthest] += step;
    missing -= step;
  }
  const double norm = std::sqrt(point[0] * point[0] + point[1] * point[1] + point[2] * point[2]);
  std::array<float, 3> result{};
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = static_cast<float>(std::copysign(point[k] / norm, double{direction[k]})) + 0.0F;
  return result;
}

Json bounds_json(std::span<const std::array<float, 3>> positions) {
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

#ifdef PAPILLA_HAVE_MESHOPT
namespace {

constexpr unsigned k_unused = ~0U;  ///< Of vertices whose triangles rounding has collapsed.

template <class T>
void remap(std::vector<T>& values, const std::vector<unsigned>& to, std::size_t used) {
  if (values.empty()) return;
  std::vector<T> moved(used);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (to[i] != k_unused) moved[to[i]] = values[i];
  values = std::move(moved);
}

/// Triangles next to those that share vertices with them, and vertices in the order of first use, so that both differ
/// little from those before them.
void reorder(GlbArrays& arrays) {
  const std::size_t corners = 3 * arrays.triangles.size(), count = arrays.positions.size();
  auto* indices = arrays.triangles.front().data();
  meshopt_optimizeVertexCacheStrip(indices, indices, corners, count);
  std::vector<unsigned> to(count);
  const std::size_t used = meshopt_optimizeVertexFetchRemap(to.data(), indices, corners, count);
  for (Triangle& triangle : arrays.triangles)
    for (Index& corner : triangle) corner = to[corner];
  remap(arrays.positions, to, used), remap(arrays.normals, to, used), remap(arrays.tangents, to, used);
  remap(arrays.uv0, to, used), remap(arrays.uv1, to, used), remap(arrays.cad_uv, to, used),
      remap(arrays.colors, to, used);
}

/// Writes attribute by attribute, with streams of meshopt or as they are.
class CompressedWriter {
 public:
  CompressedWriter(const GlbArrays& arrays, const VertexGrid& grid, bool streams, GlbBuffer& buffer)
      : arrays_(arrays), grid_(grid), streams_(streams), buffer_(buffer) {}

  Json write() {
    Json attributes = Json::object();
    const std::size_t indices = write_indices();
    attributes["POSITION"] = grid_.origin ? write_whole_positions() : write_positions();
    attributes["NORMAL"] = write_directions(arrays_.normals, "VEC3");
    if (!arrays_.tangents.empty()) attributes["TANGENT"] = write_directions(arrays_.tangents, "VEC4");
    if (!arrays_.uv0.empty()) attributes["TEXCOORD_0"] = write_reals(arrays_.uv0, grid_.uv[0], "VEC2", Json::object());
    if (!arrays_.uv1.empty()) attributes["TEXCOORD_1"] = write_reals(arrays_.uv1, grid_.uv[1], "VEC2", Json::object());
    if (!arrays_.cad_uv.empty())
      attributes["_CAD_UV"] = write_reals(arrays_.cad_uv, grid_.cad_uv, "VEC2", Json::object());
    if (!arrays_.colors.empty()) {
      const std::size_t view = add_view(arrays_.colors, "NONE");
      attributes["COLOR_0"] = add_accessor(view, k_unsigned_short, "VEC4", {{"normalized", true}});
    }
    return {{"attributes", std::move(attributes)}, {"indices", indices}};
  }

 private:
  /// @param values  with elements of a multiple of 4 bytes.
  template <class T>
  std::size_t add_view(std::vector<T> values, const char* filter) {
    const std::size_t count = values.size(), stride = sizeof(T);
    if (!streams_) {
      const std::size_t used = count * stride;
      buffer_.count_mesh(used, 0);
      return buffer_.add_view(std::move(values), GlbBuffer::Target::vertices, stride);
    }
    std::vector<unsigned char> stream(meshopt_encodeVertexBufferBound(count, stride));
    stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), values.data(), count, stride));
    buffer_.count_mesh(stream.size(), 0);
    return buffer_.add_meshopt_view(std::move(stream), GlbBuffer::Target::vertices,
                                    {count, stride, "ATTRIBUTES", filter});
  }

  std::size_t add_accessor(std::size_t view, int component, const char* type, Json further) {
    Json accessor = {{"componentType", component}, {"count", arrays_.positions.size()}, {"type", type}};
    accessor.update(further);
    return buffer_.add_accessor(view, std::move(accessor));
  }

  /// Fixed-point numbers as the filter EXPONENTIAL has them: 24 bits of mantissa, 8 of exponent.
  template <std::size_t N>
  std::size_t write_reals(const std::vector<std::array<float, N>>& values, int exponent, const char* type,
                          Json further) {
    if (!streams_) return add_accessor(add_view(values, "NONE"), k_float, type, std::move(further));
    std::vector<std::array<std::uint32_t, N>> filtered(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t k = 0; k < N; ++k) {
        const auto mantissa = static_cast<std::int32_t>(std::ldexp(double{values[i][k]}, -exponent));
        filtered[i][k] =
            (static_cast<std::uint32_t>(mantissa) & 0xffffffU) | (static_cast<std::uint32_t>(exponent) << 24);
      }
    return add_accessor(add_view(std::move(filtered), "EXPONENTIAL"), k_float, type, std::move(further));
  }

  std::size_t write_positions() {
    return write_reals(arrays_.positions, grid_.position, "VEC3", bounds_json(arrays_.positions));
  }

  std::size_t write_whole_positions() {
    using Whole = std::array<std::uint16_t, 4>;  // With padding.
    std::vector<Whole> whole(arrays_.positions.size());
    Whole low = {0xffff, 0xffff, 0xffff, 0}, high{};
    for (std::size_t i = 0; i < whole.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double steps = std::ldexp(double{arrays_.positions[i][k]}, -grid_.position);
        whole[i][k] = static_cast<std::uint16_t>(static_cast<std::int64_t>(steps) - (*grid_.origin)[k]);
        low[k] = std::min(low[k], whole[i][k]), high[k] = std::max(high[k], whole[i][k]);
      }
    return add_accessor(add_view(std::move(whole), "NONE"), k_unsigned_short, "VEC3",
                        {{"min", {low[0], low[1], low[2]}}, {"max", {high[0], high[1], high[2]}}});
  }

  /// Unit vectors as 8-bit numbers, of tangents with the handedness, of normals with padding.
  template <std::size_t N>
  std::size_t write_directions(const std::vector<std::array<float, N>>& values, const char* type) {
    std::vector<std::array<std::int8_t, 4>> whole(values.size());
    if (streams_) {
      std::vector<std::array<float, 4>> wide(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) std::copy(values[i].begin(), values[i].end(), wide[i].begin());
      if (!wide.empty()) meshopt_encodeFilterOct(whole.data(), wide.size(), 4, 8, wide.front().data());
    } else {
      for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t k = 0; k < N; ++k)
          whole[i][k] = static_cast<std::int8_t>(std::lround(127 * double{values[i][k]}));
    }
    return add_accessor(add_view(std::move(whole), "OCTAHEDRAL"), k_byte, type, {{"normalized", true}});
  }

  std::size_t write_indices() {
    const std::size_t count = 3 * arrays_.triangles.size();
    // The largest number of each width is the primitive restart value.
    const bool is_wide = arrays_.positions.size() > std::numeric_limits<std::uint16_t>::max();
    Json accessor = {
        {"componentType", is_wide ? k_unsigned_int : k_unsigned_short}, {"count", count}, {"type", "SCALAR"}};
    return buffer_.add_accessor(is_wide ? add_index_view<std::uint32_t>() : add_index_view<std::uint16_t>(),
                                std::move(accessor));
  }

  template <class T>
  std::size_t add_index_view() {
    const std::size_t count = 3 * arrays_.triangles.size();
    const auto* indices = arrays_.triangles.front().data();
    if (!streams_) {
      buffer_.count_mesh(count * sizeof(T), 0);
      return buffer_.add_view(std::vector<T>(indices, indices + count), GlbBuffer::Target::indices);
    }
    std::vector<unsigned char> stream(meshopt_encodeIndexBufferBound(count, arrays_.positions.size()));
    stream.resize(meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices, count));
    buffer_.count_mesh(stream.size(), 0);
    return buffer_.add_meshopt_view(std::move(stream), GlbBuffer::Target::indices, {count, sizeof(T), "TRIANGLES"});
  }

  const GlbArrays& arrays_;
  const VertexGrid& grid_;
  bool streams_;
  GlbBuffer& buffer_;
};

}  // namespace

bool can_write(MeshCoding coding) noexcept { return coding != MeshCoding::draco || has_draco_encoder(); }

Json write_compressed(GlbArrays arrays, const VertexGrid& grid, MeshCoding coding, GlbBuffer& buffer) {
  if (coding == MeshCoding::draco) return write_draco(arrays, grid, buffer);
  // The versions of the streams that EXT_meshopt_compression names.
  meshopt_encodeVertexVersion(0);
  meshopt_encodeIndexVersion(1);
  reorder(arrays);
  return CompressedWriter(arrays, grid, coding == MeshCoding::meshopt, buffer).write();
}

#else

bool can_write(MeshCoding coding) noexcept {
  return coding == MeshCoding::none || (coding == MeshCoding::draco && has_draco_encoder());
}

Json write_compressed(GlbArrays arrays, const VertexGrid& grid, MeshCoding, GlbBuffer& buffer) {
  return write_draco(arrays, grid, buffer);
}

#endif

}  // namespace papilla
