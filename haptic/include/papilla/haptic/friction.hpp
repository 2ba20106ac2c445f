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
double friction_coefficient(const ContactConstants& material, double speed) noexcept;

/// Weight of the newest speed in the smoothed sliding speed: 1 − exp(−T/10 ms), a first-order lag that is the same at
/// every rate (frictional memory: Armstrong-Hélouvry, Dupont and Canudas de Wit 1994); 10 ms is assumed.
double friction_memory_share(double period_s) noexcept;

/// Bristle friction [Dahl 1968; Canudas de Wit, Olsson, Åström and Lischinsky 1995, without their damping]. With x the
/// tangential path of the probe, v its speed, N the load and z the deflection of the bristles,
///     dz = dx − σ|dx|·z/(μ(v)·N),   F = −σ·z
/// From rest it is a spring of stiffness σ, F(x) = −μN·(1 − exp(−σx/μN)) at constant μ; it breaks away at μs·N and
/// slides at μ(v)·N; a slow pull through a spring sticks and slips. The equation is integrated exactly over a tick with
/// a straight path, so it is stable for every rate and σ. |z| ≤ μs·N/σ for every load.
///
/// σ is bristle_stiffness, at most the material's stiffness, which is known to be stable. For a material with Coulomb's
/// friction, where no proxy has it, σ is the stiffness and z = dx until it breaks away at once,
///     z ← z + dx,   |z| ≤ μ(v)·N/σ,   v the speed at which it slips
/// which is the friction of a proxy on a plane. noexcept, no allocation,
/// deterministic; finite for finite input.
class BristleFriction {
 public:
  /// @param normal unit. @param load_n ≥ 0. @param moved displacement of the probe in this tick, metres.
  /// @returns the tangential force on the probe in newtons.
  Vec3 force(const ContactMaterial& material, Vec3 normal, double load_n, Vec3 moved, double period_s) noexcept;

  /// Zero deflection; for a probe without contact.
  void release() noexcept { deflection_ = {}, speed_ = 0; }

 private:
  Vec3 deflection_;   // m
  double speed_ = 0;  // m/s, smoothed.
};

}  // namespace papilla
