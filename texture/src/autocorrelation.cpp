// SPDX-License-Identifier: GPL-3.0-or-later
#include "autocorrelation.hpp"

#include <algorithm>
#include <complex>

#include "checks.hpp"
#include "fft.hpp"

namespace papilla::texture_detail {
namespace {

constexpr int k_columns =
    8;  // Transformed at a time: whole cache lines of the rows, and little enough to stay in cache.

/// Replaces every column of the spectra in `rows` by the backward transform of its power; rows 0…last_row only.
void correlate_columns(RealFftRows& rows, int height, int fft_height, int last_row) {
  const int columns = static_cast<int>(rows.spectrum_width());
  ComplexFftBatch batch(fft_height, k_columns);
  for (int first = 0; first < columns; first += k_columns) {
    const int count = std::min(k_columns, columns - first);
    // What is left from the columns before would add its rounding errors to those that share its transform.
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
    batch.backward_half();
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

}  // namespace

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

}  // namespace papilla::texture_detail
