// SPDX-License-Identifier: MIT
#include "chart_merge.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "papilla/core/units.hpp"
#include "union_find.hpp"

namespace papilla::detail {
namespace {

/// Bins on a cube around the sphere of normals, about five degrees wide.
constexpr Index k_bins_per_side = 16;
constexpr double k_bin_radius_deg = 3;

struct Border {
  std::uint32_t a = 0, b = 0;
  double length = 0, smooth_length = 0;
};

/// Adds up the borders between the same two charts; ascending, a < b.
void join_equal(std::vector<Border>& borders) {
  std::stable_sort(borders.begin(), borders.end(),
                   [](const Border& l, const Border& r) { return std::tie(l.a, l.b) < std::tie(r.a, r.b); });
  std::size_t to = 0;
  for (std::size_t from = 0; from < borders.size(); ++from) {
    if (to > 0 && borders[to - 1].a == borders[from].a && borders[to - 1].b == borders[from].b) {
      borders[to - 1].length += borders[from].length;
      borders[to - 1].smooth_length += borders[from].smooth_length;
    } else {
      borders[to++] = borders[from];
    }
  }
  borders.resize(to);
}

/// Common borders of different charts.
std::vector<Border> find_borders(const Surface& surface, const std::vector<std::uint8_t>& feature,
                                 const std::vector<std::uint32_t>& labels) {
  std::vector<Border> borders;
  for (Index h = 0; h < surface.opposite.size(); ++h) {
    const Index other = surface.opposite[h];
    if (other == k_none || other < h) continue;
    const auto [a, b] = std::minmax(labels[triangle_of(h)], labels[triangle_of(other)]);
    if (a == b) continue;
    const double length = surface.length(h);
    borders.push_back({a, b, length, feature[h] ? 0 : length});
  }
  join_equal(borders);
  return borders;
}

Index bin_of(const Vec3& n) noexcept {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Index axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  const double w = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
  if (w == 0) return 0;
  const double u = axis == 0 ? n.y : n.x, v = axis == 2 ? n.y : n.z;
  const auto cell = [](double ratio) {
    return std::min(k_bins_per_side - 1, static_cast<Index>((0.5 * ratio + 0.5) * k_bins_per_side));
  };
  return ((2 * axis + (w < 0)) * k_bins_per_side + cell(u / std::abs(w))) * k_bins_per_side + cell(v / std::abs(w));
}

/// Area vectors of a chart's triangles, summed per bin; ascending bins.
using NormalBins = std::vector<std::pair<Index, Vec3>>;

NormalBins add(const NormalBins& a, const NormalBins& b) {
  NormalBins sum;
  sum.reserve(a.size() + b.size());
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a[i].first < b[j].first))
      sum.push_back(a[i++]);
    else if (i == a.size() || b[j].first < a[i].first)
      sum.push_back(b[j++]);
    else
      sum.emplace_back(a[i].first, a[i].second + b[j].second), ++i, ++j;
  }
  return sum;
}

std::vector<NormalBins> normal_bins(const Surface& surface, const std::vector<std::uint32_t>& labels,
                                    std::uint32_t count) {
  std::vector<std::tuple<std::uint32_t, Index, Index>> keys;
  keys.reserve(labels.size());
  for (Index t = 0; t < labels.size(); ++t) keys.emplace_back(labels[t], bin_of(surface.area_vector(t)), t);
  std::sort(keys.begin(), keys.end());
  std::vector<NormalBins> bins(count);
  for (const auto& [label, bin, t] : keys) {
    NormalBins& chart = bins[label];
    if (chart.empty() || chart.back().first != bin) chart.emplace_back(bin, Vec3{});
    chart.back().second = chart.back().second + surface.area_vector(t);
  }
  return bins;
}

bool fits_cone(const NormalBins& bins, const SegmentationOptions& options) {
  Vec3 sum{};
  for (const auto& [bin, vector] : bins) sum = sum + vector;
  const Vec3 axis = normalized(sum);
  const double angle = std::max(0.0, options.max_normal_deviation_deg - k_bin_radius_deg);
  const double least_cosine = std::cos(angle * k_radians_per_degree);
  double area = 0, outside = 0;
  for (const auto& [bin, vector] : bins) {
    const double size = norm(vector);
    area += size;
    if (dot(vector, axis) < least_cosine * size) outside += size;
  }
  return outside <= options.outlier_area_fraction * area;
}

