// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// Force in newtons of a skin over its backing that is pressed in by δ ≥ 0 metres, continuous at the backing's depth D:
///     N(δ) = k·δ                  δ ≤ D
///     N(δ) = k·D + K·(δ − D)      δ > D
/// K and D are the material's. @param stiffness k of the skin, N/m.
double spring_force(const ContactMaterial& material, double stiffness, double depth_m) noexcept;

/// ∂W/∂k of the energy W(δ) = ∫ N dδ that is stored then: δ²/2, beyond D: D·(δ − D/2).
double energy_by_stiffness(const ContactMaterial& material, double depth_m) noexcept;

/// The force of the model `heightfield` on the probe in newtons. With n = state.normal, n' = state.shaded_normal,
/// δ = state.load_m, τ the tangential part of proxy − probe, k and b of state.constants, and the secant of the spring
/// κ = N(d)/d at d = √(δ² + |τ|²), which is k without a backing:
///     F = n'·max(0, κ·δ − b·(v·n)) + κ·τ
/// A spring along the way to the proxy, which gives back what was put in while the proxy rests, wall damping b that
/// never pulls the probe in, and friction: the proxy limits |τ| to μδ.
/// Zero when free; never NaN for finite input.
/// @param velocity of the probe, m/s.
Vec3 heightfield_force(const ContactSurface& surface, const ProxyState& state, Vec3 probe, Vec3 velocity) noexcept;

}  // namespace papilla
