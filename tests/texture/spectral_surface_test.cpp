// SPDX-License-Identifier: MIT
#include "papilla/texture/spectral_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

TEST(SpectralSurface, HasRmsOneAndTilesSmoothly) {
  const HeightGrid surface = spectral_surface({128, 0.8, 8, 1e9, 3});
  double squares = 0, inside = 0, seam = 0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) squares += surface.at(x, y) * surface.at(x, y);
    for (int x = 0; x < 127; ++x) inside = std::max(inside, std::abs(surface.at(x + 1, y) - surface.at(x, y)));
    seam = std::max(seam, std::abs(surface.at(0, y) - surface.at(127, y)));
  }
  EXPECT_NEAR(squares / (128 * 128), 1, 1e-9);
  EXPECT_LE(seam, 1.2 * inside);
  EXPECT_TRUE(surface.periodic);
}

TEST(SpectralSurface, HoldsOnlyTheWavesAskedFor) {
  // One wavelength only: the surface is an eigenfunction of the Laplacian, Δz = −k² z.
  constexpr int n = 64;
  const HeightGrid surface = spectral_surface({n, 0.5, 16, 16, 1});
  for (int y = 1; y + 1 < n; ++y)
    for (int x = 1; x + 1 < n; ++x) {
      // All kept waves have 4 periods along one axis (no other pair of whole numbers has length 4).
      const double laplacian = surface.at(x - 1, y) + surface.at(x + 1, y) + surface.at(x, y - 1) +
                               surface.at(x, y + 1) - 4 * surface.at(x, y);
      EXPECT_NEAR(laplacian, -(2 - 2 * std::cos(2 * 3.14159265358979 * 4 / n)) * surface.at(x, y), 1e-9);
    }
}

/// Rough along 30 degrees, smooth across: differences over two pixels are largest near it, on the mean over seeds.
TEST(SpectralSurface, ExponentsAlongAndAcrossAnObliqueDirection) {
  constexpr int n = 128;
  double along = 0, across = 0, mirrored = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const HeightGrid surface =
        spectral_surface({.size = n, .hurst = 0.2, .seed = seed, .hurst_across = 0.9, .angle_deg = 30});
    const auto structure = [&](int dx, int dy) {
      double sum = 0;
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          sum += std::pow(surface.at((x + dx + n) % n, (y + dy + n) % n) - surface.at(x, y), 2);
      return sum;
    };
    along += structure(2, 1), across += structure(-1, 2), mirrored += structure(2, -1);
  }
  EXPECT_GT(along, 1.5 * across);
  EXPECT_GT(along, 1.1 * mirrored);
}

TEST(SpectralSurface, RefusesBadOptions) {
  EXPECT_THROW(spectral_surface({1, 0.5}), InvalidInput);
  EXPECT_THROW(spectral_surface({64, 1.0}), InvalidInput);
  EXPECT_THROW(spectral_surface({64, 0.5, 100, 1e9, 1}), InvalidInput);
}

}  // namespace
}  // namespace papilla
