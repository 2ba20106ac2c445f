// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "papilla/meshing/visibility.hpp"
#include "world_scene.hpp"

namespace papilla::detail {

/// Point i of a low-discrepancy sequence in [0, 1)^d: multiples of the powers of 1 / phi_d, phi_d the root of
/// x^(d + 1) = x + 1 [Roberts 2018].
inline double spread(std::uint64_t i, double step) noexcept {
  const double x = 0.5 + step * static_cast<double>(i % (std::uint64_t{1} << 40));
  return x - std::floor(x);
}
inline constexpr double k_phi2 = 1.32471795724474602596, k_phi3 = 1.22074408460575947536;

/// @throws InvalidInput naming `function` when the volume is not finite, its low corner exceeds its high one, or its
///         radius is negative.
void check_volume(const Volume& volume, const std::string& function);

/// Point i of those spread over a volume.
inline Vec3 point_in(const Volume& volume, std::uint64_t i) noexcept {
  const double u = spread(i, 1 / k_phi3), v = spread(i, 1 / (k_phi3 * k_phi3)),
               w = spread(i, 1 / (k_phi3 * k_phi3 * k_phi3));
  if (const auto* box = std::get_if<BoxVolume>(&volume)) {
    const Vec3 d = box->high - box->low;
    return box->low + Vec3{u * d.x, v * d.y, w * d.z};
  }
  const auto& sphere = std::get<SphereVolume>(volume);
  const double z = 2 * u - 1, flat = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * std::numbers::pi * v;
  return sphere.centre + (sphere.radius_mm * std::cbrt(w)) * Vec3{flat * std::cos(angle), flat * std::sin(angle), z};
}

/// Points spread evenly over the area of some of a part's triangles, the same ones when those are turned over.
class AreaSampler {
 public:
  explicit AreaSampler(const PlacedTriangles& part) : part_(part) {
    for (std::size_t t = 0; t < part.size(); ++t) add(t);
  }
  AreaSampler(const PlacedTriangles& part, std::span<const Index> triangles) : part_(part), triangles_(triangles) {
    for (const Index t : triangles) add(t);
  }
  bool empty() const noexcept { return cumulative_.empty() || !(cumulative_.back() > 0); }

  struct Sample {
    std::size_t triangle;
    Vec3 point;
  };
  Sample operator()(std::uint64_t i, std::uint64_t count) const {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * cumulative_.back();
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), at);
    const auto place = std::min(static_cast<std::size_t>(found - cumulative_.begin()), cumulative_.size() - 1);
    const std::size_t t = triangles_.empty() ? place : triangles_[place];
    double u = spread(i, 1 / k_phi2), v = spread(i, 1 / (k_phi2 * k_phi2));
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto [a, b, c] = corners(t);
    return {t, a + u * (b - a) + v * (c - a)};
  }

 private:
  void add(std::size_t t) {
    const auto [a, b, c] = corners(t);
    const double before = cumulative_.empty() ? 0 : cumulative_.back();
    cumulative_.push_back(before + norm(cross(b - a, c - a)));
  }

  /// In the order of their coordinates.
  std::array<Vec3, 3> corners(std::size_t t) const {
    std::array<Vec3, 3> all{part_.corner(t, 0), part_.corner(t, 1), part_.corner(t, 2)};
    std::sort(all.begin(), all.end(),
              [](const Vec3& p, const Vec3& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); });
    return all;
  }

  const PlacedTriangles& part_;
  std::span<const Index> triangles_;  ///< Empty: all.
  std::vector<double> cumulative_;    ///< Twice the area of the triangles up to each.
};

}  // namespace papilla::detail
