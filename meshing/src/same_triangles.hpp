// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "mesh_attributes.hpp"

namespace papilla::detail {

/// Calls visit(triangles) for every set of two or more triangles with the same three vertices, each set ascending.
/// Triangles that repeat a corner are left out. O(n) plus sorting around each vertex; deterministic.
template <class Visit>
void for_each_same_group(std::span<const Triangle> triangles, const Visit& visit) {
  struct Entry {
    Index middle, high, triangle;
    auto operator<=>(const Entry&) const = default;
  };
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  Index vertex_count = 0;
  for (const Triangle& t : triangles) vertex_count = std::max({vertex_count, t[0] + 1, t[1] + 1, t[2] + 1});
  std::vector<Index> slot(vertex_count + 1, 0);
  for (const Triangle& t : triangles)
    if (!repeats_corner(t)) ++slot[std::min({t[0], t[1], t[2]})];
  Index sum = 0;
  for (Index& value : slot) sum += std::exchange(value, sum);

  std::vector<Entry> entries(sum);
  for (Index i = 0; i < triangles.size(); ++i) {
    if (repeats_corner(triangles[i])) continue;
    const Triangle t = sorted(triangles[i]);
    entries[slot[t[0]]++] = {t[1], t[2], i};
  }
  std::vector<Index> group;
  std::size_t start = 0;
  for (Index v = 0; v < vertex_count; ++v) {
    const std::size_t end = slot[v];
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(start), entries.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t i = start; i < end;) {
      group.clear();
      std::size_t j = i;
      for (; j < end && entries[j].middle == entries[i].middle && entries[j].high == entries[i].high; ++j)
        group.push_back(entries[j].triangle);
      if (group.size() > 1) visit(std::span<const Index>(group));
      i = j;
    }
    start = end;
  }
}

}  // namespace papilla::detail
