// SPDX-License-Identifier: MIT
#include "papilla/texture/probability_dimension.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "checks.hpp"
#include "line_fit.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

// The running counts C(y, z, x) = #{y' ≤ y : g(x, y') ≤ z} are kept modulo 256: a window has at most
// 33 rows, so the difference of two of them is exact. The cube around (x, y, g) of radius r then holds
//   m = Σ_{|x'−x| ≤ r} [C(y+r, g+r) − C(y−r−1, g+r) − C(y+r, g−r−1) + C(y−r−1, g−r−1)](x').
constexpr int k_most_side = 33;
constexpr int k_levels = 256;
constexpr int k_padding = 16;      // sum_window() reads whole blocks of 16 bytes.
constexpr int k_strip_width = 96;  // Centres a strip: all tables of a strip stay within 1 MB of cache.
constexpr int k_kept_rows = k_most_side + 1;

/// Σ over `side` entries of (a − b − c + d) mod 256, each of which is a count below 256.
#if defined(__SSE2__)
int sum_window(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, const std::uint8_t* d, int side) {
  alignas(16) static constexpr std::uint8_t k_masks[32] = {255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
                                                           255, 255, 255, 255, 255, 0,   0,   0,   0,   0,   0,
                                                           0,   0,   0,   0,   0,   0,   0,   0,   0,   0};
  const auto load = [](const std::uint8_t* p) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); };
  const auto difference = [&](int i) {
    return _mm_add_epi8(_mm_sub_epi8(load(a + i), load(b + i)), _mm_sub_epi8(load(d + i), load(c + i)));
  };
  const __m128i zero = _mm_setzero_si128();
  __m128i sum = zero;
  int i = 0;
  for (; i + 16 <= side; i += 16) sum = _mm_add_epi64(sum, _mm_sad_epu8(difference(i), zero));
  if (i < side) {
    const __m128i rest = _mm_and_si128(difference(i), load(k_masks + 16 - (side - i)));
    sum = _mm_add_epi64(sum, _mm_sad_epu8(rest, zero));
  }
  return _mm_cvtsi128_si32(sum) + _mm_cvtsi128_si32(_mm_srli_si128(sum, 8));
}
#else
int sum_window(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, const std::uint8_t* d, int side) {
  int sum = 0;
  for (int i = 0; i < side; ++i) sum += static_cast<std::uint8_t>(a[i] - b[i] - c[i] + d[i]);
  return sum;
}
#endif

/// Running counts of the columns [first, first + columns) for the last k_kept_rows rows.
class RunningCounts {
 public:
  RunningCounts(const std::vector<std::uint8_t>& bytes, int picture_width, int first, int columns)
      : bytes_(bytes),
        picture_width_(picture_width),
        first_(first),
        columns_(columns),
        stride_(static_cast<std::size_t>(columns + k_padding)),
        zeros_(stride_, 0),
        table_(static_cast<std::size_t>(k_kept_rows) * k_levels * stride_, 0) {}

  /// Adds row y of the picture; rows come in order from 0 on.
  void add_row(int y) {
    const std::uint8_t* grey = bytes_.data() + texture_detail::pixel_index(first_, y, picture_width_);
    for (int z = 0; z < k_levels; ++z) {
      const std::uint8_t* before = table_.data() + offset(y - 1, z);
      std::uint8_t* now = table_.data() + offset(y, z);
      const auto threshold = static_cast<std::uint8_t>(z);
      for (int x = 0; x < columns_; ++x)
        now[x] = static_cast<std::uint8_t>(before[x] + static_cast<std::uint8_t>(grey[x] <= threshold));
    }
  }

  /// The counts of rows 0…y with g ≤ z, one a column; level −1 and row −1 are empty, levels above 255 are 255.
  const std::uint8_t* counts(int y, int z) const {
    return z < 0 ? zeros_.data() : table_.data() + offset(y, std::min(z, k_levels - 1));
  }

 private:
  /// Row −1 shares the slot of row k_kept_rows − 1, which is still zero when row 0 is added.
  std::size_t offset(int y, int z) const {
    const auto slot = static_cast<std::size_t>((y + k_kept_rows) % k_kept_rows);
    return (slot * k_levels + static_cast<std::size_t>(z)) * stride_;
  }

  const std::vector<std::uint8_t>& bytes_;
  int picture_width_, first_, columns_;
  std::size_t stride_;
  std::vector<std::uint8_t> zeros_, table_;
};

