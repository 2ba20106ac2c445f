// SPDX-License-Identifier: MIT
#include "papilla/haptic/force_model.hpp"

#include <algorithm>

namespace papilla {

Vec3 heightfield_force(const ContactSurface& surface, const ProxyState& state, Vec3 probe, Vec3 velocity) noexcept {
  if (!state.in_contact || !(state.load_m > 0)) return {};
  const ContactMaterial& material = surface.material(state.material);
  const Vec3 back = state.proxy - probe, n = state.normal;
  const Vec3 along = back - dot(back, n) * n;
  const double push = material.stiffness * state.load_m - material.damping * dot(velocity, n);
  return std::max(0.0, push) * state.shaded_normal + material.stiffness * along;
}

}  // namespace papilla
