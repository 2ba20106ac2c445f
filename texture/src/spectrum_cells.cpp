// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum_cells.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "fft.hpp"

namespace papilla::texture_detail {
namespace {

constexpr int k_finest_cells = 64;       // Cells per unit of frequency from 1/8 on.
constexpr double k_longest_share = 0.5;  // Of the shorter side.

/// Tukey window of a side; both slopes together take an eighth of a short side, 64 pixels of a long one.
std::vector<double> fading_window(int side) {
  std::vector<double> window(static_cast<std::size_t>(side), 1.0);
  const int slope = std::clamp(side / 16, 2, 32);
  for (int i = 0; i < slope; ++i) {
    const double value = 0.5 - 0.5 * std::cos(std::numbers::pi * (i + 0.5) / slope);
    window[static_cast<std::size_t>(i)] = window[static_cast<std::size_t>(side - 1 - i)] = value;
  }
  return window;
}

struct WindowSums {
  double squares = 0, fourths = 0;
  explicit WindowSums(const std::vector<double>& window) {
    for (const double w : window) {
      squares += w * w;
      fourths += w * w * w * w;
    }
  }
};

/// Response of the discrete second difference at frequency f.
double second_difference(double f) {
  const double s = std::sin(std::numbers::pi * f);
  return 4 * s * s;
}

void load_sharpened(const GreyImage& image, const std::vector<double>& across, const std::vector<double>& down,
                    RealFft2d& fft) {
  const int width = static_cast<int>(across.size()), height = static_cast<int>(down.size());
  double sum = 0, weights = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto z = [&](int dx, int dy) { return static_cast<double>(image.at(x + 1 + dx, y + 1 + dy)); };
      const double value = z(-1, 0) + z(1, 0) + z(0, -1) + z(0, 1) - 4 * z(0, 0);
      const double w = across[static_cast<std::size_t>(x)] * down[static_cast<std::size_t>(y)];
      fft.real(x, y) = value;
      sum += w * value;
      weights += w;
    }
  const double mean = sum / weights;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      fft.real(x, y) =
          (fft.real(x, y) - mean) * across[static_cast<std::size_t>(x)] * down[static_cast<std::size_t>(y)];
}

/// Places frequencies into cells: shells of the larger component that halve from 1/2 down, cut into squares.
class CellIndex {
 public:
  explicit CellIndex(double least) {
    for (double top = 0.5; top > least; top /= 2) ++shells_;
  }
  std::size_t size() const { return static_cast<std::size_t>(shells_) * k_squares * k_squares; }
  std::size_t of(double fx, double fy) const {
    const double larger = std::max(fx, fy);
    int shell = 0;
    double cells = k_finest_cells;
    for (double top = 0.25; larger <= top && shell + 1 < shells_; top /= 2) {
      if (++shell > 1) cells *= 2;
    }
    const auto i = std::min(static_cast<std::size_t>(fx * cells), k_squares - 1);
    const auto j = std::min(static_cast<std::size_t>(fy * cells), k_squares - 1);
    return (static_cast<std::size_t>(shell) * k_squares + j) * k_squares + i;
  }

 private:
  static constexpr std::size_t k_squares = k_finest_cells / 2;
  int shells_ = 0;
};

}  // namespace

std::vector<SpectrumCell> spectrum_cells(const GreyImage& image) {
  const int width = image.width - 2, height = image.height - 2;
  const std::vector<double> across = fading_window(width), down = fading_window(height);
  const int columns = good_fft_size(width), rows = good_fft_size(height);
  RealFft2d fft(columns, rows);
  std::fill(fft.real(), fft.real() + fft.stride() * static_cast<std::size_t>(rows), 0.0);
  load_sharpened(image, across, down, fft);
  fft.forward();

  const WindowSums x_sums(across), y_sums(down);
  // Padding makes more frequencies than are independent, the window correlates neighbours.
  const double independent = x_sums.squares * x_sums.squares * y_sums.squares * y_sums.squares /
                             (x_sums.fourths * y_sums.fourths * columns * static_cast<double>(rows));
  const double scale = 1 / (x_sums.squares * y_sums.squares);
  const double least = 1 / (k_longest_share * std::min(width, height));
  const CellIndex index(least);
  std::vector<SpectrumCell> cells(index.size());
  for (int v = 0; v < rows; ++v) {
    const double fy = std::abs(v <= rows / 2 ? v : v - rows) / static_cast<double>(rows);
    const std::size_t mirrored = v > rows / 2;
    const double response_y = second_difference(fy);
    for (int u = 0; u <= columns / 2; ++u) {
      const double fx = u / static_cast<double>(columns), squared = fx * fx + fy * fy;
      if (squared < least * least) continue;
      if ((u == 0 || 2 * u == columns) && mirrored == 1) continue;  // The conjugate of another.
      const double response = second_difference(fx) + response_y;
      const std::complex<double> value =
          fft.spectrum()[static_cast<std::size_t>(v) * fft.spectrum_width() + static_cast<std::size_t>(u)];
      // A surface's spectrum times |f|³ is nearly level within a cell.
      const double level = std::norm(value) * scale / (response * response) * squared * std::sqrt(squared);
      SpectrumCell& cell = cells[index.of(fx, fy)];
      cell.fx += fx;
      cell.fy += fy;
      cell.power[mirrored] += level;
      cell.largest[mirrored] = std::max(cell.largest[mirrored], level);
      cell.count[mirrored] += 1;
    }
  }
  std::erase_if(cells, [](const SpectrumCell& cell) { return cell.count[0] + cell.count[1] == 0; });
  for (SpectrumCell& cell : cells) {
    const double count = cell.count[0] + cell.count[1];
    cell.fx /= count;
    cell.fy /= count;
    const double level = std::pow(cell.frequency_squared(), 1.5);
    for (std::size_t k = 0; k < 2; ++k) {
      if (cell.count[k] > 0) cell.power[k] /= cell.count[k] * level;
      cell.largest[k] /= level;
      cell.count[k] *= independent;
    }
  }
  return cells;
}

}  // namespace papilla::texture_detail
