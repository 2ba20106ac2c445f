// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "map_energy.hpp"

namespace papilla::param_detail {

/// φ E_l + (1-φ) E_f, see flatten_maillot(). An edge of two triangles belongs to each of them by half. The Hessian is
/// that of Gauss and Newton.
class MaillotEnergy final : public MapEnergy {
 public:
  /// @param across neighbours over the edges from corner k to the next, or k_no_triangle; three per triangle.
  MaillotEnergy(std::span<const Vec3> positions, std::span<const Triangle> triangles, std::span<const Index> across,
                double length_weight);
  MaillotEnergy(std::span<const Vec3> positions, std::span<const Triangle> triangles, double length_weight);

  /// What a map adds up to, whatever the weight of lengths.
  struct Sums {
    double length = 0, area = 0, squared_edges = 0;  ///< E_l, E_f, Σ D².
  };
  Sums sums(std::span<const Triangle> triangles, std::span<const Vec2> uv) const;

  double value(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const override;
  CornerGradient gradient(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const override;
  void hessian(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c, double raised, double* matrix) const override;

 private:
  struct Rest {
    double doubled_area = 0;
    double area_weight = 0;                        ///< (1-φ) / doubled area; 0 without area.
    std::array<double, 3> squared{};               ///< Lengths of the edges, from corner k to the next one.
    std::array<double, 3> length_weight{0, 0, 0};  ///< φ share / squared length; 0 without length.
    std::array<double, 3> share{0, 0, 0};          ///< 1, or 1/2 for edges of two triangles; 0 without length.
  };
  std::vector<Rest> rest_;
};

}  // namespace papilla::param_detail
