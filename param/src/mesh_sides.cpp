// SPDX-License-Identifier: MIT
#include "mesh_sides.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <numeric>
#include <utility>

namespace papilla::param_detail {
namespace {

/// Numbers equal values alike, by sorting; -0 and 0 are equal.
template <class T>
std::vector<Index> number_equal(const std::vector<T>& values) {
  std::vector<Index> order(values.size()), number(values.size());
  std::iota(order.begin(), order.end(), Index{0});
  oneapi::tbb::parallel_sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (values[a] < values[b]) return true;
    return !(values[b] < values[a]) && a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    number[order[i]] = i > 0 && values[order[i]] == values[order[i - 1]] ? number[order[i - 1]] : order[i];
  return number;
}

}  // namespace

std::vector<Side> sorted_sides(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                               const std::vector<std::uint32_t>& part) {
  const std::vector<Index> position = number_equal(mesh.positions), plane = number_equal(uv.values);
  std::vector<Side> sides(3 * mesh.triangles.size());
  oneapi::tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      Side s{part.empty() ? 0 : part[t], position[mesh.triangles[t][k]], position[mesh.triangles[t][l]],
             plane[uv.indices[t][k]],    plane[uv.indices[t][l]],        static_cast<Index>(3 * t + k)};
      if (s.high < s.low) std::swap(s.low, s.high), std::swap(s.uv_low, s.uv_high);
      sides[3 * t + k] = s;
    }
  });
  oneapi::tbb::parallel_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.uv_edge() != b.uv_edge() ? a.uv_edge() < b.uv_edge() : a.corner < b.corner;
  });
  return sides;
}

}  // namespace papilla::param_detail
