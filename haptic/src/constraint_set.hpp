// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/core/vec.hpp"

namespace papilla {

/// A half-space that the proxy must not leave: normal · x ≥ offset.
struct HalfSpace {
  Vec3 normal;
  double offset = 0;
  std::uint32_t material = 0;
};

/// The closest point of a few half-spaces to a goal.
struct ConstrainedPoint {
  Vec3 point;
  std::uint32_t active = 0;  ///< Bit i: half-space i carries load.
  int count = 0;             ///< Bits set in `active`, at most 3.
  bool found = false;
};

/// argmin |x − goal|² subject to every half-space, by trying all sets of at most three active planes and taking the
/// one whose multipliers are ≥ 0 and that breaks no other plane (the conditions of Karush, Kuhn and Tucker, which are
/// sufficient here). `slack` is the length by which a plane may be broken.
/// Cost: at most 92 small solves for 8 planes. noexcept, no allocation.
ConstrainedPoint closest_point(Vec3 goal, const HalfSpace* planes, int count, double slack) noexcept;

}  // namespace papilla
