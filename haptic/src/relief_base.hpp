// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

/// The mesh moved inwards to the lowest height of each material's relief. A mesh without relief needs no memory.
class ReliefBase {
 public:
  explicit ReliefBase(const ContactMesh& mesh) noexcept : mesh_(&mesh) {}

  /// Where a vertex is moved, and by how much along its normal, ≤ 0.
  struct Move {
    std::array<float, 3> way{};
    float shift = 0;
  };
  /// @param place for each vertex the index of its move.
  void set(std::vector<std::uint32_t> place, std::vector<Move> moves) {
    place_ = std::move(place);
    moves_ = std::move(moves);
  }

  Vec3 corner(std::size_t t, std::size_t k) const {
    const Vec3 p = mesh_->corner(t, k);
    if (moves_.empty()) return p;
    const auto& [x, y, z] = moves_[place_[mesh_->triangles[t][k]]].way;
    return p + Vec3{double{x}, double{y}, double{z}};
  }
  float shift(std::size_t t, std::size_t k) const {
    return moves_.empty() ? 0 : moves_[place_[mesh_->triangles[t][k]]].shift;
  }
  float lowest_shift(std::size_t t) const { return std::min({shift(t, 0), shift(t, 1), shift(t, 2)}); }

 private:
  const ContactMesh* mesh_;
  std::vector<std::uint32_t> place_;
  std::vector<Move> moves_;
};

/// Vertices at the same position move together, by the lowest height of the materials that meet there, along the mean
/// of their normals weighted by angle (corner normals where given, else face normals), lengthened at sharp edges so
/// that faces move by the full height. The offset is shortened where a triangle would be inverted. Cost: linear.
ReliefBase make_relief_base(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                            const std::vector<HeightField>& heights);

}  // namespace papilla
