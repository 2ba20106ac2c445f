// SPDX-License-Identifier: MIT
#include "pyramid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "checks.hpp"
#include "papilla/texture/stored_samples.hpp"

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

/// A picture at half its sides (rounded), every sample the mean of the area it covers. Computes whole rows when they
/// are read, from the top down; not for several threads.
class HalvedRows final : public SampleRows {
 public:
  explicit HalvedRows(const SampleRows& fine)
      : SampleRows((fine.width() + 1) / 2, (fine.height() + 1) / 2),
        fine_(fine),
        columns_(covers(fine.width(), width())),
        rows_(covers(fine.height(), height())) {}

  void read(int x, int y, int count, float* samples) const override {
    const Cover& row = rows_[static_cast<std::size_t>(y)];
    for (int k = row.first; k <= row.last; ++k) keep(k);
    for (int i = 0; i < count; ++i) {
      const Cover& column = columns_[static_cast<std::size_t>(x + i)];
      double sum = 0, area = 0;
      for (int fy = row.first; fy <= row.last; ++fy)
        for (int fx = column.first; fx <= column.last; ++fx) {
          const double share = row.share(fy) * column.share(fx);
          sum += share * static_cast<double>(kept(fy).samples[static_cast<std::size_t>(fx)]);
          area += share;
        }
      samples[i] = static_cast<float>(sum / area);
    }
  }

 private:
  static constexpr int k_kept = 4;  // A row covers at most three, which follow one another.
  struct Kept {
    int row = -1;
    std::vector<float> samples;
  };

  Kept& kept(int row) const { return kept_[static_cast<std::size_t>(row % k_kept)]; }
  void keep(int row) const {
    Kept& place = kept(row);
    if (place.row == row) return;
    place.row = row;
    place.samples.resize(static_cast<std::size_t>(fine_.width()));
    fine_.read(0, row, fine_.width(), place.samples.data());
  }

  const SampleRows& fine_;
  std::vector<Cover> columns_, rows_;
  mutable std::array<Kept, k_kept> kept_;
};

GreyImage all_of(const SampleRows& rows) {
  GreyImage image{rows.width(), rows.height(), Values<float>(static_cast<std::size_t>(rows.count())), 0, 32};
  for (int y = 0; y < rows.height(); ++y) rows.read(0, y, rows.width(), &image.at(0, y));
  return image;
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
  GreyImage half = all_of(HalvedRows(SamplesInMemory(image.pixels, image.width, image.height)));
  half.pitch_mm = 2 * image.pitch_mm;
  return half;
}

Shrunk shrunk(const SampleRows& picture, int most_side) {
  std::vector<std::unique_ptr<HalvedRows>> levels;
  const SampleRows* finest = &picture;
  while (std::max(finest->width(), finest->height()) > most_side) {
    levels.push_back(std::make_unique<HalvedRows>(*finest));
    finest = levels.back().get();
  }
  return {all_of(*finest), static_cast<int>(levels.size())};
}

Shrunk shrunk(const GreyImage& image, int most_side) {
  Shrunk result = shrunk(SamplesInMemory(image.pixels, image.width, image.height), most_side);
  result.image.pitch_mm = std::ldexp(image.pitch_mm, result.halvings);
  if (result.halvings == 0) result.image.bits = image.bits;
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
