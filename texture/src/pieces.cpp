// SPDX-License-Identifier: MIT
#include "pieces.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <numeric>
#include <utility>

#include "checks.hpp"

namespace papilla::texture_detail {
namespace {

/// Bounds the memory on machines of many cores.
constexpr std::size_t k_pieces_at_once = 4;

Piece cut_out(const SampleRows& picture, const PieceSpan& across, const PieceSpan& down) {
  Piece piece{across, down, {across.length(), down.length(), {}, 0, 32}};
  piece.image.pixels.resize(static_cast<std::size_t>(across.length()) * static_cast<std::size_t>(down.length()));
  for (int y = 0; y < down.length(); ++y) {
    const int row = wrapped(down.begin + y, picture.height());
    for (int x = 0; x < across.length();) {
      const int column = wrapped(across.begin + x, picture.width());
      const int count = std::min(picture.width() - column, across.length() - x);
      picture.read(column, row, count, &piece.image.at(x, y));
      x += count;
    }
  }
  return piece;
}

/// The weighted sums of the rows that pieces may still add to.
class OpenRows {
 public:
  OpenRows(int width, const RowWriter& write) : width_(width), write_(write) {}

  void add(const PieceSpan& across, const PieceSpan& down, const std::vector<double>& heights) {
    for (int y = 0; y < down.length(); ++y) {
      const double row_weight = down.weights[static_cast<std::size_t>(y)];
      if (!(row_weight > 0)) continue;
      double* sum = row(down.begin + y);
      for (int x = 0; x < across.length(); ++x)
        sum[wrapped(across.begin + x, width_)] +=
            row_weight * across.weights[static_cast<std::size_t>(x)] * heights[pixel_index(x, y, across.length())];
    }
  }

  /// No piece adds to the rows above `end` any more, but for the first `shared`, to which those below the lower border
  /// are added in the end.
  void close(int end, int shared) {
    for (; top_ < end; ++top_) {
      std::vector<double> sum = std::move(rows_.front());
      rows_.pop_front();
      if (top_ < shared) {
        head_.push_back(std::move(sum));
      } else {
        write_(top_, sum);
      }
    }
  }

  void finish() {
    for (std::size_t i = 0; i < head_.size(); ++i) {
      std::transform(head_[i].begin(), head_[i].end(), rows_[i].begin(), head_[i].begin(), std::plus<>());
      write_(static_cast<int>(i), head_[i]);
    }
  }

 private:
  double* row(int y) {
    while (top_ + static_cast<int>(rows_.size()) <= y) rows_.emplace_back(static_cast<std::size_t>(width_), 0.0);
    return rows_[static_cast<std::size_t>(y - top_)].data();
  }

  int width_, top_ = 0;
  const RowWriter& write_;
  std::deque<std::vector<double>> rows_;   ///< From row top_ on, beyond the lower border of periodic pictures too.
  std::vector<std::vector<double>> head_;  ///< The first rows of a periodic picture.
};

}  // namespace

int PieceSpan::before() const {
  const auto first = std::find_if(weights.begin(), weights.end(), [](double weight) { return weight > 0; });
  return static_cast<int>(first - weights.begin());
}

std::vector<PieceSpan> piece_spans(int side, const PieceLayout& layout) {
  const int count = (side + layout.core - 1) / layout.core;
  const auto start_of = [&](int k) { return static_cast<int>(static_cast<std::int64_t>(k) * side / count); };
  // A single piece has no neighbour, except its own other end when the picture is periodic.
  const int overlap = count == 1 && !layout.periodic ? 0 : std::min(layout.overlap, side / count / 2);
  // Without overlap a single piece is the whole side, and periodic in itself.
  const bool whole = count == 1 && layout.overlap == 0;
  const int longest = (side + count - 1) / count + overlap;
  const int length = overlap > 0 && layout.suitable != nullptr
                         ? std::min(layout.suitable(longest), longest - overlap + side / count)
                         : longest;
  const auto overlap_after = [&](int k) { return overlap > 0 ? length - (start_of(k + 1) - start_of(k)) : 0; };
  std::vector<PieceSpan> spans;
  for (int k = 0; k < count; ++k) {
    const int start = start_of(k), own = start_of(k + 1) - start;
    const bool opens = layout.periodic || k > 0, goes_on = layout.periodic || k + 1 < count;
    const int before = whole ? 0 : layout.periodic ? layout.before : std::min(start, layout.before);
    const int shared_before = overlap_after(k > 0 ? k - 1 : count - 1), shared_after = overlap_after(k);
    PieceSpan span{start - before, std::vector<double>(static_cast<std::size_t>(before), 0.0)};
    for (int i = 0; i < own + (goes_on ? shared_after : 0); ++i) {
      const double rise = opens && !whole ? (i + 1.0) / (shared_before + 1) : 1;
      const double fall = i < own ? 1 : static_cast<double>(own + shared_after - i) / (shared_after + 1);
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

void solve_by_pieces(const SampleRows& picture, const PieceLayout& layout,
                     const std::function<std::vector<double>(const Piece&)>& solve, const RowWriter& write,
                     const ProgressCallback& progress, std::string_view stage) {
  const std::vector<PieceSpan> columns = piece_spans(picture.width(), layout),
                               rows = piece_spans(picture.height(), layout);
  const double count = static_cast<double>(columns.size()) * static_cast<double>(rows.size());
  const int shared = rows.back().begin + rows.back().length() - picture.height();
  OpenRows open(picture.width(), write);
  double done = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t first = 0; first < columns.size(); first += k_pieces_at_once) {
      report_progress(progress, stage, done / count);
      std::vector<std::vector<double>> heights(std::min(k_pieces_at_once, columns.size() - first));
      oneapi::tbb::parallel_for(std::size_t{0}, heights.size(), [&](std::size_t i) {
        heights[i] = solve(cut_out(picture, columns[first + i], rows[r]));
      });
      for (std::size_t i = 0; i < heights.size(); ++i) open.add(columns[first + i], rows[r], heights[i]);
      done += static_cast<double>(heights.size());
    }
    open.close(r + 1 < rows.size() ? rows[r + 1].begin + rows[r + 1].before() : picture.height(), shared);
  }
  open.finish();
  report_progress(progress, stage, 1);
}

RowWriter rows_of(std::vector<double>& field, int width) {
  return [&field, width](int y, std::span<const double> row) {
    std::copy(row.begin(), row.end(), field.begin() + static_cast<std::ptrdiff_t>(pixel_index(0, y, width)));
  };
}

}  // namespace papilla::texture_detail
