// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "rest_shape.hpp"

namespace papilla::param_detail {

/// Gradient by the three corners.
using CornerGradient = std::array<Vec2, 3>;

/// A symmetric 6 × 6 matrix over (u0, v0, u1, v1, u2, v2), column major, lower half filled.
using CornerHessian = std::array<double, 36>;

/// An energy that is a sum over the triangles of a map. Values of maps that turn a triangle over may be infinite.
class MapEnergy {
 public:
  virtual ~MapEnergy() = default;
  virtual double value(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const = 0;
  virtual CornerGradient gradient(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const = 0;
  /// A matrix close to the Hessian.
  /// @param raised the part of its negative curvature that is left out; 1 makes it positive semidefinite.
  virtual void hessian(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c, double raised, double* matrix) const = 0;
};

/// Area-weighted symmetric Dirichlet energy: Σ A (σ1² + σ2² + σ1⁻² + σ2⁻²); 4 Σ A at an isometry.
/// The Hessian is exact but for its one eigenvalue that can be negative, the in-plane rotation, which is raised towards
/// 0 [B. Smith, F. de Goes, T. Kim, Analytic eigensystems for isotropic distortion energies, 2019].
class SymmetricDirichlet final : public MapEnergy {
 public:
  explicit SymmetricDirichlet(std::span<const RestShape> rest) : rest_(rest) {}
  double value(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const override;
  CornerGradient gradient(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const override;
  void hessian(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c, double raised, double* matrix) const override;

 private:
  std::span<const RestShape> rest_;
};

}  // namespace papilla::param_detail
