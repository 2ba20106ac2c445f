// SPDX-License-Identifier: MIT
#include "texture/published_tables.hpp"

#include <future>
#include <vector>

#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/midpoint_surface.hpp"
#include "papilla/texture/probability_dimension.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/stein_surface.hpp"

namespace papilla::test {
namespace {

void remove_best_plane(HeightGrid& surface) {
  const int n = surface.size;
  const double middle = (n - 1) / 2.0;
  double mean = 0, along_x = 0, along_y = 0, square = 0;
  std::size_t i = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x, ++i) {
      mean += surface.heights[i];
      along_x += surface.heights[i] * (x - middle);
      along_y += surface.heights[i] * (y - middle);
      square += (x - middle) * (x - middle);
    }
  mean /= static_cast<double>(i);
  i = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x, ++i)
      surface.heights[i] -= mean + along_x / square * (x - middle) + along_y / square * (y - middle);
}

}  // namespace

GreyImage dimension_picture(const DimensionCell& cell, unsigned seed) {
  HeightGrid surface = brownian_surface_exact({513, 3 - cell.dimension, seed});
  remove_best_plane(surface);
  return middle_part(to_grey_image(surface, 8), cell.side_px);
}

FourDimensions measured_dimensions(const DimensionCell& cell) {
  const auto of_seed = [&cell](unsigned seed) {
    const GreyImage picture = dimension_picture(cell, seed);
    return FourDimensions{box_dimension(picture).dimension, information_dimension(picture).dimension,
                          correlation_dimension(picture).dimension, probability_dimension(picture).dimension};
  };
  std::vector<std::future<FourDimensions>> seeds;  // The surfaces take most of the time: one thread each.
  for (unsigned seed = 1; seed <= k_table_seeds; ++seed) seeds.push_back(std::async(std::launch::async, of_seed, seed));
  FourDimensions mean{};
  for (auto& seed : seeds) {
    const FourDimensions measured = seed.get();
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += measured[i] / k_table_seeds;
  }
  return mean;
}

SignatureRow measured_signature(double hurst) {
  SignatureRow mean{hurst, 0, 0};
  for (unsigned seed = 1; seed <= k_table_seeds; ++seed) {
    const HeightGrid surface = midpoint_surface({.levels = 8, .hurst = hurst, .rule = MidpointRule::cho, .seed = seed});
    const FshotSignature signature = fshot_dimension(to_grey_image(surface));
    mean.sta += signature.sta / k_table_seeds;
    mean.str += signature.str / k_table_seeds;
  }
  return mean;
}

}  // namespace papilla::test
