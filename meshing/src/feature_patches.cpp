// SPDX-License-Identifier: MIT
#include "segmentation_steps.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "papilla/core/union_find.hpp"
#include "papilla/core/units.hpp"

namespace papilla::detail {
namespace {

struct Border {
  std::uint32_t a = 0, b = 0;
  double length = -1;
};

/// Adds up the borders between the same two charts; ascending, a < b.
void join_equal(std::vector<Border>& borders) {
  std::stable_sort(borders.begin(), borders.end(),
                   [](const Border& l, const Border& r) { return std::tie(l.a, l.b) < std::tie(r.a, r.b); });
  std::size_t to = 0;
  for (std::size_t from = 0; from < borders.size(); ++from) {
    if (to > 0 && borders[to - 1].a == borders[from].a && borders[to - 1].b == borders[from].b) {
      borders[to - 1].length += borders[from].length;
    } else {
      borders[to++] = borders[from];
    }
  }
  borders.resize(to);
}

/// Common borders of different charts.
std::vector<Border> find_borders(const SegmentedMesh& surface, const std::vector<std::uint32_t>& labels) {
  std::vector<Border> borders;
  for (Index h = 0; h < surface.opposite.size(); ++h) {
    const Index other = surface.opposite[h];
    if (other == k_none || other < h) continue;
    const auto [a, b] = std::minmax(labels[triangle_of(h)], labels[triangle_of(other)]);
    if (a == b) continue;
    borders.push_back({a, b, surface.length(h)});
  }
  join_equal(borders);
  return borders;
}

/// Replaces each label by its set's; returns the new count.
std::uint32_t apply(UnionFind& sets, std::vector<std::uint32_t>& labels) {
  for (std::uint32_t& label : labels) label = sets.find(label);
  return renumber(labels);
}

std::vector<double> chart_areas(const SegmentedMesh& surface, const std::vector<std::uint32_t>& labels,
                                std::uint32_t count) {
  std::vector<double> area(count, 0);
  for (Index t = 0; t < labels.size(); ++t) area[labels[t]] += surface.area[t];
  return area;
}

std::uint32_t count_of(const std::vector<std::uint32_t>& labels) {
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
}

}  // namespace

std::vector<std::uint8_t> feature_halfedges(const SegmentedMesh& surface, double feature_angle_deg) {
  const double least_cosine = std::cos(feature_angle_deg * k_radians_per_degree);
  std::vector<std::uint8_t> feature(surface.opposite.size(), 1);
  for (Index h = 0; h < feature.size(); ++h) {
    const Index other = surface.opposite[h];
    if (other == k_none || other < h) continue;
    const Vec3 a = surface.normal[triangle_of(h)], b = surface.normal[triangle_of(other)];
    feature[h] = feature[other] = dot(a, b) < least_cosine;
  }
  return feature;
}

std::vector<std::uint32_t> feature_patches(const SegmentedMesh& surface, const std::vector<std::uint8_t>& feature,
                                           std::uint32_t& count) {
  UnionFind patches(surface.size());
  for (Index h = 0; h < feature.size(); ++h)
    if (!feature[h]) patches.unite(triangle_of(h), triangle_of(surface.opposite[h]));
  return patches.labels(count);
}

std::vector<double> speck_areas(const SegmentedMesh& surface, double fraction) {
  std::vector<std::uint32_t> component(surface.size(), 0);
  const std::uint32_t count = split_into_components(surface.opposite, component);
  const std::vector<double> area = chart_areas(surface, component, count);
  std::vector<double> limit(surface.size());
  for (Index t = 0; t < limit.size(); ++t) limit[t] = fraction * area[component[t]];
  return limit;
}

std::uint32_t absorb_small(const SegmentedMesh& surface, const SegmentationOptions& options,
                           std::vector<std::uint32_t>& labels) {
  std::uint32_t count = count_of(labels);
  const std::vector<double> speck_area = speck_areas(surface, options.speck_area_fraction);
  for (bool merged = true; merged;) {
    merged = false;
    const std::vector<double> area = chart_areas(surface, labels, count);
    std::vector<double> speck(count);
    for (Index t = 0; t < labels.size(); ++t) speck[labels[t]] = speck_area[t];
    std::vector<Border> longest(count);  // per small chart: the best neighbour in b
    for (const Border& border : find_borders(surface, labels))
      for (const auto& [small, large] : {std::pair(border.a, border.b), std::pair(border.b, border.a)})
        if ((area[small] <= options.small_area_fraction * area[large] || area[small] <= speck[small]) &&
            border.length > longest[small].length)
          longest[small] = {small, large, border.length};
    UnionFind sets(count);
    for (const Border& border : longest) {
      if (border.length < 0) continue;
      sets.unite(border.a, border.b);
      merged = true;
    }
    count = apply(sets, labels);
  }
  return count;
}

}  // namespace papilla::detail
