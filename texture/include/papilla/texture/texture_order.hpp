// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice.hpp"
#include "papilla/texture/texture_class.hpp"

namespace papilla {

/// Class, suitability and orientation of a picture too large for memory, from its pieces: what classify(),
/// measure_suitability() and orientation_field() give for a whole picture, with the pieces as blocks. Gradients across
/// the borders of pieces are left out. Pieces are added row by row, from left to right.
class TextureOrder {
 public:
  /// Cost: O(pixels). @throws InvalidInput when the piece is empty or not finite.
  void add(const GreyImage& piece);

  /// See classify(). @pre a piece was added.
  TextureClass classify(double explained_variance, double stripes) const;
  /// See measure_suitability(). @pre a piece was added.
  Suitability suitability(const Lattice& lattice) const;
  /// One block a piece. @pre as many pieces as columns · rows were added.
  OrientationField orientation(int columns, int rows) const;

 private:
  struct Piece {
    double pixels = 0, mean = 0, deviation = 0;
    double xx = 0, xy = 0, yy = 0;  ///< Structure tensor.
    float low = 0, high = 0;
  };
  Piece whole() const;
  std::vector<Piece> pieces_;
};

}  // namespace papilla
