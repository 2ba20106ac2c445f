// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/lattice.hpp"

namespace papilla {

/// True when both are lattices and the same one, whatever their bases: every vector of the one is a whole combination
/// of those of the other to within a tenth of a cell, and their cells are equally large.
/// Cost: O(1).
bool is_same_lattice(const Lattice& a, const Lattice& b);

/// How the pieces of a picture agree with the lattice of its middle.
struct LatticeAgreement {
  int same = 0;   ///< Pieces with that lattice, or without any when the middle has none.
  int other = 0;  ///< Pieces with another one, or with one where the middle has none.
  int none = 0;   ///< Pieces without a lattice where the middle has one.

  void add(const Lattice& middle, const Lattice& piece);
  int pieces() const { return same + other + none; }
  /// At least half of the pieces agree with the middle.
  bool holds() const { return 2 * same >= pieces(); }
};

}  // namespace papilla
