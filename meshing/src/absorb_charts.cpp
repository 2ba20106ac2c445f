// SPDX-License-Identifier: MIT
#include "segmentation_steps.hpp"

#include <algorithm>
#include <numeric>

#include "seam_set.hpp"

namespace papilla::detail {
namespace {

constexpr int k_max_rounds = 8;

class Absorber {
 public:
  /// @param speck per triangle: the area up to which a chart is a speck.
  Absorber(const SegmentedMesh& surface, double small_area_fraction, const std::vector<double>& speck,
           std::vector<std::uint8_t>& seam)
      : surface_(surface), fraction_(small_area_fraction), seam_(seam), charts_(charts_between(surface, seam)) {
    speck_.resize(charts_.count);
    for (Index t = 0; t < surface.size(); ++t) speck_[chart(3 * t)] = speck[t];
    area_.assign(charts_.count, 0);
    seen_.assign(seam.size(), 0);
    size_.assign(charts_.count, 0);
    border_.resize(charts_.count);
    for (Index t = 0; t < surface.size(); ++t) {
      area_[chart(3 * t)] += surface.area[t];
      ++size_[chart(3 * t)];
    }
    for (Index h = 0; h < seam.size(); ++h)
      if (seam[h]) border_[chart(h)].push_back(h);
  }

  /// Each chart takes part in one union a round, the smallest first.
  std::size_t run() {
    std::vector<std::uint32_t> order(charts_.count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return area_[a] < area_[b]; });
    std::vector<std::uint8_t> changed(charts_.count, 0);
    std::size_t joined = 0;
    for (const std::uint32_t c : order) {
      if (changed[c]) continue;
      const std::vector<Index> stretch = longest_stretch(c, changed);
      if (stretch.empty()) continue;
      changed[c] = changed[chart(surface_.opposite[stretch.front()])] = 1;
      for (const Index h : stretch) seam_[h] = seam_[surface_.opposite[h]] = 0;
      ++joined;
    }
    return joined;
  }

 private:
  std::uint32_t chart(Index h) const { return charts_.of_triangle[triangle_of(h)]; }

  bool takes(std::uint32_t large, std::uint32_t small) const {
    return large != small && area_[small] <= area_[large] &&
           (size_[small] == 1 || area_[small] <= std::max(fraction_ * area_[large], speck_[small]));
  }

  /// The border half-edge of the same chart that follows h.
  Index next_border(Index h) const {
    h = next_halfedge(h);
    while (!seam_[h]) h = next_halfedge(surface_.opposite[h]);
    return h;
  }

  /// Does a stretch that holds h go on with the border half-edge after it?
  bool goes_on(Index h, Index next) const {
    const Index other = surface_.opposite[h], beyond = surface_.opposite[next];
    return other != k_none && beyond != k_none && chart(other) == chart(beyond) && next_border(beyond) == other;
  }

  Index previous_border(Index h) const {
    h = previous_halfedge(h);
    while (!seam_[h]) h = previous_halfedge(surface_.opposite[h]);
    return h;
  }

  /// The whole stretch that holds h, from its start; all of it when it runs around.
  std::vector<Index> stretch_at(Index h) const {
    Index start = h;
    for (Index before = previous_border(start); before != h && goes_on(before, start); before = previous_border(start))
      start = before;
    std::vector<Index> stretch{start};
    for (Index next = next_border(start); next != start && goes_on(stretch.back(), next); next = next_border(next))
      stretch.push_back(next);
    return stretch;
  }

  std::vector<Index> longest_stretch(std::uint32_t c, const std::vector<std::uint8_t>& changed) {
    std::vector<Index> best;
    double best_length = -1;
    for (const Index h : border_[c]) {
      const Index other = surface_.opposite[h];
      if (seen_[h] || other == k_none || changed[chart(other)] || !takes(chart(other), c)) continue;
      std::vector<Index> stretch = stretch_at(h);
      double length = 0;
      for (const Index g : stretch) {
        seen_[g] = 1;
        length += surface_.length(g);
      }
      if (length > best_length && stretch.size() < border_[chart(other)].size())
        best_length = length, best = std::move(stretch);
    }
    return best;
  }

  const SegmentedMesh& surface_;
  double fraction_;
  std::vector<std::uint8_t>& seam_;
  ChartSet charts_;
  std::vector<double> area_, speck_;
  std::vector<std::size_t> size_;
  std::vector<std::vector<Index>> border_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace

std::size_t absorb_charts(const SegmentedMesh& surface, double small_area_fraction, double speck_area_fraction,
                          std::vector<std::uint8_t>& seam) {
  const std::vector<double> speck = speck_areas(surface, speck_area_fraction);
  std::size_t joined = 0;
  for (int round = 0; round < k_max_rounds; ++round) {
    const std::size_t now = Absorber(surface, small_area_fraction, speck, seam).run();
    if (now == 0) break;
    joined += now;
  }
  return joined;
}

}  // namespace papilla::detail
