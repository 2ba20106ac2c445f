// SPDX-License-Identifier: GPL-3.0-or-later
// Theiler, Eubank, Longtin, Galdrikian and Farmer, Testing for nonlinearity in time series: the method of surrogate
// data, 1992.
#include "lattice_surrogates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "checks.hpp"
#include "even_contrast.hpp"
#include "fft.hpp"
#include "papilla/texture/feature_matrix.hpp"
#include "shaped_noise.hpp"

namespace papilla::texture_detail {
namespace {

constexpr int k_angles = 36, k_radii = 72;
constexpr double k_least_frequency = 1.0 / 4096;  // Cycles per pixel.

/// Where a wave lies in the reciprocal lattice.
class ReciprocalNodes {
 public:
  ReciprocalNodes(const std::array<Vec2, 2>& vectors, int width, int height) : vectors_(vectors) {
    const double area = cross(vectors[0], vectors[1]);
    a_ = {vectors[1].y / area, -vectors[1].x / area};
    b_ = {-vectors[0].y / area, vectors[0].x / area};
    // A window of Hann spreads a wave over two of its neighbours to each side.
    const double spacing = std::min(norm(a_), norm(b_)), wave = 1.0 / std::min(width, height);
    reach_ = std::min(std::max(0.3 * spacing, 2 * wave), 0.45 * spacing);
  }
  bool holds(Vec2 k) const {
    const double m = std::round(dot(k, vectors_[0])), n = std::round(dot(k, vectors_[1]));
    return (m != 0 || n != 0) && norm(k - (m * a_ + n * b_)) < reach_;
  }

 private:
  std::array<Vec2, 2> vectors_;
  Vec2 a_, b_;
  double reach_;
};

/// Mean power per wave over a polar grid, angles over half a turn, radii in equal steps of the logarithm; without the
/// waves at the nodes of the reciprocal lattice, whose place the waves around them take.
class PolarSpectrum {
 public:
  PolarSpectrum(const GreyImage& image, const ReciprocalNodes& nodes)
      : values_(k_angles * k_radii, 0.0), counts_(values_.size(), 0.0) {
    const int w = image.width, h = image.height;
    RealFft2d fft(w, h);
    double mean = 0;
    for (const float grey : image.pixels) mean += static_cast<double>(grey) / static_cast<double>(image.pixels.size());
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        // Hann's window: without it the borders' steps would put a cross into the spectrum.
        const double window = std::sin(std::numbers::pi * (x + 0.5) / w) * std::sin(std::numbers::pi * (y + 0.5) / h);
        fft.real(x, y) = window * window * (static_cast<double>(image.at(x, y)) - mean);
      }
    fft.forward();
    for (int y = 0; y < h; ++y)
      for (int x = 0; x <= w / 2; ++x) {
        const Vec2 k{static_cast<double>(x) / w, static_cast<double>(y <= h / 2 ? y : y - h) / h};
        if ((x == 0 && y == 0) || nodes.holds(k)) continue;
        const auto [angle, radius] = place(k.x, k.y);
        const std::size_t index =
            pixel_index(static_cast<int>(std::lround(angle)) % k_angles,
                        std::clamp(static_cast<int>(std::lround(radius)), 0, k_radii - 1), k_angles);
        values_[index] +=
            std::norm(fft.spectrum()[static_cast<std::size_t>(y) * fft.spectrum_width() + static_cast<std::size_t>(x)]);
        counts_[index] += 1;
      }
    average();
  }

  /// Bilinear.
  double at(double fx, double fy) const {
    if (fx == 0 && fy == 0) return 0;
    const auto [angle, radius] = place(fx, fy);
    const double r = std::clamp(radius, 0.0, k_radii - 1.001);
    const int a0 = static_cast<int>(angle), r0 = static_cast<int>(r);
    const double u = angle - a0, v = r - r0;
    const auto value = [&](int a, int b) { return values_[pixel_index(wrapped(a, k_angles), b, k_angles)]; };
    return (1 - v) * ((1 - u) * value(a0, r0) + u * value(a0 + 1, r0)) +
           v * ((1 - u) * value(a0, r0 + 1) + u * value(a0 + 1, r0 + 1));
  }

 private:
  struct Place {
    double angle, radius;
  };
  static Place place(double fx, double fy) {
    double angle = std::atan2(fy, fx) / std::numbers::pi;
    if (angle < 0) angle += 1;
    const double top = std::log(std::numbers::sqrt2 / 2 / k_least_frequency);
    return {angle * k_angles, std::log(std::hypot(fx, fy) / k_least_frequency) / top * (k_radii - 1)};
  }
  /// Sums into means over as many neighbours along the circle, and later across it, as hold enough waves.
  void average() {
    constexpr double k_enough = 8;
    std::vector<double> means(values_.size(), 0.0);
    for (int r = 0; r < k_radii; ++r)
      for (int a = 0; a < k_angles; ++a)
        for (int reach = 1; reach <= k_angles / 2; ++reach) {
          const int across = std::max(0, reach / 3 - 1);
          double sum = 0, count = 0;
          for (int j = std::max(0, r - across); j <= std::min(k_radii - 1, r + across); ++j)
            for (int i = -reach; i <= reach; ++i) {
              const std::size_t index = pixel_index(wrapped(a + i, k_angles), j, k_angles);
              sum += values_[index];
              count += counts_[index];
            }
          if (count < k_enough && reach < k_angles / 2) continue;
          means[pixel_index(a, r, k_angles)] = count > 0 ? sum / count : 0;
          break;
        }
    values_ = std::move(means);
  }

  std::vector<double> values_, counts_;
};

}  // namespace

double false_alarm_probability(const GreyImage& image, const Lattice& lattice, const LatticeOptions& options,
                               double rate) {
  if (!lattice.found) return 1;
  constexpr int k_most_side = 256, k_first = 5, k_most = 39;
  constexpr double k_cells_across = 8, k_least_scatter = 0.2;
  const double area = std::abs(cross(lattice.vectors_px[0], lattice.vectors_px[1]));
  const double cells = static_cast<double>(image.pixels.size()) / area;
  const double longest = std::max(norm(lattice.vectors_px[0]), norm(lattice.vectors_px[1]));
  // Surrogate pixels are `step` pixels wide.
  const double step = std::max(1.0, longest * k_cells_across / k_most_side);
  const int width = std::clamp(static_cast<int>(image.width / step), 16, k_most_side),
            height = std::clamp(static_cast<int>(image.height / step), 16, k_most_side);
  const PolarSpectrum spectrum(image, ReciprocalNodes(lattice.vectors_px, image.width, image.height));
  LatticeOptions any = options;
  any.least_significance = 1e-9;
  double sum = 0, p = 1;
  for (int k = 1; k <= k_most; ++k) {
    const std::vector<double> noise =
        shaped_noise(width, height, static_cast<std::uint64_t>(k),
                     [&](double fx, double fy) { return std::sqrt(std::max(0.0, spectrum.at(fx / step, fy / step))); });
    GreyImage surrogate{width, height, {}, 0, 32};
    for (const double value : noise) surrogate.pixels.push_back(static_cast<float>(0.5 + 0.1 * value));
    const Lattice found = find_lattice(feature_matrix(with_even_light(surrogate)), any);
    if (found.found) sum += found.significance;
    const double mean = std::max(k_least_scatter / std::sqrt(cells), sum / k);
    p = std::exp(-lattice.significance / mean);
    if (k >= k_first && (p < rate * rate || p > 10 * rate)) break;
  }
  return p;
}

}  // namespace papilla::texture_detail