/// Replaces each label by its set's; returns the new count.
std::uint32_t apply(UnionFind& sets, std::vector<std::uint32_t>& labels) {
  for (std::uint32_t& label : labels) label = sets.find(label);
  return renumber(labels);
}

std::vector<double> chart_areas(const Surface& surface, const std::vector<std::uint32_t>& labels, std::uint32_t count) {
  std::vector<double> area(count, 0);
  for (Index t = 0; t < labels.size(); ++t) area[labels[t]] += surface.area[t];
  return area;
}

/// Per triangle: the area below which a chart of its component is a speck.
std::vector<double> speck_areas(const Surface& surface, const SegmentationOptions& options) {
  std::vector<std::uint32_t> component(surface.size(), 0);
  const std::uint32_t count = split_into_components(surface.opposite, component);
  const std::vector<double> area = chart_areas(surface, component, count);
  std::vector<double> limit(surface.size());
  for (Index t = 0; t < limit.size(); ++t) limit[t] = options.speck_area_fraction * area[component[t]];
  return limit;
}

std::uint32_t count_of(const std::vector<std::uint32_t>& labels) {
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
}

}  // namespace

std::uint32_t merge_fitting(const Surface& surface, const std::vector<std::uint8_t>& feature,
                            const SegmentationOptions& options, std::vector<std::uint32_t>& labels) {
  std::uint32_t count = count_of(labels);
  std::vector<NormalBins> bins = normal_bins(surface, labels, count);
  std::vector<Border> borders = find_borders(surface, feature, labels);
  std::erase_if(borders, [](const Border& b) { return b.smooth_length < 0.5 * b.length; });
  UnionFind sets(count);
  for (bool merged = true; merged;) {
    merged = false;
    std::stable_sort(borders.begin(), borders.end(),
                     [](const Border& l, const Border& r) { return l.smooth_length > r.smooth_length; });
    std::vector<std::uint8_t> changed(count, 0);
    for (const Border& border : borders) {
      if (changed[border.a] || changed[border.b]) continue;
      NormalBins both = add(bins[border.a], bins[border.b]);
      if (!fits_cone(both, options)) continue;
      sets.unite(border.a, border.b);
      bins[sets.find(border.a)] = std::move(both);
      changed[border.a] = changed[border.b] = 1;
      merged = true;
    }
    for (Border& border : borders) {
      border.a = sets.find(border.a);
      border.b = sets.find(border.b);
      if (border.a > border.b) std::swap(border.a, border.b);
    }
    std::erase_if(borders, [](const Border& border) { return border.a == border.b; });
    join_equal(borders);
  }
  return apply(sets, labels);
}

std::uint32_t absorb_small(const Surface& surface, const std::vector<std::uint8_t>& feature,
                           const SegmentationOptions& options, std::vector<std::uint32_t>& labels) {
  std::uint32_t count = count_of(labels);
  const std::vector<double> speck_area = speck_areas(surface, options);
  for (bool merged = true; merged;) {
    merged = false;
    const std::vector<double> area = chart_areas(surface, labels, count);
    std::vector<double> speck(count);
    for (Index t = 0; t < labels.size(); ++t) speck[labels[t]] = speck_area[t];
    std::vector<Border> longest(count);  // per small chart: the best neighbour in b
    for (const Border& border : find_borders(surface, feature, labels))
      for (const auto& [small, large] : {std::pair(border.a, border.b), std::pair(border.b, border.a)})
        if ((area[small] <= options.small_area_fraction * area[large] || area[small] <= speck[small]) &&
            border.length > longest[small].length)
          longest[small] = {small, large, border.length, 0};
    UnionFind sets(count);
    for (const Border& border : longest) {
      if (!(border.length > 0)) continue;
      sets.unite(border.a, border.b);
      merged = true;
    }
    count = apply(sets, labels);
  }
  return count;
}

}  // namespace papilla::detail
