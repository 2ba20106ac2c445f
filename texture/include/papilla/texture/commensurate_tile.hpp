// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Options of find_commensurate_tile().
struct CommensurateOptions {
  double most_strain = 0.01;  ///< Tiles that turn or stretch the lattice by less are preferred.
  int least_side = 32;        ///< Of the tile, in pixels.
  int most_side = 2048;
};

/// A rectangle of whole pixels that holds a whole number of cells of a lattice; see find_commensurate_tile().
struct CommensurateTile {
  int width = 0, height = 0;  ///< In pixels.
  /// The tile's sides in lattice vectors: right = c[0][0]·a + c[0][1]·b, down = c[1][0]·a + c[1][1]·b.
  std::array<std::array<int, 2>, 2> combination{};
  /// How far the lattice is bent to fit: the largest stretch or turn, ‖F − 1‖ of the map F from the lattice's own
  /// sides to those of the tile. 0.01 is one pixel in a hundred, or 0.6 degrees.
  double strain = 0;
};

/// The smallest upright tile of a lattice, whatever its angle: of all pairs of lattice vectors, one near the horizontal
/// and one near the vertical, the pair of least area whose strain is at most `most_strain`; where there is none within
/// `most_side`, the pair of least strain. Sides are rounded to whole pixels, and that is part of the strain.
/// Cost: O(vectors within most_side). Deterministic.
/// @throws InvalidInput when the vectors are parallel or not finite, an option is out of range, or no pair of lattice
/// vectors is near enough (within 45 degrees) to the axes.
CommensurateTile find_commensurate_tile(const std::array<Vec2, 2>& vectors_px, const CommensurateOptions& options = {});

/// The cell repeated over the tile: pixel (x, y) is the cell at the lattice coordinates (x/width)·right +
/// (y/height)·down, which are taken modulo one in whole numbers, so that the picture repeats to the last bit.
/// @param cell  one period in each direction, as SymmetricPart::primitive.
/// @throws InvalidInput when the cell or the tile is empty.
GreyImage fill_tile(const GreyImage& cell, const CommensurateTile& tile);

}  // namespace papilla
