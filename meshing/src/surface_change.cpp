// SPDX-License-Identifier: MIT
#include "surface_change.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "one_sided_deviation.hpp"
#include "papilla/core/bounds.hpp"
#include "scramble.hpp"
#include "triangle_bvh.hpp"
#include "triangle_shape.hpp"

namespace papilla::detail {
namespace {

constexpr std::uint32_t k_pieces = 256;     ///< Of a triangle, beside those that what it is compared with asks for.
constexpr std::size_t k_samples = 4096;     ///< Triangles that samples are taken from.
constexpr double k_cells_a_diagonal = 256;  ///< The grid's cells are this fraction of the box's diagonal.
constexpr double k_most_cells = 64;         ///< Triangles that touch more are taken without a look at each.

std::vector<Index> all_of(const TriangleMesh& mesh) {
  std::vector<Index> triangles(mesh.triangles.size());
  std::iota(triangles.begin(), triangles.end(), Index{0});
  return triangles;
}

Bounds3 box_of(const TriangleMesh& mesh, std::span<const Index> triangles) {
  Bounds3 bounds;
  for (const Index t : triangles)
    for (int k = 0; k < 3; ++k) bounds.add(mesh.corner(t, k));
  return bounds;
}

/// The triangles without the rest of what the mesh carries.
TriangleMesh shape_of(const TriangleMesh& mesh, std::span<const Index> triangles) {
  TriangleMesh shape;
  shape.positions.reserve(3 * triangles.size());
  for (const Index t : triangles) {
    const auto first = static_cast<Index>(shape.positions.size());
    for (int k = 0; k < 3; ++k) shape.positions.push_back(mesh.corner(t, k));
    shape.triangles.push_back({first, first + 1, first + 2});
  }
  return shape;
}

std::vector<Index> with_area(const TriangleMesh& mesh, std::span<const Index> triangles, double least_altitude) {
  std::vector<Index> result;
  for (const Index t : triangles)
    if (!(triangle_shape(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)).altitude < least_altitude))
      result.push_back(t);
  return result;
}

std::uint64_t hash_of(const Vec3& p) noexcept {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };
  return scramble(bits(p.x) + scramble(bits(p.y) + scramble(bits(p.z))));
}

/// A number that triangles with the same corners share, whatever their order; others only by a chance of 2^-64.
std::uint64_t hash_of(const TriangleMesh& mesh, Index t) {
  return hash_of(mesh.corner(t, 0)) + hash_of(mesh.corner(t, 1)) + hash_of(mesh.corner(t, 2));
}

std::vector<std::uint64_t> sorted_hashes(const TriangleMesh& mesh, std::span<const Index> triangles) {
  std::vector<std::uint64_t> hashes;
  hashes.reserve(triangles.size());
  for (const Index t : triangles) hashes.push_back(hash_of(mesh, t));
  std::sort(hashes.begin(), hashes.end());
  return hashes;
}

std::vector<Index> missing_in(const std::vector<std::uint64_t>& others, const TriangleMesh& mesh,
                              std::span<const Index> triangles) {
  std::vector<Index> missing;
  for (const Index t : triangles)
    if (!std::binary_search(others.begin(), others.end(), hash_of(mesh, t))) missing.push_back(t);
  return missing;
}

/// The farthest that a point of the triangles lies from the others.
double farthest(const TriangleMesh& mesh, std::span<const Index> from, const TriangleMesh& to,
                std::span<const Index> to_triangles, double floor_mm) {
  if (from.empty()) return 0;
  if (to_triangles.empty()) return box_of(mesh, from).diagonal();
  const TriangleMesh target = shape_of(to, to_triangles);
  DeviationOptions options;
  options.mean_samples = 0;
  options.pieces_per_triangle = k_pieces;
  options.settled_below_mm = floor_mm;
  return one_sided_deviation(shape_of(mesh, from), TriangleBvh(target.positions, target.triangles), floor_mm, options)
      .bound;
}

SurfaceChange whole_change(const TriangleMesh& before, std::span<const Index> triangles, const TriangleMesh& after,
                           const SurfaceChangeOptions& options) {
  const std::vector<Index> now = all_of(after);
  const std::vector<Index> gone =
      with_area(before, missing_in(sorted_hashes(after, now), before, triangles), options.least_altitude_mm);
  const std::vector<Index> come = missing_in(sorted_hashes(before, triangles), after, now);
  return {farthest(before, gone, after, now, options.floor_mm),
          farthest(after, come, before, triangles, options.floor_mm), false};
}

/// The cells of a grid in which samples lie.
class SampledCells {
 public:
  SampledCells(const Bounds3& bounds, double reach, std::size_t capacity)
      : low_(bounds.low), size_(std::max(bounds.diagonal() / k_cells_a_diagonal, 4 * reach)), reach_(reach) {
    slots_.assign(std::bit_ceil(4 * capacity), k_empty);
  }

