// SPDX-License-Identifier: MIT
#include "border_cut.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "checks.hpp"
#include "pyramid.hpp"

namespace papilla::texture_detail {
namespace {

double squared_step(const GreyImage& image, int x, int y, int shift) {
  const double difference = static_cast<double>(image.at(x, y)) - static_cast<double>(image.at(x + shift, y));
  return difference * difference;
}

/// Of the overlaps from `least` to `most` the one over which left and right differ least.
int least_different(const GreyImage& image, int least, int most) {
  int best = least;
  double lowest = 1e300;
  for (int overlap = least; overlap <= most; ++overlap) {
    const int shift = image.width - overlap;
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < overlap; ++x) sum += squared_step(image, x, y, shift);
    const double mean = sum / (static_cast<double>(overlap) * image.height);
    if (mean >= lowest) continue;
    lowest = mean;
    best = overlap;
  }
  return best;
}

/// The overlap, between a sixteenth and a quarter of the width, over which left and right differ least; in wide
/// pictures near that of the picture at half its size, so that the search costs no more than a few passes.
int best_overlap(const GreyImage& image) {
  constexpr int k_widest = 2048, k_near = 2;
  const int least = std::max(2, image.width / 16), most = std::max(least, image.width / 4);
  if (image.width <= k_widest) return least_different(image, least, most);
  const GreyImage half = halved(image);
  const auto near = static_cast<int>(std::lround(static_cast<double>(best_overlap(half)) * image.width / half.width));
  return least_different(image, std::clamp(near - k_near, least, most), std::clamp(near + k_near, least, most));
}

/// Column of the cut in every row, moving by at most one from row to row; first and last row agree when the picture
/// tiles from top to bottom.
std::vector<int> cut(const GreyImage& image, int overlap, bool periodic_down) {
  const int shift = image.width - overlap, rows = image.height;
  const auto cost = [&](int x, int y) { return squared_step(image, x, y, shift); };
  const auto path = [&](int first, int last) {  // −1: free end.
    std::vector<double> sums(static_cast<std::size_t>(overlap) * static_cast<std::size_t>(rows));
    std::vector<int> from(sums.size());
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < overlap; ++x) {
        double before = y == 0 && first >= 0 && x != first ? 1e300 : 0;
        int best = x;
        if (y > 0) {
          before = 1e300;
          for (int k = std::max(0, x - 1); k <= std::min(overlap - 1, x + 1); ++k)
            if (const double sum = sums[pixel_index(k, y - 1, overlap)]; sum < before) {
              before = sum;
              best = k;
            }
        }
        sums[pixel_index(x, y, overlap)] = std::min(1e300, before + cost(x, y));
        from[pixel_index(x, y, overlap)] = best;
      }
    std::vector<int> columns(static_cast<std::size_t>(rows));
    const auto end = sums.end() - overlap;
    int at = last >= 0 ? last : static_cast<int>(std::min_element(end, sums.end()) - end);
    for (int y = rows - 1; y >= 0; --y) {
      columns[static_cast<std::size_t>(y)] = at;
      at = from[pixel_index(at, y, overlap)];
    }
    return columns;
  };
  std::vector<int> columns = path(-1, -1);
  if (!periodic_down || columns.front() == columns.back()) return columns;
  // Through the row half way along the free path: a closed path near the best one.
  const int through = (columns.front() + columns.back()) / 2;
  columns = path(through, through);
  return columns;
}

}  // namespace

GreyImage cut_across(const GreyImage& image, bool periodic_down) {
  const int overlap = best_overlap(image), width = image.width - overlap;
  const std::vector<int> columns = cut(image, overlap, periodic_down);
  GreyImage result{width, image.height, {}, image.pitch_mm, 32};
  const double feather = std::min(2.0, overlap / 4.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const double own = static_cast<double>(image.at(x, y));
      if (x >= overlap) {
        result.pixels.push_back(static_cast<float>(own));
        continue;
      }
      // Left of the cut what goes on from the right border, right of it the picture itself; the outermost columns are
      // never mixed, so that both neighbours of the seam come from the picture's own rows.
      const double t = (x - columns[static_cast<std::size_t>(y)]) / std::max(feather, 1e-9);
      double share = std::clamp(0.5 + t / 2, 0.0, 1.0);
      if (x == 0) share = 0;
      if (x == overlap - 1) share = 1;
      result.pixels.push_back(
          static_cast<float>(share * own + (1 - share) * static_cast<double>(image.at(x + width, y))));
    }
  return result;
}

GreyImage transposed(const GreyImage& image) {
  GreyImage result{image.height, image.width, {}, image.pitch_mm, image.bits};
  result.pixels.reserve(image.pixels.size());
  for (int x = 0; x < image.width; ++x)
    for (int y = 0; y < image.height; ++y) result.pixels.push_back(image.at(x, y));
  return result;
}

}  // namespace papilla::texture_detail
