// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "glb_document.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The vertices of a primitive, an array per attribute as glTF wants them, and its triangles. What it does not have is
/// empty.
struct GlbArrays {
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<float, 4>> tangents;
  std::vector<std::array<float, 2>> uv0, uv1, cad_uv;
  std::vector<std::array<std::uint16_t, 4>> colors;
  std::vector<Triangle> triangles;
};

/// Values are rounded to whole multiples of 2^e before they are compressed. Such numbers fit into 24 bits, so that a
/// float holds them, and every codec gives them back bit for bit.
struct VertexGrid {
  int position = 0;  ///< e, of metres; the same in a whole part, so that its primitives stay closed.
  std::array<int, 2> uv{};
  int cad_uv = 0;
  /// Positions as 16-bit numbers q: (q + origin) · 2^e metres. Nothing: they stay floats.
  std::optional<std::array<std::int64_t, 3>> origin;
};

/// The largest e for which rounding moves a point of `dimensions` coordinates by no more than `most`, unless 24 bits
/// could not hold `largest` then.
/// @pre most > 0 or largest > 0.
int grid_exponent(double most, int dimensions, double largest);

/// value to the next multiple of 2^exponent; zeros are positive.
float to_grid(float value, int exponent);

/// The unit vector next to `direction` of those whose octahedral coordinates have 8 bits: whole numbers with
/// |x| + |y| + |z| = 127 [Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT
/// 2014]. Both meshopt and Draco have exactly these; the largest error is 0.64°.
std::array<float, 3> to_octahedron(const std::array<float, 3>& direction);

/// Writes a primitive whose values lie on the grid. @returns its JSON, without a material.
/// @pre coding is not `none`, and can_write() it.
GlbBuffer::Json write_compressed(GlbArrays arrays, const VertexGrid& grid, MeshCoding coding, GlbBuffer& buffer);

/// The same with Draco. @pre as above.
GlbBuffer::Json write_draco(const GlbArrays& arrays, const VertexGrid& grid, GlbBuffer& buffer);
bool has_draco_encoder() noexcept;

/// The least and the greatest of each coordinate, as members of an accessor.
GlbBuffer::Json bounds_json(std::span<const std::array<float, 3>> positions);

}  // namespace papilla
