// SPDX-License-Identifier: MIT
#include "surface_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace papilla::texture_detail {
namespace {

std::vector<SpectrumCell> some_cells() {
  std::vector<SpectrumCell> cells;
  for (const auto& [x, y] : {std::pair{0.01, 0.004}, {0.13, 0.02}, {0.3, 0.3}, {0.5, 0.11}, {0.49, 0.5}}) {
    SpectrumCell cell;
    cell.fx = x;
    cell.fy = y;
    cells.push_back(cell);
  }
  return cells;
}

/// The sum over frequencies that look alike, term by term up to ±reach, the rest as the integral over the plane
/// outside of the circle of the same area (sharp spectra only).
double summed(double fx, double fy, double hurst, double spread_squared, bool pixel, int reach) {
  const auto sinc = [](double k) {
    return std::abs(k) < 1e-12 ? 1 : std::sin(std::numbers::pi * k) / (std::numbers::pi * k);
  };
  double sum = 0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const double x = fx + i, y = fy + j, squared = x * x + y * y;
      double value =
          std::pow(squared, -1 - hurst) * std::exp(-4 * std::numbers::pi * std::numbers::pi * spread_squared * squared);
      if (pixel) value *= std::pow(sinc(x) * sinc(y), 2);
      sum += value;
    }
  if (spread_squared > 0 || pixel) return sum;
  const int steps = 2000;
  for (int k = 0; k < steps; ++k) {
    const double angle = (k + 0.5) / steps * std::numbers::pi / 4, edge = (reach + 0.5) / std::cos(angle);
    sum += 2 * std::numbers::pi / steps * std::pow(edge, -2 * hurst) / (2 * hurst);
  }
  return sum;
}

TEST(SurfaceSpectrum, IsTheSumOverAliases) {
  const std::vector<SpectrumCell> cells = some_cells();
  const SurfaceSpectrumModel model(cells);
  SurfaceSpectrum found;
  for (const double hurst : {0.1, 0.45, 0.9})
    for (const double spread : {0.0, 0.01, 0.05, 0.4}) {
      model.evaluate(PointSpread::optical, hurst, spread, found);
      for (std::size_t c = 0; c < cells.size(); ++c)
        EXPECT_NEAR(found.power[c] / summed(cells[c].fx, cells[c].fy, hurst, spread, false, 100), 1, 5e-4)
            << "H " << hurst << " spread " << spread << " cell " << c;
      model.evaluate(PointSpread::pixel, hurst, spread, found);
      for (std::size_t c = 0; c < cells.size(); ++c)
        EXPECT_NEAR(found.power[c] / summed(cells[c].fx, cells[c].fy, hurst, spread, true, 100), 1, 1e-2);
      if (spread > 0) continue;
      model.evaluate(PointSpread::kernel, hurst, 0, found);
      for (std::size_t c = 0; c < cells.size(); ++c)
        EXPECT_NEAR(found.power[c] / summed(cells[c].fx, cells[c].fy, hurst, 0, false, 100), 1, 5e-4);
    }
}

TEST(SurfaceSpectrum, KernelIsTheTransformOfTheSampledGaussian) {
  const std::vector<SpectrumCell> cells = some_cells();
  const SurfaceSpectrumModel model(cells);
  SurfaceSpectrum sharp, found;
  model.evaluate(PointSpread::kernel, 0.5, 0, sharp);
  for (const double spread : {0.2, 0.29, 0.31, 1.5}) {
    model.evaluate(PointSpread::kernel, 0.5, spread, found);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto transfer = [&](double f) {
        double sum = 0, all = 0;
        for (int n = -40; n <= 40; ++n) {
          const double g = std::exp(-n * n / (2 * spread));
          sum += g * std::cos(2 * std::numbers::pi * f * n);
          all += g;
        }
        return sum / all;
      };
      const double expected = std::pow(transfer(cells[c].fx) * transfer(cells[c].fy), 2);
      EXPECT_NEAR(std::log(found.power[c] / sharp.power[c]), std::log(expected), 1e-2) << spread << " cell " << c;
    }
  }
}

TEST(SurfaceSpectrum, DerivativesAreThoseOfItsValues) {
  const std::vector<SpectrumCell> cells = some_cells();
  const SurfaceSpectrumModel model(cells);
  SurfaceSpectrum here, more, less;
  constexpr double k_step = 1e-5;
  for (const PointSpread spread : {PointSpread::optical, PointSpread::pixel, PointSpread::kernel, PointSpread::filtered,
                                   PointSpread::band_limited})
    for (const double squared : {0.02, 0.25, 0.9}) {
      model.evaluate(spread, 0.6, squared, here);
      model.evaluate(spread, 0.6 + k_step, squared, more);
      model.evaluate(spread, 0.6 - k_step, squared, less);
      for (std::size_t c = 0; c < cells.size(); ++c)
        EXPECT_NEAR(here.by_hurst[c], std::log(more.power[c] / less.power[c]) / (2 * k_step), 1e-3);
      model.evaluate(spread, 0.6, squared + k_step, more);
      model.evaluate(spread, 0.6, squared - k_step, less);
      for (std::size_t c = 0; c < cells.size(); ++c) {
        const double slope = std::log(more.power[c] / less.power[c]) / (2 * k_step);
        EXPECT_NEAR(here.by_spread[c], slope, 1e-3 * (1 + std::abs(slope)));
      }
    }
}

}  // namespace
}  // namespace papilla::texture_detail
