// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla::texture_detail {

/// How a picture too large for one solve is cut.
struct PieceLayout {
  int core = 1024;        ///< Largest width and height of a piece without the pixels that it shares with others.
  int before = 0;         ///< Pixels to the left and above that a piece reads and whose result it does not give.
  int overlap = 0;        ///< Pixels shared with the next piece at least, over which the two are mixed by a ramp.
  bool periodic = false;  ///< The picture repeats beyond its borders; otherwise pieces end there.
  int (*suitable)(int least) = nullptr;  ///< Next length that is fast to solve: pieces overlap as much more.
};

/// A part of a picture along one axis: samples begin … begin + weights.size() − 1, modulo the side when periodic.
/// Over all parts of a side the weights of a sample add up to 1.
struct PieceSpan {
  int begin = 0;
  std::vector<double> weights;

  int length() const noexcept { return static_cast<int>(weights.size()); }
  int before() const;  ///< Samples at its beginning whose result it does not give.
};

/// The parts of a side in order.
std::vector<PieceSpan> piece_spans(int side, const PieceLayout& layout);

/// One piece: its place and its pixels.
struct Piece {
  const PieceSpan& across;
  const PieceSpan& down;
  GreyImage image;

  double weight(int x, int y) const {
    return across.weights[static_cast<std::size_t>(x)] * down.weights[static_cast<std::size_t>(y)];
  }
};

/// Pixels over which neighbouring pieces are mixed: farther than the last steps of a solve change the result.
int piece_overlap(int largest_piece_px);

/// The sum of the values in ascending order: the same to the last bit whatever order they come in.
double ordered_sum(std::vector<double> values);

/// Progress of a part of the work, from `begin` to `end` of the whole; empty when `whole` is.
ProgressCallback part_of(const ProgressCallback& whole, double begin, double end);

/// Takes a row of the result; called once for every row, in any order.
using RowWriter = std::function<void(int y, std::span<const double> row)>;

/// Solves a picture piece by piece, several at a time on all threads: `solve` returns the heights of a piece, row by
/// row, and their weighted sum over the pieces is the result. Memory: that of four pieces, and of the result's rows
/// that pieces share. The result does not depend on the number of threads. `solve` must be safe to run on several
/// pieces at once; `progress` gets `stage` and the share of the pieces that are done.
void solve_by_pieces(const SampleRows& picture, const PieceLayout& layout,
                     const std::function<std::vector<double>(const Piece&)>& solve, const RowWriter& write,
                     const ProgressCallback& progress, std::string_view stage);

/// Writes rows into a field of that width, which must outlive the writer.
RowWriter rows_of(std::vector<double>& field, int width);

}  // namespace papilla::texture_detail
