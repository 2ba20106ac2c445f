// SPDX-License-Identifier: MIT
#include "cone_split.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "papilla/core/units.hpp"
#include "union_find.hpp"

namespace papilla::detail {
namespace {

constexpr int k_lloyd_rounds = 2;
/// A bisection must leave at most this fraction of the area outside the cones, or it chases noise.
constexpr double k_required_gain = 0.8;

/// First-in-first-out queues for costs in [0, 1], the cheapest first.
class BucketQueue {
 public:
  struct Entry {
    Index triangle;
    std::uint8_t side;
  };
  void push(double cost, Entry entry) {
    const std::size_t b = std::min(k_buckets - 1, static_cast<std::size_t>(cost * (k_buckets - 1)));
    buckets_[b].entries.push_back(entry);
    used_[b / 64] |= std::uint64_t{1} << b % 64;
  }
  bool pop(Entry& entry) {
    for (std::size_t word = 0; word < used_.size(); ++word) {
      if (used_[word] == 0) continue;
      const std::size_t b = 64 * word + static_cast<std::size_t>(std::countr_zero(used_[word]));
      Bucket& bucket = buckets_[b];
      entry = bucket.entries[bucket.head++];
      if (bucket.head == bucket.entries.size()) {
        bucket.entries.clear();
        bucket.head = 0;
        used_[word] &= ~(std::uint64_t{1} << b % 64);
      }
      return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t k_buckets = 512;
  struct Bucket {
    std::vector<Entry> entries;
    std::size_t head = 0;
  };
  std::array<Bucket, k_buckets> buckets_;
  std::array<std::uint64_t, k_buckets / 64> used_{};
};

struct Cone {
  Vec3 axis;
  double area = 0, outside = 0;
};

class ConeSplitter {
 public:
  ConeSplitter(const Surface& surface, const std::vector<std::uint8_t>& feature, const SegmentationOptions& options,
               std::vector<std::uint32_t>& labels)
      : surface_(surface),
        feature_(feature),
        options_(options),
        labels_(labels),
        side_(labels.size(), k_unset),
        least_cosine_(std::cos(options.max_normal_deviation_deg * k_radians_per_degree)) {}

  std::uint32_t run(std::uint32_t count) {
    count_ = count;
    std::vector<std::vector<Index>> pending(count);
    for (Index t = 0; t < labels_.size(); ++t) pending[labels_[t]].push_back(t);
    while (!pending.empty()) {
      std::vector<Index> chart = std::move(pending.back());
      pending.pop_back();
      const Cone cone = measure(chart);
      if (chart.size() < 2 || cone.outside <= options_.outlier_area_fraction * cone.area) continue;
      if (!bisect(chart, cone, pending)) threshold(chart, cone, pending);
    }
    return renumber(labels_);
  }

 private:
  static constexpr std::uint8_t k_unset = 2;

  Cone measure(const std::vector<Index>& chart) const {
    Cone cone;
    Vec3 sum{};
    for (const Index t : chart) sum = sum + surface_.area_vector(t);
    cone.axis = normalized(sum);
    for (const Index t : chart) {
      const double area = surface_.area[t];
      cone.area += area;
      if (is_outside(t, cone.axis)) cone.outside += area;
    }
    return cone;
  }

  bool is_outside(Index t, const Vec3& axis) const { return dot(surface_.normal[t], axis) < least_cosine_; }

  /// The direction in which the normals spread most, by power iteration on their covariance.
  Vec3 spread_direction(const std::vector<Index>& chart, const Vec3& mean) const {
    double m[6] = {};
    for (const Index t : chart) {
      const Vec3 n = surface_.normal[t] - mean;
      const double area = surface_.area[t];
      m[0] += area * n.x * n.x, m[1] += area * n.x * n.y, m[2] += area * n.x * n.z;
      m[3] += area * n.y * n.y, m[4] += area * n.y * n.z, m[5] += area * n.z * n.z;
    }
    Vec3 d = normalized(Vec3{0.9, 0.8, 0.7});
    for (int i = 0; i < 30; ++i) {
      const Vec3 next = normalized({m[0] * d.x + m[1] * d.y + m[2] * d.z, m[1] * d.x + m[3] * d.y + m[4] * d.z,
                                    m[2] * d.x + m[4] * d.y + m[5] * d.z});
      if (dot(next, next) == 0) break;
      d = next;
    }
    return d;
  }

  /// Two-means of the normals with regions grown over the surface. True when it was worth it: labels are set and the
  /// halves wait in `pending`.
  bool bisect(const std::vector<Index>& chart, const Cone& cone, std::vector<std::vector<Index>>& pending) {
    const Vec3 direction = spread_direction(chart, cone.axis);
    const double middle = dot(cone.axis, direction);
    for (const Index t : chart) side_[t] = dot(surface_.normal[t], direction) > middle;
    for (int round = 0; round < k_lloyd_rounds; ++round) grow(chart, mean_normals(chart));

    std::array<std::vector<Index>, 2> halves;
    for (const Index t : chart) {
      halves[side_[t]].push_back(t);
      side_[t] = k_unset;
    }
    if (halves[0].empty() || halves[1].empty()) return false;
    if (measure(halves[0]).outside + measure(halves[1]).outside > k_required_gain * cone.outside) return false;
    for (const Index t : halves[1]) labels_[t] = count_;
    ++count_;
    for (auto& half : halves) pending.push_back(std::move(half));
    return true;
  }

  std::array<Vec3, 2> mean_normals(const std::vector<Index>& chart) const {
    std::array<Vec3, 2> sum{};
    for (const Index t : chart) sum[side_[t]] = sum[side_[t]] + surface_.area_vector(t);
    return {normalized(sum[0]), normalized(sum[1])};
  }

  /// sin(angle / 2) between a triangle's normal and an axis.
  double cost(Index t, const Vec3& axis) const {
    return std::sqrt(std::clamp(0.5 * (1 - dot(surface_.normal[t], axis)), 0.0, 1.0));
  }

  /// Grows two regions from the triangles that fit the axes best, always the best fitting triangle first.
  void grow(const std::vector<Index>& chart, const std::array<Vec3, 2>& axes) {
    std::array<Index, 2> seed{chart.front(), chart.front()};
    for (std::uint8_t s = 0; s < 2; ++s) {
      double best = 2;
      for (const Index t : chart) {
        if (s == 1 && t == seed[0]) continue;
        const double c = cost(t, axes[s]);
        if (c < best) best = c, seed[s] = t;
      }
    }
    for (const Index t : chart) side_[t] = k_unset;
    // Triangles outside the chart must not be entered: their label differs.
    const std::uint32_t label = labels_[chart.front()];
    BucketQueue::Entry entry{};
    for (std::uint8_t s = 0; s < 2; ++s) queue_.push(0, {seed[s], s});
    while (queue_.pop(entry)) {
      if (side_[entry.triangle] != k_unset) continue;
      side_[entry.triangle] = entry.side;
      for (Index h = 3 * entry.triangle; h < 3 * entry.triangle + 3; ++h) {
        if (feature_[h]) continue;
        const Index other = triangle_of(surface_.opposite[h]);
        if (labels_[other] == label && side_[other] == k_unset)
          queue_.push(cost(other, axes[entry.side]), {other, entry.side});
      }
    }
  }

  /// Makes the connected pieces inside and outside the cone charts of their own, when several of them are more than
  /// specks; specks join the rest.
  void threshold(const std::vector<Index>& chart, const Cone& cone, std::vector<std::vector<Index>>& pending) {
    const std::uint32_t label = labels_[chart.front()];
    for (const Index t : chart) side_[t] = is_outside(t, cone.axis);
    std::vector<std::vector<Index>> pieces;
    std::vector<Index> rest;
    for (const Index seed : chart) {
      if (side_[seed] == k_unset) continue;
      std::vector<Index> piece = take_piece(seed, label);
      double area = 0;
      for (const Index t : piece) area += surface_.area[t];
      if (area >= options_.small_area_fraction * cone.area)
        pieces.push_back(std::move(piece));
      else
        rest.insert(rest.end(), piece.begin(), piece.end());
    }
    if (pieces.size() < 2) return;
    const std::uint32_t first = count_;
    for (const auto& piece : pieces) {
      for (const Index t : piece) labels_[t] = count_;
      ++count_;
    }
    attach(std::move(rest), first);
    std::vector<std::vector<Index>> charts(pieces.size());
    for (const Index t : chart)
      if (labels_[t] != label) charts[labels_[t] - first].push_back(t);
    for (auto& piece : charts) pending.push_back(std::move(piece));
  }

  /// The triangles of the same label and side that are connected with `seed`; clears their sides.
  std::vector<Index> take_piece(Index seed, std::uint32_t label) {
    const std::uint8_t side = side_[seed];
    std::vector<Index> piece{seed};
    side_[seed] = k_unset;
    for (std::size_t at = 0; at < piece.size(); ++at)
      for (Index h = 3 * piece[at]; h < 3 * piece[at] + 3; ++h) {
        if (feature_[h]) continue;
        const Index other = triangle_of(surface_.opposite[h]);
        if (labels_[other] != label || side_[other] != side) continue;
        side_[other] = k_unset;
        piece.push_back(other);
      }
    return piece;
  }

  /// Gives triangles the label of a neighbour that has one of the new labels, from `first` on, border inward.
  void attach(std::vector<Index> rest, std::uint32_t first) {
    std::vector<Index> later;
    while (!rest.empty()) {
      later.clear();
      std::vector<std::pair<Index, std::uint32_t>> found;
      for (const Index t : rest) {
        std::uint32_t label = 0;
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
          if (!feature_[h]) label = std::max(label, labels_[triangle_of(surface_.opposite[h])]);
        if (label < first)
          later.push_back(t);
        else
          found.emplace_back(t, label);
      }
      if (found.empty()) return;
      for (const auto& [t, label] : found) labels_[t] = label;
      rest.swap(later);
    }
  }

  const Surface& surface_;
  const std::vector<std::uint8_t>& feature_;
  const SegmentationOptions& options_;
  std::vector<std::uint32_t>& labels_;
  std::vector<std::uint8_t> side_;
  double least_cosine_;
  std::uint32_t count_ = 0;
  BucketQueue queue_;
};

}  // namespace

std::vector<std::uint8_t> feature_halfedges(const Surface& surface, double feature_angle_deg) {
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

std::vector<std::uint32_t> feature_patches(const Surface& surface, const std::vector<std::uint8_t>& feature,
                                           std::uint32_t& count) {
  UnionFind patches(surface.size());
  for (Index h = 0; h < feature.size(); ++h)
    if (!feature[h]) patches.unite(triangle_of(h), triangle_of(surface.opposite[h]));
  return patches.labels(count);
}

std::uint32_t split_by_cones(const Surface& surface, const std::vector<std::uint8_t>& feature,
                             const SegmentationOptions& options, std::vector<std::uint32_t>& labels) {
  const std::uint32_t count = renumber(labels);
  return ConeSplitter(surface, feature, options, labels).run(count);
}

}  // namespace papilla::detail
