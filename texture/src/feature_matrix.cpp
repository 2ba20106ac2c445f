// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/feature_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "checks.hpp"
#include "fft.hpp"

namespace papilla {
namespace {

using texture_detail::pixel_index;
using texture_detail::RealFft2d;

/// The picture's values minus about their mean; integers in grey steps for 8-bit pictures.
struct Centred {
  std::vector<double> values;
  double unit = 1;        ///< Grey value of one step.
  bool integers = false;  ///< All values are whole numbers of at most 255 steps.
};

Centred centred(const GreyImage& image) {
  Centred result;
  result.integers = image.bits == 8 && std::all_of(image.pixels.begin(), image.pixels.end(), [](float v) {
                      return std::abs(255 * static_cast<double>(v) - std::round(255 * static_cast<double>(v))) < 1e-4;
                    });
  result.unit = result.integers ? 1.0 / 255 : 1;
  result.values.reserve(image.pixels.size());
  double sum = 0;
  for (const float grey : image.pixels) {
    const double value = static_cast<double>(grey);
    result.values.push_back(result.integers ? std::round(255 * value) : value);
    sum += result.values.back();
  }
  double mean = sum / static_cast<double>(result.values.size());
  if (result.integers) mean = std::round(mean);
  for (double& value : result.values) value -= mean;
  return result;
}

/// Sums of squares over rectangles [x0, x1) × [y0, y1).
class SquareSums {
 public:
  SquareSums(const std::vector<double>& values, int width, int height)
      : stride_(width + 1), table_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 1), 0) {
    for (int y = 0; y < height; ++y) {
      double row = 0;
      for (int x = 0; x < width; ++x) {
        const double value = values[pixel_index(x, y, width)];
        row += value * value;
        table_[pixel_index(x + 1, y + 1, stride_)] = table_[pixel_index(x + 1, y, stride_)] + row;
      }
    }
  }
  double operator()(int x0, int y0, int x1, int y1) const {
    return table_[pixel_index(x1, y1, stride_)] - table_[pixel_index(x0, y1, stride_)] -
           table_[pixel_index(x1, y0, stride_)] + table_[pixel_index(x0, y0, stride_)];
  }

 private:
  int stride_;
  std::vector<double> table_;
};

/// Leaves Σ_x I(x) I(x + t), not yet divided by the FFT's size, in fft.real(t mod size).
void autocorrelate(RealFft2d& fft, const Centred& picture, int width, int height, int fft_height) {
  std::fill_n(fft.real(), fft.stride() * static_cast<std::size_t>(fft_height), 0.0);
  for (int y = 0; y < height; ++y)
    std::copy_n(picture.values.data() + pixel_index(0, y, width), width, &fft.real(0, y));
  fft.forward();
  std::complex<double>* spectrum = fft.spectrum();
  const std::size_t count = fft.spectrum_width() * static_cast<std::size_t>(fft_height);
  for (std::size_t i = 0; i < count; ++i) spectrum[i] = std::norm(spectrum[i]);
  fft.backward();
}

}  // namespace

FeatureMatrix feature_matrix(const GreyImage& image) {
  texture_detail::require_image(image, "feature_matrix");
  const int w = image.width, h = image.height;
  FeatureMatrix matrix{w / 2, h / 2, {}};
  matrix.distortion.resize(static_cast<std::size_t>(matrix.width()) * static_cast<std::size_t>(matrix.height()));

  const Centred picture = centred(image);
  // Wrap-around of the cyclic correlation reaches only shifts beyond size − w.
  const int fft_width = texture_detail::good_fft_size(w + matrix.reach_x);
  const int fft_height = texture_detail::good_fft_size(h + matrix.reach_y);
  RealFft2d fft(fft_width, fft_height);
  autocorrelate(fft, picture, w, h, fft_height);
  const SquareSums squares(picture.values, w, h);

  const double unfft = 1 / (static_cast<double>(fft_width) * fft_height), unit = picture.unit * picture.unit;
  for (int dy = 0; dy <= matrix.reach_y; ++dy)
    for (int dx = -matrix.reach_x; dx <= matrix.reach_x; ++dx) {
      const int left = std::max(0, -dx), right = std::min(w, w - dx);
      const double here = squares(left, 0, right, h - dy), there = squares(left + dx, dy, right + dx, h);
      const double product = unfft * fft.real(texture_detail::wrapped(dx, fft_width), dy);
      double numerator = std::max(0.0, here + there - 2 * product);
      if (picture.integers) numerator = std::round(numerator);
      const double overlap = static_cast<double>(right - left) * (h - dy);
      const double value = dx == 0 && dy == 0 ? 0 : unit * numerator / overlap;
      const auto centre = pixel_index(matrix.reach_x, matrix.reach_y, matrix.width());
      const auto offset = static_cast<std::ptrdiff_t>(dy) * matrix.width() + dx;
      matrix.distortion[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(centre) + offset)] = value;
      matrix.distortion[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(centre) - offset)] = value;
    }
  return matrix;
}

}  // namespace papilla
