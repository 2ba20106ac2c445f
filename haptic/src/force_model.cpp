// SPDX-License-Identifier: MIT
#include "papilla/haptic/force_model.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {

double spring_force(const ContactMaterial& material, double stiffness, double depth_m) noexcept {
  const double beyond = std::max(0.0, depth_m - material.backing_depth_m);
  return stiffness * (depth_m - beyond) + material.backing_stiffness * beyond;
}

double energy_by_stiffness(const ContactMaterial& material, double depth_m) noexcept {
  const double skin = std::min(depth_m, material.backing_depth_m);
  return skin * (depth_m - 0.5 * skin);
}

Vec3 heightfield_force(const ContactSurface& surface, const ProxyState& state, Vec3 probe, Vec3 velocity) noexcept {
  if (!state.in_contact || !(state.load_m > 0)) return {};
  const ContactMaterial& material = surface.material(state.material);
  const Vec3 back = state.proxy - probe, n = state.normal;
  const Vec3 along = back - dot(back, n) * n;
  const double way = std::hypot(state.load_m, norm(along));
  const double secant = way <= material.backing_depth_m ? state.constants.stiffness
                                                        : spring_force(material, state.constants.stiffness, way) / way;
  const double push = secant * state.load_m - state.constants.damping * dot(velocity, n);
  return std::max(0.0, push) * state.shaded_normal + secant * along;
}

}  // namespace papilla
