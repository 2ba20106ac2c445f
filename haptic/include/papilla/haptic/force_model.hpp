// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// The force of the model `heightfield` on the probe in newtons. With n = state.normal, n' = state.shaded_normal,
/// δ = state.load_m and τ the tangential part of proxy − probe:
///     F = n'·max(0, k·δ − b·(v·n)) + k·τ
/// A spring of stiffness k, wall damping b that never pulls the probe in, and friction: the proxy limits |τ| to μδ.
/// Zero when free; never NaN for finite input.
/// @param velocity of the probe, m/s.
Vec3 heightfield_force(const ContactSurface& surface, const ProxyState& state, Vec3 probe, Vec3 velocity) noexcept;

}  // namespace papilla
