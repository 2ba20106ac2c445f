// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// From a probe x below the textured surface to the closest point c of that surface, metres; zero above it.
///
/// The textured surface is the relief over the base, c = b + (h(b) + r)·n: where the centre of a ball of radius r is
/// when it touches the relief, of which h is the dilation. The skin is no part of it. The closest point can't be
/// farther from the foot of the probe than √(d² − z²), d the depth below the surface along the normal and z that below
/// the lowest relief; there the distance is sampled at two rings of six places, and descended [BFGS with Armijo's rule]
/// from the two nearest of these, of the foot and of the proxy. It depends on the place of the probe only, so a spring
/// along it gives back what was put in. The direction turns at once where two places are equally near.
///
/// The proxy, which is swept and held by the same relief without friction, says which side the probe came from. When
/// what is nearest is another side, or another sheet before or behind it, the way leads to the proxy instead: nothing
/// is tunnelled through.
///
/// noexcept, no allocation, deterministic; finite for finite input. Cost: at most 65 closest points and a segment; in
/// the median 21 on waves of 2.5 mm, 36 on waves of 0.3 mm, up to 1.2 mm deep. Limits: on grains much finer than the
/// depth, a nearer place between the samples can be missed.
Vec3 way_to_textured_surface(const ContactSurface& surface, const ProxyState& state, Vec3 probe) noexcept;

/// The force of the model `textured-normal` without its friction [Cho 2017], newtons. With w the way to the textured
/// surface, n = w/|w| and N = spring_force() at the depth |w|, k·|w| without a backing:
///     F = n·(N − clamp(b·(v·n), ±N))
/// 0 at the textured surface, whatever the speed. BristleFriction adds friction for the load |F|.
/// @param velocity of the probe, m/s.
Vec3 textured_normal_force(const ContactMaterial& material, Vec3 way, Vec3 velocity) noexcept;

}  // namespace papilla
