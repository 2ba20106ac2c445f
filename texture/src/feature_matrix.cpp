// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/feature_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "checks.hpp"
#include "fft.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

/// Columns transformed at a time: whole cache lines of the rows, and few enough to stay in the cache.
constexpr int k_columns = 8;

/// Replaces every column of the spectra in `rows` by the backward transform of its power; rows 0…last_row only.
void correlate_columns(RealFftRows& rows, int height, int fft_height, int last_row) {
  const int columns = static_cast<int>(rows.spectrum_width());
  ComplexFftBatch batch(fft_height, k_columns);
  for (int first = 0; first < columns; first += k_columns) {
    const int count = std::min(k_columns, columns - first);
    // Values left over from earlier columns would add rounding errors to the column that shares their transform.
    for (int c = 0; c < k_columns; ++c) {
      const int used = c < count ? height : 0;
      std::fill_n(batch.data(c) + used, fft_height - used, std::complex<double>());
    }
    for (int y = 0; y < height; ++y) {
      const std::complex<double>* row = rows.spectrum(y) + first;
      for (int c = 0; c < count; ++c) batch.data(c)[y] = row[c];
    }
    batch.forward();
    // The power is real: two columns share one transform, as its real and its imaginary part.
    for (int c = 0; c < k_columns; c += 2) {
      const std::complex<double>*a = batch.data(c), *b = batch.data(c + 1);
      std::complex<double>* both = batch.data(c / 2);
      for (int y = 0; y < fft_height; ++y) both[y] = {std::norm(a[y]), std::norm(b[y])};
    }
    batch.backward();
    for (int y = 0; y <= last_row; ++y) {
      std::complex<double>* row = rows.spectrum(y) + first;
      for (int c = 0; c < count; c += 2) {
        const std::complex<double> there = batch.data(c / 2)[y],
                                   back = std::conj(batch.data(c / 2)[y == 0 ? 0 : fft_height - y]);
        row[c] = 0.5 * (there + back);
        if (c + 1 < count) row[c + 1] = std::complex(0.0, -0.5) * (there - back);
      }
    }
  }
}

/// R(t) = Σ_x I(x) I(x + t) over the overlap, for |dx| ≤ reach_x and 0 ≤ dy ≤ reach_y: row dy holds dx = −reach_x …
/// reach_x. Two zero-padded Fourier transforms; rows that are zero before or not asked for after are left out, and the
/// columns are transformed there and back while they are in the cache.
/// @param values width × height values, best with a mean near 0.
std::vector<double> autocorrelation(const std::vector<double>& values, int width, int height, int reach_x,
                                    int reach_y) {
  // Wrap-around of the cyclic correlation reaches only shifts beyond size − width.
  const int fft_width = good_fft_size(width + reach_x), fft_height = good_fft_size(height + reach_y);
  RealFftRows rows(fft_width, height, reach_y + 1);
  for (int y = 0; y < height; ++y) {
    std::copy_n(values.data() + pixel_index(0, y, width), width, rows.real(y));
    std::fill_n(rows.real(y) + width, fft_width - width, 0.0);
  }
  rows.forward();
  correlate_columns(rows, height, fft_height, reach_y);
  rows.backward();
  const double norm = 1 / (static_cast<double>(fft_width) * fft_height);
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(2 * reach_x + 1) * static_cast<std::size_t>(reach_y + 1));
  for (int dy = 0; dy <= reach_y; ++dy) {
    const double* row = rows.real(dy);
    for (int dx = -reach_x; dx < 0; ++dx) result.push_back(norm * row[fft_width + dx]);
    for (int dx = 0; dx <= reach_x; ++dx) result.push_back(norm * row[dx]);
  }
  return result;
}

/// Nearest whole number of a value ≥ 0 below 2^62; std::round is a call for each.
double rounded(double value) { return static_cast<double>(static_cast<std::int64_t>(value + 0.5)); }

/// The picture's values minus about their mean; integers in grey steps for 8-bit pictures.
struct Centred {
  std::vector<double> values;
  double unit = 1;        ///< Grey value of one step.
  bool integers = false;  ///< All values are whole numbers of at most 255 steps.
};

Centred centred(const GreyImage& image) {
  Centred result;
  const std::vector<std::uint8_t> steps = image.bits == 8 ? whole_bytes(image) : std::vector<std::uint8_t>();
  result.integers = !steps.empty();
  if (result.integers) {
    result.unit = 1.0 / 255;
    result.values.assign(steps.begin(), steps.end());
  } else {
    result.values.assign(image.pixels.begin(), image.pixels.end());
  }
  double sum = 0;
  for (const double value : result.values) sum += value;
  double mean = sum / static_cast<double>(result.values.size());
  if (result.integers) mean = rounded(mean);
  for (double& value : result.values) value -= mean;
  return result;
}

/// Prefix sums of the squares: entry (x, y) is the sum over [0, x) × [0, y).
std::vector<double> square_sums(const std::vector<double>& values, int width, int height) {
  const int stride = width + 1;
  std::vector<double> table(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height + 1), 0);
  for (int y = 0; y < height; ++y) {
    double row = 0;
    const double* value = values.data() + pixel_index(0, y, width);
    const double* above = table.data() + pixel_index(1, y, stride);
    double* here = table.data() + pixel_index(1, y + 1, stride);
    for (int x = 0; x < width; ++x) {
      row += value[x] * value[x];
      here[x] = above[x] + row;
    }
  }
  return table;
}

}  // namespace

FeatureMatrix feature_matrix(const GreyImage& image) {
  require_image(image, "feature_matrix");
  const int w = image.width, h = image.height;
  FeatureMatrix matrix{w / 2, h / 2, {}};
  matrix.distortion.resize(static_cast<std::size_t>(matrix.width()) * static_cast<std::size_t>(matrix.height()));

  const Centred picture = centred(image);
  const std::vector<double> products = autocorrelation(picture.values, w, h, matrix.reach_x, matrix.reach_y);
  const std::vector<double> squares = square_sums(picture.values, w, h);
  const double unit = picture.unit * picture.unit;
  const auto columns = static_cast<std::ptrdiff_t>(matrix.width());
  double* centre = matrix.distortion.data() + pixel_index(matrix.reach_x, matrix.reach_y, matrix.width());
  for (int dy = 0; dy <= matrix.reach_y; ++dy) {
    const double* top = squares.data() + pixel_index(0, h - dy, w + 1);  // Rows [0, h − dy).
    const double* cut = squares.data() + pixel_index(0, dy, w + 1);      // Rows [0, dy), left out below.
    const double* all = squares.data() + pixel_index(0, h, w + 1);
    const double* product = products.data() + pixel_index(matrix.reach_x, dy, matrix.width());
    double *below = centre + dy * columns, *above = centre - dy * columns;
    for (int dx = -matrix.reach_x; dx <= matrix.reach_x; ++dx) {
      const int left = std::max(0, -dx), right = std::min(w, w - dx);
      const double here = top[right] - top[left];
      const double there = all[right + dx] - cut[right + dx] - all[left + dx] + cut[left + dx];
      double numerator = std::max(0.0, here + there - 2 * product[dx]);
      if (picture.integers) numerator = rounded(numerator);
      const double value = unit * numerator / (static_cast<double>(right - left) * (h - dy));
      below[dx] = value;
      above[-dx] = value;
    }
  }
  *centre = 0;
  return matrix;
}

}  // namespace papilla
