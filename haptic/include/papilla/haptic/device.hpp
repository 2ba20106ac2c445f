// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "papilla/core/vec.hpp"

namespace papilla {

/// The properties of a force device that decide whether a contact is stable.
struct DeviceDynamics {
  double mass_kg = 0;         ///< Apparent mass at the handle.
  double damping = 0;         ///< b, N·s/m: physical damping of the device, without control.
  double friction_n = 0;      ///< f_c, Coulomb friction at the handle.
  double encoder_step_m = 0;  ///< Δ, smallest step of the position.
  double delay_s = 0;         ///< t_d, from writing a force to its effect, without the hold of the loop.
};

/// Radius of the probe of a device that states none, and where there is no device. A fingertip is no point, and a point
/// is held by a relief wherever its slope is above 1/μ.
inline constexpr double k_default_probe_radius_m = 5e-4;

struct DeviceCaps {
  std::string name;
  double max_force_n = 0;
  double workspace_radius_m = 0;
  DeviceDynamics dynamics;
  double probe_radius_m = k_default_probe_radius_m;
};

struct DeviceState {
  Vec3 position;     ///< m, in the frame of the scene.
  double age_s = 0;  ///< Time since the device reported it.
  std::uint32_t buttons = 0;
};

/// A force device with three degrees of freedom. The loop calls read() and write() once a tick; both are noexcept and
/// neither allocates.
class HapticDevice {
 public:
  HapticDevice() = default;
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;
  virtual ~HapticDevice() = default;

  virtual const DeviceCaps& caps() const noexcept = 0;
  /// Whether the device's own frames set the pace: then the loop calls wait() before each read() instead of sleeping.
  virtual bool is_clock() const noexcept { return false; }
  /// Waits for the next fresh position, at most `longest_s`. @returns the age of that position in seconds.
  virtual double wait(double longest_s) noexcept { return 0 * longest_s; }
  /// The newest position. @returns false when the device is lost.
  virtual bool read(DeviceState& state) noexcept = 0;
  /// Sets the force on the hand in newtons. @returns false when the device is lost.
  virtual bool write(Vec3 force_n) noexcept = 0;
  /// Zero force and actuators off. May be called at any time and repeatedly.
  virtual void stop() noexcept = 0;
};

}  // namespace papilla
