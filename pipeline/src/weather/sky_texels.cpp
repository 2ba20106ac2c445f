// SPDX-License-Identifier: MIT
#include "weather/sky_texels.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/units.hpp"
#include "placed_meshes.hpp"

namespace papilla {
namespace {

constexpr int k_block = 8;

/// The covered texel of a block that is nearest to its middle, or -1.
std::ptrdiff_t middle_of(const SurfaceTexels& texels, int column, int row) {
  std::ptrdiff_t best = -1;
  double least = 1e30;
  for (int y = row * k_block; y < std::min((row + 1) * k_block, texels.height); ++y)
    for (int x = column * k_block; x < std::min((column + 1) * k_block, texels.width); ++x) {
      const std::size_t at = texels.at(texels.left + x, texels.top + y);
      const double dx = x + 0.5 - (column + 0.5) * k_block, dy = y + 0.5 - (row + 0.5) * k_block;
      if (!texels.covered[at] || dx * dx + dy * dy >= least) continue;
      least = dx * dx + dy * dy;
      best = static_cast<std::ptrdiff_t>(at);
    }
  return best;
}

Vec3 vector_at(const std::vector<float>& values, std::ptrdiff_t at) {
  const auto k = static_cast<std::size_t>(3 * at);
  return {static_cast<double>(values[k]), static_cast<double>(values[k + 1]), static_cast<double>(values[k + 2])};
}

}  // namespace

SkyView sky_of(const Scene& scene, std::span<const Instance> all, int rays) {
  std::vector<PlacedMesh> parts = placed_meshes(scene, all, to_y_up(scene.up));
  for (PlacedMesh& part : parts) part.opaque = true;  // Glass keeps snow and dust off as well.
  SkyOptions options;
  options.rays = static_cast<std::uint32_t>(rays);
  return SkyView(parts, options);
}

std::vector<float> sky_texels(const SurfaceTexels& texels, const SkyView& sky) {
  const int columns = (texels.width + k_block - 1) / k_block, rows = (texels.height + k_block - 1) / k_block;
  std::vector<float> blocks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), -1);
  const auto block = [&](int column, int row) -> float& {
    return blocks[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  };
  oneapi::tbb::parallel_for(0, rows, [&](int row) {
    for (int column = 0; column < columns; ++column)
      if (const std::ptrdiff_t at = middle_of(texels, column, row); at >= 0)
        block(column, row) =
            static_cast<float>(sky(k_mm_per_metre * vector_at(texels.positions, at), vector_at(texels.normals, at)));
  });
  std::vector<float> out(texels.count(), 0);
  oneapi::tbb::parallel_for(0, texels.height, [&](int y) {
    const double v = (y + 0.5) / k_block - 0.5;
    for (int x = 0; x < texels.width; ++x) {
      const std::size_t at = texels.at(texels.left + x, texels.top + y);
      if (!texels.covered[at]) continue;
      const double u = (x + 0.5) / k_block - 0.5;
      double sum = 0, weight = 0;
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const int column = static_cast<int>(std::floor(u)) + i, row = static_cast<int>(std::floor(v)) + j;
          if (column < 0 || row < 0 || column >= columns || row >= rows || block(column, row) < 0) continue;
          const double share = (1 - std::abs(u - column)) * (1 - std::abs(v - row));
          sum += share * static_cast<double>(block(column, row));
          weight += share;
        }
      out[at] = static_cast<float>(sum / weight);
    }
  });
  return out;
}

}  // namespace papilla
