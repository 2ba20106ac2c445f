// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_mesh.hpp"

namespace papilla {

/// "coulomb", "bristle".
std::string_view name_of(FrictionModel model) noexcept;
std::optional<FrictionModel> friction_model(std::string_view name) noexcept;

/// μ(v) = μd + (μs − μd)·exp(−(v/vs)²), μs at rest [Stribeck].
double friction_coefficient(const ContactMaterial& material, double speed) noexcept;

/// By what share a smoothed sliding speed follows the newest in a tick: 1 − exp(−T/10 ms). The memory of friction
/// (frictional lag: Armstrong-Hélouvry, Dupont and Canudas de Wit 1994), the same at every rate; 10 ms is assumed.
double friction_memory_share(double period_s) noexcept;

/// Friction by the bristles between two surfaces [Dahl 1968; Canudas de Wit, Olsson, Åström and Lischinsky 1995,
/// without their damping]: with x the way of the probe along the surface, v its speed, N the load and z the bend of the
/// bristles,
///     dz = dx − σ|dx|·z/(μ(v)·N),   F = −σ·z
/// A pull from rest meets a spring of stiffness σ, F(x) = −μN·(1 − exp(−σx/μN)) at constant μ, which gives way at
/// μs·N, and slides at μ(v)·N; slow pulls through a spring stick and slip. The equation is solved exactly over a tick
/// in which the probe goes straight, so that no rate and no σ makes it unstable. The bend never exceeds μs·N/σ,
/// whatever the load does.
///
/// σ is bristle_stiffness, at most the material's stiffness, which is what a device is known to hold. noexcept, no
/// allocation, deterministic; finite for finite input.
class BristleFriction {
 public:
  /// @param normal unit. @param load_n ≥ 0. @param moved of the probe in this tick, metres.
  /// @returns the force on the probe, newtons, along the surface.
  Vec3 force(const ContactMaterial& material, Vec3 normal, double load_n, Vec3 moved, double period_s) noexcept;

  /// Nothing is bent; for a probe that has let go.
  void release() noexcept { bend_ = {}, speed_ = 0; }

 private:
  Vec3 bend_;         // m
  double speed_ = 0;  // m/s, smoothed.
};

}  // namespace papilla
