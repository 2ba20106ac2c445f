// SPDX-License-Identifier: MIT
#include "rest_shape.hpp"

#include "chunks.hpp"

namespace papilla::param_detail {
namespace {

/// Of the mean edge.
constexpr double k_least_edge = 1e-6;

}  // namespace

double least_edge(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  const double sum = sum_over(triangles.size(), [&](std::size_t t) {
    const auto [a, b, c] = triangles[t];
    return norm(positions[b] - positions[a]) + norm(positions[c] - positions[b]) + norm(positions[a] - positions[c]);
  });
  return sum > 0 ? k_least_edge * sum / static_cast<double>(3 * triangles.size()) : 1.0;
}

std::vector<RestShape> rest_shapes(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                   LeastArea least_area) {
  const double least = least_edge(positions, triangles);
  std::vector<RestShape> shapes(triangles.size());
  for_chunks(shapes.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [a, b, c] = triangles[i];
      shapes[i] = rest_shape(positions[a], positions[b], positions[c], least, least_area);
    }
  });
  return shapes;
}

}  // namespace papilla::param_detail
