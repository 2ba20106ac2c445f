// SPDX-License-Identifier: MIT
#include "papilla/texture/texture_order.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "texture_class_rules.hpp"

namespace papilla {

using texture_detail::StructureTensor;

void TextureOrder::add(const GreyImage& piece) {
  texture_detail::require_image(piece, "TextureOrder::add");
  const texture_detail::Moments moments = texture_detail::moments_of(piece);
  const StructureTensor tensor = texture_detail::structure_tensor(piece);
  const auto [low, high] = std::minmax_element(piece.pixels.begin(), piece.pixels.end());
  pieces_.push_back({static_cast<double>(piece.pixels.size()), moments.mean, moments.deviation, tensor.xx, tensor.xy,
                     tensor.yy, *low, *high});
}

TextureOrder::Piece TextureOrder::whole() const {
  Piece sum = pieces_.front();
  sum.pixels = sum.mean = sum.deviation = sum.xx = sum.xy = sum.yy = 0;
  double squares = 0;
  for (const Piece& piece : pieces_) {
    sum.pixels += piece.pixels;
    sum.mean += piece.pixels * piece.mean;
    squares += piece.pixels * (piece.mean * piece.mean + piece.deviation * piece.deviation);
    sum.xx += piece.pixels * piece.xx;
    sum.xy += piece.pixels * piece.xy;
    sum.yy += piece.pixels * piece.yy;
    sum.low = std::min(sum.low, piece.low);
    sum.high = std::max(sum.high, piece.high);
  }
  sum.mean /= sum.pixels;
  sum.deviation = std::sqrt(std::max(0.0, squares / sum.pixels - sum.mean * sum.mean));
  return sum;
}

TextureClass TextureOrder::classify(double explained_variance, double stripes) const {
  const Piece all = whole();
  return texture_detail::class_of(StructureTensor{all.xx, all.xy, all.yy}.coherence(), explained_variance, stripes);
}

Suitability TextureOrder::suitability(const Lattice& lattice) const {
  const Piece all = whole();
  std::vector<texture_detail::Moments> blocks;
  for (const Piece& piece : pieces_) blocks.push_back({piece.mean, piece.deviation});
  Suitability suitability;
  suitability.flat = !(all.low < all.high);
  suitability.homogeneous = texture_detail::is_homogeneous(blocks, {all.mean, all.deviation});
  suitability.directional =
      StructureTensor{all.xx, all.xy, all.yy}.coherence() >= texture_detail::k_directional_coherence;
  suitability.symmetric = lattice.found;
  return suitability;
}

OrientationField TextureOrder::orientation(int columns, int rows) const {
  std::vector<StructureTensor> tensors;
  std::vector<double> pixels;
  for (const Piece& piece : pieces_) {
    tensors.push_back({piece.xx, piece.xy, piece.yy});
    pixels.push_back(piece.pixels);
  }
  return texture_detail::orientation_of(tensors, pixels, columns, rows);
}

}  // namespace papilla
