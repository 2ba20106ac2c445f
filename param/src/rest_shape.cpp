// SPDX-License-Identifier: MIT
#include "rest_shape.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace papilla::param_detail {
namespace {

/// Of the mean edge.
constexpr double k_least_edge = 1e-6;

/// Triangles that one thread works through at a time.
constexpr std::size_t k_together = 4096;

}  // namespace

double least_edge(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += norm(positions[t[(k + 1) % 3]] - positions[t[k]]);
  return sum > 0 ? k_least_edge * sum / static_cast<double>(3 * triangles.size()) : 1.0;
}

std::vector<RestShape> rest_shapes(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                   LeastArea least_area) {
  const double least = least_edge(positions, triangles);
  std::vector<RestShape> shapes(triangles.size());
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<std::size_t>(0, shapes.size(), k_together), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const Triangle& t = triangles[i];
          shapes[i] = rest_shape(positions[t[0]], positions[t[1]], positions[t[2]], least, least_area);
        }
      });
  return shapes;
}

}  // namespace papilla::param_detail
