// SPDX-License-Identifier: GPL-3.0-or-later
// The cosine transform as a Fourier transform of the same size [Makhoul, A fast cosine transform in one and two
// dimensions, 1980], four times as fast as that of four times the size or FFTW's own. Samples are taken in the order
// 0, 2, 4 … 5, 3, 1 along both axes; with V their transform, u < width/2, v < height/2, c = e^(−iπv/2height),
// d = e^(−iπu/2width),
//   A = c d V(u, v),  B = c conj(d V(u, height − v)),
// the four coefficients of (±u, ±v) are, but for a factor, the real and imaginary parts of A + B and A − B.
#include "cosine_filter.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace papilla::texture_detail {
namespace {

std::vector<std::complex<double>> turns(int count) {
  std::vector<std::complex<double>> values;
  for (int k = 0; k <= count / 2; ++k) values.push_back(std::polar(1.0, -std::numbers::pi * k / (2.0 * count)));
  return values;
}

/// The sample that is taken as the i-th.
int taken(int i, int count) { return 2 * i < count ? 2 * i : 2 * (count - i) - 1; }

/// a · b without the standard's care for infinities.
std::complex<double> product(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

CosineFilter2d::CosineFilter2d(int width, int height)
    : width_(width), height_(height), fft_(width, height), across_(turns(width)), down_(turns(height)) {}

void CosineFilter2d::multiply(const std::vector<double>& gains) {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  const double norm = 0.5 / static_cast<double>(gains.size());
  for (std::size_t v = 0; v <= height / 2; ++v) {
    const std::size_t opposite = v == 0 ? 0 : height - v;
    std::complex<double>* const here = fft_.spectrum() + v * fft_.spectrum_width();
    std::complex<double>* const there = fft_.spectrum() + opposite * fft_.spectrum_width();
    const double *const gain = gains.data() + v * width, *const gain_there = gains.data() + opposite * width;
    const std::complex<double> c = down_[v];
    for (std::size_t u = 0; u <= width / 2; ++u) {
      const std::size_t mirrored = u == 0 ? 0 : width - u;
      const std::complex<double> d = across_[u];
      const std::complex<double> a = product(c, product(d, here[u])), b = product(c, std::conj(product(d, there[u])));
      const std::complex<double> sum = a + b, difference = a - b;
      const std::complex<double> new_sum{norm * gain[u] * sum.real(), norm * gain_there[u] * sum.imag()},
          new_difference{norm * gain_there[mirrored] * difference.real(), norm * gain[mirrored] * difference.imag()};
      // At the middle row and at v = 0 the two are one.
      there[u] = std::conj(product(d, product(std::conj(c), new_sum - new_difference)));
      here[u] = product(std::conj(d), product(std::conj(c), new_sum + new_difference));
    }
  }
}

void CosineFilter2d::apply(const std::vector<double>& field, const std::vector<double>& gains,
                           std::vector<double>& result) {
  const auto row_of = [&](auto& values, int y) {
    return values.data() + static_cast<std::size_t>(taken(y, height_)) * static_cast<std::size_t>(width_);
  };
  for (int y = 0; y < height_; ++y) {
    const double* const row = row_of(field, y);
    for (int x = 0; x < width_; ++x) fft_.real(x, y) = row[taken(x, width_)];
  }
  fft_.forward();
  multiply(gains);
  fft_.backward();
  for (int y = 0; y < height_; ++y) {
    double* const row = row_of(result, y);
    for (int x = 0; x < width_; ++x) row[taken(x, width_)] = fft_.real(x, y);
  }
}

}  // namespace papilla::texture_detail
