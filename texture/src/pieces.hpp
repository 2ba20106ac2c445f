// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// How a picture too large for one solve is cut.
struct PieceLayout {
  int core = 1024;        ///< Pieces are at most this wide and high, what they share with others left aside.
  int before = 0;         ///< Pixels further left and up that a piece sees but does not decide.
  int overlap = 0;        ///< Pixels shared with the next piece, over which the two are mixed by a ramp.
  bool periodic = false;  ///< The picture goes on beyond its borders; otherwise pieces end there.
};

/// A part of a picture along one axis: samples begin … begin + weights.size() − 1, modulo the side when periodic.
/// Over all parts of a side the weights of a sample add up to 1.
struct PieceSpan {
  int begin = 0;
  std::vector<double> weights;

  int length() const noexcept { return static_cast<int>(weights.size()); }
};

/// The parts of a side in order.
std::vector<PieceSpan> piece_spans(int side, const PieceLayout& layout);

/// One piece: where it lies and the picture there.
struct Piece {
  const PieceSpan& across;
  const PieceSpan& down;
  GreyImage image;

  double weight(int x, int y) const {
    return across.weights[static_cast<std::size_t>(x)] * down.weights[static_cast<std::size_t>(y)];
  }
};

/// Over how many pixels pieces of a picture are mixed: more than what the last steps of a solve still change.
int piece_overlap(int largest_piece_px);

/// The sum of values that came in any order, the same to the last bit in each.
double ordered_sum(std::vector<double> values);

/// Progress of a part of the work, from `begin` to `end` of the whole; empty when `whole` is.
ProgressCallback part_of(const ProgressCallback& whole, double begin, double end);

/// Solves a picture piece by piece, several at a time on all threads: `solve` returns the heights of a piece, row by
/// row, and their weighted sum over the pieces is the result. Memory: that of the result and of four pieces. The result
/// does not depend on the number of threads. `solve` must be safe to run on several pieces at once; `progress` is told
/// `stage` and the share of pieces done.
std::vector<double> solve_by_pieces(const GreyImage& image, const PieceLayout& layout,
                                    const std::function<std::vector<double>(const Piece&)>& solve,
                                    const ProgressCallback& progress, std::string_view stage);

}  // namespace papilla::texture_detail
