// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "papilla/haptic/contact_audit.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/friction.hpp"
#include "papilla/haptic/proxy.hpp"
#include "papilla/haptic/real_part.hpp"
#include "papilla/haptic/safety.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/haptic/textured_normal.hpp"

namespace papilla {

/// From a position to the force to write: proxy, force model, safety. noexcept, no allocation, no lock, no system call.
class HapticTick {
 public:
  /// @param surface must outlive the object; its materials should be stable for the device (see clamp_to_stable()).
  HapticTick(const ContactSurface& surface, const SafetyLimits& limits, double period_s)
      : surface_(&surface), period_(period_s), proxy_(surface), audit_(surface), stimulus_(surface), guard_(limits) {}

  /// Enables the PassivityController, for devices whose DeviceDynamics are stated too well. clamp_to_stable() comes
  /// first.
  void control_passivity(const DeviceDynamics& device) { passivity_.emplace(device); }
  /// The hand moves on a real part from now on: the force is RealPart::force() of the device's position.
  void follow(const RealPart& part) { real_part_.emplace(part); }
  std::uint64_t passivity_interventions() const noexcept { return passivity_ ? passivity_->interventions() : 0; }

  /// @returns the force on the hand in newtons.
  Vec3 operator()(const DeviceState& device) noexcept {
    const Vec3 probe = device.position;
    // An invalid position gives no force: the guard stops on NaN.
    if (!ContactSurface::is_valid_position(probe)) {
      lost_ = false;
      return guard_.apply(k_no_force, period_, device.age_s);
    }
    if (real_part_) return guard_.apply(real_part_->force(probe), period_, device.age_s);
    // Wall damping acts on a velocity smoothed over k_smoothing_s: differences of encoder steps are noise.
    const Vec3 moved = started_ ? probe - last_ : Vec3{};
    const double share = period_ / (period_ + k_smoothing_s);
    if (started_) velocity_ = velocity_ + share * ((1 / period_) * (probe - last_) - velocity_);
    last_ = probe;
    started_ = true;
    const ProxyState& state = proxy_.update(probe, period_);
    lost_ = audit_.update(probe, state, proxy_.waypoints());
    Vec3 force = contact_force(state, probe, moved);
    if (stimulus_.acts(state)) force = stimulus_.force(state, probe, velocity_, period_, force);
    if (passivity_) force = passivity_->apply(force, moved, period_);
    return guard_.apply(force, period_, device.age_s, contact_step(state, moved));
  }

  /// Puts the probe to `position` without contact on the way; clears a fault, and forces fade in again.
  void reset(Vec3 position) noexcept {
    proxy_.reset(position);
    audit_ = ContactAudit(*surface_);
    guard_.resume();
    bristles_.release();
    velocity_ = {};
    last_ = position;
    started_ = true;
    lost_ = false;
  }

  const ProxyState& proxy() const noexcept { return real_part_ ? real_part_->state() : proxy_.state(); }
  bool lost() const noexcept { return lost_; }  ///< ContactAudit: the last tick lost its contact.
  ForceGuard& guard() noexcept { return guard_; }

 private:
  ContactStep contact_step(const ProxyState& state, Vec3 moved) const noexcept {
    if (!state.in_contact) return {};
    const ContactMaterial& material = surface_->material(state.material);
    const double skin = state.constants.stiffness;
    const double backing = std::isfinite(material.backing_depth_m) ? material.backing_stiffness : skin;
    // The stiffest bounds how the force changes, the softest what it stores.
    return {true, std::max(skin, backing) * std::abs(dot(state.normal, moved)), std::min(skin, backing), moved};
  }

  /// Springs, damping and friction. Coulomb's friction of `heightfield` is in the proxy.
  Vec3 contact_force(const ProxyState& state, Vec3 probe, Vec3 moved) noexcept {
    ContactMaterial material = surface_->material(state.material);
    if (state.in_contact) static_cast<ContactConstants&>(material) = state.constants;
    const bool textured = material.model == ForceModel::textured_normal;
    const Vec3 way = textured ? way_to_textured_surface(*surface_, state, probe) : Vec3{};
    const Vec3 force = textured ? textured_normal_force(material, way, velocity_)
                                : heightfield_force(*surface_, state, probe, velocity_);
    if (!state.in_contact || (!textured && material.friction != FrictionModel::bristle)) {
      bristles_.release();
      return force;
    }
    const Vec3 normal = textured ? normalized(way) : state.normal;
    const double load = textured ? norm(force) : spring_force(material, material.stiffness, state.load_m);
    return force + bristles_.force(material, normal, load, moved, period_);
  }

  static constexpr double k_smoothing_s = 1e-3;  // Of the velocity.
  static constexpr double k_no_number = std::numeric_limits<double>::quiet_NaN();
  static constexpr Vec3 k_no_force{k_no_number, k_no_number, k_no_number};
  const ContactSurface* surface_;
  double period_;
  Proxy proxy_;
  ContactAudit audit_;
  Stimulus stimulus_;
  BristleFriction bristles_;
  ForceGuard guard_;
  std::optional<PassivityController> passivity_;
  std::optional<RealPart> real_part_;
  Vec3 last_, velocity_;
  bool started_ = false, lost_ = false;
};

}  // namespace papilla