  void add(const Vec3& p) {
    const std::uint64_t key = key_of(cell(p.x - low_.x), cell(p.y - low_.y), cell(p.z - low_.z));
    std::size_t slot = slot_of(key);
    while (slots_[slot] != k_empty && slots_[slot] != key) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = key;
  }

  bool has(const Vec3& p) const { return contains(key_of(cell(p.x - low_.x), cell(p.y - low_.y), cell(p.z - low_.z))); }

  /// The triangles that come within the reach of one of the cells, and some others.
  std::vector<Index> near(const TriangleMesh& mesh, std::span<const Index> triangles) const {
    std::vector<std::uint8_t> is_near(triangles.size());
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, triangles.size(), 4096),
                              [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                                for (std::size_t i = range.begin(); i < range.end(); ++i)
                                  is_near[i] = touches(mesh, triangles[i]);
                              });
    std::vector<Index> result;
    for (std::size_t i = 0; i < triangles.size(); ++i)
      if (is_near[i]) result.push_back(triangles[i]);
    return result;
  }

 private:
  static constexpr std::uint64_t k_empty = ~std::uint64_t{0};

  double cell(double x) const { return std::floor(x / size_); }
  static std::uint64_t key_of(double i, double j, double k) {
    const auto bits = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(x)) & 0xfffff; };
    return bits(i) << 40 | bits(j) << 20 | bits(k);
  }
  std::size_t slot_of(std::uint64_t key) const { return scramble(key) & (slots_.size() - 1); }

  bool contains(std::uint64_t key) const {
    std::size_t slot = slot_of(key);
    for (; slots_[slot] != k_empty; slot = (slot + 1) & (slots_.size() - 1))
      if (slots_[slot] == key) return true;
    return false;
  }

  bool touches(const TriangleMesh& mesh, Index t) const {
    Bounds3 box;
    for (int k = 0; k < 3; ++k) box.add(mesh.corner(t, k) - low_);
    const Vec3 reach{reach_, reach_, reach_}, low = box.low - reach, high = box.high + reach;
    const double i0 = cell(low.x), j0 = cell(low.y), k0 = cell(low.z);
    const double i1 = cell(high.x), j1 = cell(high.y), k1 = cell(high.z);
    if ((i1 - i0 + 1) * (j1 - j0 + 1) * (k1 - k0 + 1) > k_most_cells) return true;
    for (double i = i0; i <= i1; ++i)
      for (double j = j0; j <= j1; ++j)
        for (double k = k0; k <= k1; ++k)
          if (contains(key_of(i, j, k))) return true;
    return false;
  }

  Vec3 low_;
  double size_, reach_;
  std::vector<std::uint64_t> slots_;
};

/// Corner and centre of every so many triangles, so that at most `k_samples` of these are looked at.
std::vector<Vec3> sample_points(const TriangleMesh& mesh, std::span<const Index> triangles) {
  const std::size_t step = triangles.size() / k_samples + 1;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < triangles.size(); i += step) {
    const Index t = triangles[i];
    points.push_back(mesh.corner(t, 0));
    points.push_back((1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)));
  }
  return points;
}

double farthest(const std::vector<Vec3>& points, const TriangleMesh& mesh, std::span<const Index> triangles) {
  if (points.empty()) return 0;
  const TriangleMesh target = shape_of(mesh, triangles);
  const TriangleBvh tree(target.positions, target.triangles);
  double farthest = 0;
  for (const Vec3& p : points) farthest = std::max(farthest, tree.closest(p).squared_distance);
  return std::sqrt(farthest);
}

SurfaceChange sampled_change(const TriangleMesh& before, std::span<const Index> triangles, const TriangleMesh& after,
                             const SurfaceChangeOptions& options) {
  const Bounds3 bounds = box_of(before, triangles);
  std::vector<Index> drawn;
  for (std::size_t i = 0; i < triangles.size(); i += triangles.size() / k_samples + 1) drawn.push_back(triangles[i]);
  const std::vector<Vec3> points = sample_points(before, with_area(before, drawn, options.least_altitude_mm));
  SampledCells cells(bounds, options.reach_mm, points.size());
  for (const Vec3& p : points) cells.add(p);
  const std::vector<Index> now = all_of(after), near_before = cells.near(before, triangles),
                           near_now = cells.near(after, now);
  if (near_now.empty()) return {bounds.diagonal(), 0, true};
  std::vector<Vec3> points_now = sample_points(after, near_now);
  std::erase_if(points_now, [&](const Vec3& p) { return !cells.has(p); });
  return {farthest(points, after, near_now), farthest(points_now, before, near_before), true};
}

}  // namespace

SurfaceChange surface_change(const TriangleMesh& before, std::span<const Index> triangles, const TriangleMesh& after,
                             const SurfaceChangeOptions& options) {
  if (triangles.empty()) return {};
  return triangles.size() > options.sample_above ? sampled_change(before, triangles, after, options)
                                                 : whole_change(before, triangles, after, options);
}

}  // namespace papilla::detail
