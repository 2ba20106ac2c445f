// SPDX-License-Identifier: MIT
#include "pieces.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "checks.hpp"

namespace papilla::texture_detail {
namespace {

/// Bounds the memory on machines of many cores.
constexpr std::size_t k_pieces_at_once = 4;

Piece cut_out(const GreyImage& image, const PieceSpan& across, const PieceSpan& down) {
  Piece piece{across, down, {across.length(), down.length(), {}, image.pitch_mm, image.bits}};
  piece.image.pixels.reserve(static_cast<std::size_t>(across.length()) * static_cast<std::size_t>(down.length()));
  for (int y = 0; y < down.length(); ++y) {
    const int row = wrapped(down.begin + y, image.height);
    for (int x = 0; x < across.length(); ++x)
      piece.image.pixels.push_back(image.at(wrapped(across.begin + x, image.width), row));
  }
  return piece;
}

void add_weighted(const PieceSpan& across, const PieceSpan& down, const std::vector<double>& heights,
                  const GreyImage& image, std::vector<double>& sum) {
  for (int y = 0; y < down.length(); ++y) {
    const double row_weight = down.weights[static_cast<std::size_t>(y)];
    if (!(row_weight > 0)) continue;
    const int row = wrapped(down.begin + y, image.height);
    for (int x = 0; x < across.length(); ++x)
      sum[pixel_index(wrapped(across.begin + x, image.width), row, image.width)] +=
          row_weight * across.weights[static_cast<std::size_t>(x)] * heights[pixel_index(x, y, across.length())];
  }
}

}  // namespace

std::vector<PieceSpan> piece_spans(int side, const PieceLayout& layout) {
  const int count = (side + layout.core - 1) / layout.core;
  const auto start_of = [&](int k) { return static_cast<int>(static_cast<std::int64_t>(k) * side / count); };
  // A single piece has no neighbour, except its own other end when the picture is periodic.
  const int overlap = count == 1 && !layout.periodic ? 0 : std::min(layout.overlap, side / count / 2);
  // Without overlap a single piece is the whole side, and periodic in itself.
  const bool whole = count == 1 && layout.overlap == 0;
  std::vector<PieceSpan> spans;
  for (int k = 0; k < count; ++k) {
    const int start = start_of(k), own = start_of(k + 1) - start;
    const bool opens = layout.periodic || k > 0, goes_on = layout.periodic || k + 1 < count;
    const int before = whole ? 0 : layout.periodic ? layout.before : std::min(start, layout.before);
    PieceSpan span{start - before, std::vector<double>(static_cast<std::size_t>(before), 0.0)};
    for (int i = 0; i < own + (goes_on ? overlap : 0); ++i) {
      const double rise = opens && !whole ? (i + 1.0) / (overlap + 1) : 1;
      const double fall = i < own ? 1 : static_cast<double>(own + overlap - i) / (overlap + 1);
      span.weights.push_back(std::min(rise, 1.0) * fall);
    }
    spans.push_back(std::move(span));
  }
  return spans;
}

int piece_overlap(int largest_piece_px) { return std::min(128, largest_piece_px / 4); }

double ordered_sum(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return std::accumulate(values.begin(), values.end(), 0.0);
}

ProgressCallback part_of(const ProgressCallback& whole, double begin, double end) {
  if (!whole) return {};
  return [whole, begin, end](const Progress& part) {
    return whole({part.stage, begin + (end - begin) * part.fraction});
  };
}

std::vector<double> solve_by_pieces(const GreyImage& image, const PieceLayout& layout,
                                    const std::function<std::vector<double>(const Piece&)>& solve,
                                    const ProgressCallback& progress, std::string_view stage) {
  const std::vector<PieceSpan> columns = piece_spans(image.width, layout), rows = piece_spans(image.height, layout);
  const std::size_t count = columns.size() * rows.size();
  std::vector<double> sum(image.pixels.size(), 0.0);
  for (std::size_t first = 0; first < count; first += k_pieces_at_once) {
    report_progress(progress, stage, static_cast<double>(first) / static_cast<double>(count));
    std::vector<std::vector<double>> heights(std::min(k_pieces_at_once, count - first));
    oneapi::tbb::parallel_for(std::size_t{0}, heights.size(), [&](std::size_t i) {
      const std::size_t t = first + i;
      heights[i] = solve(cut_out(image, columns[t % columns.size()], rows[t / columns.size()]));
    });
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const std::size_t t = first + i;
      add_weighted(columns[t % columns.size()], rows[t / columns.size()], heights[i], image, sum);
    }
  }
  report_progress(progress, stage, 1);
  return sum;
}

}  // namespace papilla::texture_detail