struct Job {
  std::vector<std::uint8_t> bytes;
  int width = 0, height = 0;
  ProbabilityOptions options;
};

std::vector<CubeHistogram> empty_histograms(const ProbabilityOptions& options) {
  std::vector<CubeHistogram> histograms;
  for (int side = options.least_side; side <= options.most_side; side += 2)
    histograms.push_back({side, std::vector<std::int64_t>(static_cast<std::size_t>(side * side + 1), 0)});
  return histograms;
}

/// Adds the cubes around row y, columns [begin, end), of one side; the rows up to y + radius are in `running`.
void count_row(const Job& job, const RunningCounts& running, int first_column, int begin, int end, int y,
               CubeHistogram& histogram) {
  const int radius = (histogram.side - 1) / 2;
  begin = std::max(begin, radius);
  end = std::min(end, job.width - radius);
  const std::uint8_t* grey = job.bytes.data() + texture_detail::pixel_index(0, y, job.width);
  for (int x = begin; x < end; ++x) {
    const int left = x - radius - first_column, high = grey[x] + radius, low = grey[x] - radius - 1;
    const int points =
        sum_window(running.counts(y + radius, high) + left, running.counts(y - radius - 1, high) + left,
                   running.counts(y + radius, low) + left, running.counts(y - radius - 1, low) + left, histogram.side);
    ++histogram.counts[static_cast<std::size_t>(points)];
  }
}

/// Counts all centres in the columns [begin, end).
std::vector<CubeHistogram> count_strip(const Job& job, int begin, int end) {
  const int reach = (job.options.most_side - 1) / 2;
  const int first = std::max(0, begin - reach), last = std::min(job.width, end + reach);
  RunningCounts running(job.bytes, job.width, first, last - first);
  std::vector<CubeHistogram> histograms = empty_histograms(job.options);
  for (int row = 0; row < job.height; ++row) {
    running.add_row(row);
    for (CubeHistogram& histogram : histograms) {
      const int radius = (histogram.side - 1) / 2;
      if (row >= 2 * radius) count_row(job, running, first, begin, end, row - radius, histogram);
    }
  }
  return histograms;
}

void require_options(const ProbabilityOptions& options) {
  const bool odd = options.least_side % 2 == 1 && options.most_side % 2 == 1;
  if (!odd || options.least_side < 3 || options.most_side > k_most_side || options.most_side < options.least_side + 4)
    throw InvalidInput("probability_dimension: sides " + std::to_string(options.least_side) + " to " +
                       std::to_string(options.most_side) + " are not three or more odd numbers within 3 to 33");
}

}  // namespace

std::vector<CubeHistogram> cube_histograms(const GreyImage& image, const ProbabilityOptions& options) {
  require_options(options);
  texture_detail::require_image(image, "probability_dimension", 2 * options.most_side);
  const Job job{texture_detail::stretched_bytes(image), image.width, image.height, options};
  std::vector<CubeHistogram> total = empty_histograms(options);
  std::mutex guard;
  const int strips = (job.width + k_strip_width - 1) / k_strip_width;
  oneapi::tbb::parallel_for(0, strips, [&](int strip) {
    const int begin = strip * k_strip_width;
    const std::vector<CubeHistogram> part = count_strip(job, begin, std::min(job.width, begin + k_strip_width));
    const std::scoped_lock lock(guard);  // Integer sums: the order does not matter.
    for (std::size_t i = 0; i < part.size(); ++i)
      std::transform(part[i].counts.begin(), part[i].counts.end(), total[i].counts.begin(), total[i].counts.begin(),
                     [](std::int64_t a, std::int64_t b) { return a + b; });
  });
  return total;
}

FractalEstimate probability_dimension(const GreyImage& image, const ProbabilityOptions& options) {
  std::vector<ScalePoint> curve;
  for (const CubeHistogram& histogram : cube_histograms(image, options)) {
    double centres = 0, sum = 0;
    for (std::size_t m = 1; m < histogram.counts.size(); ++m) {
      const auto count = static_cast<double>(histogram.counts[m]);
      centres += count;
      sum += count / static_cast<double>(m);
    }
    curve.push_back({static_cast<double>(histogram.side), sum / centres});
  }
  return texture_detail::estimate_from_log_log(std::move(curve));
}

}  // namespace papilla
