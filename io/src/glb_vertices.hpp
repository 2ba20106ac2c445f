// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Which attributes a primitive has beside position and normal.
struct GlbLayout {
  int tex_coords = 0;
  bool colors = false, tangents = false;
  int tangent_tex_coord = 0;
};

/// A vertex with everything that must agree for corners to share it. Texture coordinates are glTF's, v down. Zeros are
/// positive, so that equal numbers are equal bits; what the layout leaves out is zero.
struct GlbVertex {
  std::array<float, 3> position{}, normal{};
  std::array<float, 2> uv0{}, uv1{};
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
  std::vector<std::array<float, 2>> uv0, uv1;
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

}  // namespace papilla
