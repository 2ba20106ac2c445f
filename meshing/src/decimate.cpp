// SPDX-License-Identifier: MIT
#include "decimate.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

#include "check_distance_input.hpp"

namespace papilla::detail {
namespace {

/// The wedges as the library wants them: single precision around the mesh's centre, so that far-off parts keep their
/// digits, and three private copies or more of every locked vertex, which it then takes as a seam crossing.
struct Prepared {
  std::vector<float> positions;
  std::vector<unsigned int> indices;
  std::vector<Index> wedge_of_copy;  ///< Of vertices beyond the wedges' own numbers.
  double largest_extent = 0;
};

Prepared prepare(const WedgeMesh& wedges, const std::vector<Index>& indices, const std::vector<std::uint8_t>& locked) {
  Prepared p;
  Bounds bounds;
  for (const Index w : indices) bounds.add(wedges.positions[wedges.position_of_wedge[w]]);
  const Vec3 centre = 0.5 * (bounds.low + bounds.high), extent = bounds.high - bounds.low;
  p.largest_extent = std::max({extent.x, extent.y, extent.z});
  const double scale = p.largest_extent > 0 ? 1 / p.largest_extent : 1;
  const auto add = [&](Index wedge) {
    const Vec3 q = scale * (wedges.positions[wedges.position_of_wedge[wedge]] - centre);
    for (const double x : {q.x, q.y, q.z}) p.positions.push_back(static_cast<float>(x));
  };
  const auto count = static_cast<Index>(wedges.position_of_wedge.size());
  p.positions.reserve(3 * std::size_t{count});
  for (Index w = 0; w < count; ++w) add(w);
  p.indices.reserve(indices.size());
  for (const Index w : indices) {
    if (locked.empty() || !locked[wedges.position_of_wedge[w]]) {
      p.indices.push_back(w);
      continue;
    }
    p.indices.push_back(count + static_cast<Index>(p.wedge_of_copy.size()));
    p.wedge_of_copy.push_back(w);
    add(w);
  }
  return p;
}

}  // namespace

std::vector<Index> decimate(const WedgeMesh& wedges, const std::vector<Index>& indices,
                            const std::vector<std::uint8_t>& locked, const DecimateOptions& options) {
  if (indices.empty()) return {};
  const Prepared p = prepare(wedges, indices, locked);
  const double relative = p.largest_extent > 0 ? options.error_mm / p.largest_extent : 0;
  const auto error = static_cast<float>(std::min(relative, 1e10));
  std::vector<unsigned int> result(indices.size());
  const std::size_t count = meshopt_simplify(
      result.data(), p.indices.data(), p.indices.size(), p.positions.data(), p.positions.size() / 3, 3 * sizeof(float),
      3 * options.target_triangles, error, options.lock_border ? unsigned{meshopt_SimplifyLockBorder} : 0u, nullptr);
  result.resize(count);
  const auto own = static_cast<Index>(wedges.position_of_wedge.size());
  for (unsigned int& v : result)
    if (v >= own) v = p.wedge_of_copy[v - own];
  return result;
}

}  // namespace papilla::detail
