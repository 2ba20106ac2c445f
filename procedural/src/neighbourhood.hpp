// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "node.hpp"

namespace papilla::procedural_detail {

/// A picture whose texels know their neighbours.
struct NearRaster {
  int width = 0, height = 0;
  bool repeats = false;  ///< The left neighbour of the first column is the last one, and so on.
  std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// A statistic of the known values within `radius` texels of every texel, the texel itself included.
///
/// mean, least, most: of the values. deviation: sqrt(mean of v^2 - mean^2). slope: length of the gradient of the plane
/// that fits best, per texel. Means weigh a value at distance d by clamp(radius - d + 1/2, 0, 1) pitches of the grid.
/// A radius over 8 texels is looked at on a grid of ceil(radius / 8) texels (their mean, least or most), and
/// interpolated in between: the disc is then known to an eighth of its radius.
/// @param values  not finite where nothing is known; such texels do not count, and get 0 where nothing is near.
/// Cost: at most 230 terms a texel whatever the radius, all cores. Deterministic.
std::vector<float> near_statistic(NearStatistic kind, std::span<const float> values, const NearRaster& raster,
                                  double radius);

/// What the neighbourhood statistics of a recipe read and give, on one raster. The picture is evaluated
/// graph.deepest_near() + 1 times: the k-th time, statistics that rest on k others write down what they read.
class Neighbourhoods {
 public:
  Neighbourhoods(const Graph& graph, const NearRaster& raster);
  /// @returns false after the last time.
  bool next();
  /// One statistic at n texels: writes `in` down or gives what was found. Threads may call it for unlike texels.
  void exchange(int request, const std::uint32_t* texels, int n, double texel, const double* in, double* out);

 private:
  struct Request {
    std::vector<float> values, found;
    std::atomic<double> texel{0};
  };
  const Graph& graph_;
  NearRaster raster_;
  std::vector<Request> requests_;
  int pass_ = 0;
};

/// What a statistic gives where a point has no neighbours: the value itself, or 0.
void without_neighbours(NearStatistic kind, const double* in, int n, double* out);

}  // namespace papilla::procedural_detail
