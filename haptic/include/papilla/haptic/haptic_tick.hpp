// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/contact_audit.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/proxy.hpp"
#include "papilla/haptic/safety.hpp"
#include "papilla/haptic/stimulus.hpp"

namespace papilla {

/// From a position to the force to write: proxy, force model, safety. noexcept, no allocation, no lock, no system call.
class HapticTick {
 public:
  /// @param surface must outlive the object; its materials should be stable for the device (see clamp_to_stable()).
  HapticTick(const ContactSurface& surface, const SafetyLimits& limits, double period_s) noexcept
      : surface_(&surface), period_(period_s), proxy_(surface), audit_(surface), stimulus_(surface), guard_(limits) {}

  /// @returns the force on the hand in newtons.
  Vec3 operator()(const DeviceState& device) noexcept {
    const Vec3 probe = device.position;
    // Wall damping acts on a velocity that is smoothed over k_smoothing_s: differences of encoder steps are noise.
    const double share = period_ / (period_ + k_smoothing_s);
    if (started_) velocity_ = velocity_ + share * ((1 / period_) * (probe - last_) - velocity_);
    last_ = probe;
    started_ = true;
    const ProxyState& state = proxy_.update(probe, period_);
    lost_ = audit_.lost(probe, state.in_contact);
    // A probe that is no number gives no force, not the one of the tick before.
    Vec3 force = is_finite(probe) ? heightfield_force(*surface_, state, probe, velocity_) : probe;
    if (is_finite(probe) && stimulus_.acts(state)) force = stimulus_.force(state, probe, velocity_, period_, force);
    return guard_.apply(force, period_, device.age_s);
  }

  /// Puts the probe somewhere without touching what lies between; clears a fault, and forces fade in again.
  void reset(Vec3 position) noexcept {
    proxy_.reset(position);
    audit_ = ContactAudit(*surface_);
    guard_.resume();
    velocity_ = {};
    last_ = position;
    started_ = true;
    lost_ = false;
  }

  const ProxyState& proxy() const noexcept { return proxy_.state(); }
  bool lost() const noexcept { return lost_; }  ///< The last tick lost its contact.
  ForceGuard& guard() noexcept { return guard_; }

 private:
  static constexpr double k_smoothing_s = 1e-3;
  const ContactSurface* surface_;
  double period_;
  Proxy proxy_;
  ContactAudit audit_;
  Stimulus stimulus_;
  ForceGuard guard_;
  Vec3 last_, velocity_;
  bool started_ = false, lost_ = false;
};

}  // namespace papilla
