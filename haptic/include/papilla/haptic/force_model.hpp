// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// The force model `heightfield` on the probe in newtons: with n the direction in which the surface holds the proxy, δ
/// the depth of the probe behind it and τ the way from the probe to the proxy along the surface,
///     F = n·max(0, k·δ − b·(v·n)) + k·τ
/// A spring of stiffness k, damping b of the wall that never pulls the probe in, and friction, which the proxy has
/// limited to μ·δ already. The first n is the felt normal, which may be smoothed over facets. Zero when free, and never
/// NaN for finite input.
/// @param velocity of the probe, m/s.
Vec3 heightfield_force(const ContactSurface& surface, const ProxyState& state, Vec3 probe, Vec3 velocity) noexcept;

}  // namespace papilla
