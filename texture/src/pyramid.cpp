// SPDX-License-Identifier: MIT
#include "pyramid.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"

namespace papilla::texture_detail {
namespace {

/// The fine pixels that a coarse one covers along one axis: first…last, the two at the ends in part.
struct Cover {
  int first = 0, last = 0;
  double first_share = 1, last_share = 1;

  double share(int i) const { return i == first ? first_share : i == last ? last_share : 1; }
};

std::vector<Cover> covers(int fine, int coarse) {
  std::vector<Cover> result;
  const double ratio = static_cast<double>(fine) / coarse;
  for (int i = 0; i < coarse; ++i) {
    const double begin = i * ratio, end = (i + 1) * ratio;
    Cover cover;
    cover.first = static_cast<int>(begin);
    cover.last = std::min(fine - 1, static_cast<int>(std::ceil(end)) - 1);
    cover.first_share = std::min(end, cover.first + 1.0) - begin;
    cover.last_share = end - std::max(begin, static_cast<double>(cover.last));
    result.push_back(cover);
  }
  return result;
}

/// The two coarse samples around a fine one and the weight of the second.
struct Between {
  int before = 0, after = 0;
  double weight = 0;
};

std::vector<Between> positions(const FineAxis& axis, int fine, int coarse, bool periodic) {
  std::vector<Between> result;
  for (int i = 0; i < axis.count; ++i) {
    const double at = (axis.begin + (i + 0.5) * axis.step) * coarse / fine - 0.5;
    const int before = static_cast<int>(std::floor(at));
    const auto inside = [&](int k) { return periodic ? wrapped(k, coarse) : std::clamp(k, 0, coarse - 1); };
    result.push_back({inside(before), inside(before + 1), at - before});
  }
  return result;
}

}  // namespace

GreyImage halved(const GreyImage& image) {
  GreyImage half{(image.width + 1) / 2, (image.height + 1) / 2, {}, 2 * image.pitch_mm, 32};
  const std::vector<Cover> columns = covers(image.width, half.width), rows = covers(image.height, half.height);
  half.pixels.reserve(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height));
  for (const Cover& row : rows)
    for (const Cover& column : columns) {
      double sum = 0, area = 0;
      for (int y = row.first; y <= row.last; ++y)
        for (int x = column.first; x <= column.last; ++x) {
          const double share = row.share(y) * column.share(x);
          sum += share * static_cast<double>(image.at(x, y));
          area += share;
        }
      half.pixels.push_back(static_cast<float>(sum / area));
    }
  return half;
}

Shrunk shrunk(const GreyImage& image, int most_side) {
  Shrunk result;
  for (const GreyImage* from = &image; std::max(from->width, from->height) > most_side; from = &result.image) {
    result.image = halved(*from);
    ++result.halvings;
  }
  if (result.halvings == 0) result.image = image;
  return result;
}

double enlargement(const CoarseHeights& coarse, const FineAxis& across, const FineAxis& down) {
  return (static_cast<double>(coarse.fine_width) / (across.step * coarse.width) +
          static_cast<double>(coarse.fine_height) / (down.step * coarse.height)) /
         2;
}

std::vector<double> enlarged(const CoarseHeights& coarse, const FineAxis& across, const FineAxis& down) {
  const std::vector<Between> columns = positions(across, coarse.fine_width, coarse.width, coarse.periodic);
  const std::vector<Between> rows = positions(down, coarse.fine_height, coarse.height, coarse.periodic);
  const double scale = enlargement(coarse, across, down);
  std::vector<double> result;
  result.reserve(columns.size() * rows.size());
  for (const Between& row : rows) {
    const double *above = coarse.heights.data() + pixel_index(0, row.before, coarse.width),
                 *below = coarse.heights.data() + pixel_index(0, row.after, coarse.width);
    for (const Between& column : columns) {
      const auto along = [&](const double* line) {
        return (1 - column.weight) * line[column.before] + column.weight * line[column.after];
      };
      result.push_back(scale * ((1 - row.weight) * along(above) + row.weight * along(below)));
    }
  }
  return result;
}

std::vector<double> enlarged(const CoarseHeights& coarse) {
  return enlarged(coarse, {0, 1, coarse.fine_width}, {0, 1, coarse.fine_height});
}

}  // namespace papilla::texture_detail
