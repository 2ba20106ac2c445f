// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla::texture_detail {

/// A whole-number matrix in lattice coordinates: (u, v) → (a u + b v, c u + d v).
struct LatticeMatrix {
  int a = 1, b = 0, c = 0, d = 1;
  friend bool operator==(const LatticeMatrix&, const LatticeMatrix&) = default;
  int determinant() const { return a * d - b * c; }
};

LatticeMatrix product(const LatticeMatrix& p, const LatticeMatrix& q);
Vec2 apply(const LatticeMatrix& m, Vec2 x);

/// x → M x + t/2 in lattice coordinates; t in half lattice vectors, 0 or 1.
struct PlaneOperation {
  LatticeMatrix matrix;
  int half_u = 0, half_v = 0;
};

/// A group without its translations, the identity first, and its name.
struct PlaneGroup {
  WallpaperGroup name = WallpaperGroup::p1;
  std::vector<PlaneOperation> operations;
};

/// All wallpaper groups whose rotations and reflections keep the lattice of `vectors` up to `tolerance`, in every
/// orientation. The vectors must be Gauss-reduced.
std::vector<PlaneGroup> plane_groups(const std::array<Vec2, 2>& vectors, double tolerance);

}  // namespace papilla::texture_detail
