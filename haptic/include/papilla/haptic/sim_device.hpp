// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "papilla/haptic/device.hpp"
#include "papilla/haptic/trajectory.hpp"

namespace papilla {

/// A number of a device preset and its source; "assumed" when no measurement is known.
struct Sourced {
  double value = 0;
  std::string_view source;
};

/// One simulated device.
struct DevicePreset {
  std::string_view name, title;
  Sourced max_force_n, workspace_radius_m, mass_kg, damping, friction_n, encoder_step_m, delay_s, probe_radius_m;
  DeviceCaps caps() const;
};

/// touch (the default, first), omni, desktop, premium15, falcon, omega3, lambda7.
std::span<const DevicePreset> device_presets() noexcept;

/// @throws DeviceError listing the names when there is none of this name.
const DevicePreset& device_preset(std::string_view name);

/// The grip of the hand: a spring and a damper between the trajectory and the handle.
struct HandCoupling {
  double stiffness = 1000;  ///< N/m; assumed: a firm pen grip.
  double damping = 5;       ///< N·s/m; assumed.
};

/// A simulated device:
///     m·a = F(t − t_d) + K(x_h − x) + B(v_h − v) − b·v − f_c·v/|v|
/// with the force held between ticks, sticking while the sum of the other forces is below f_c, and positions quantised
/// to Δ. Integrated in steps of at most 50 µs: linear damping exactly (exponential), Coulomb friction implicitly, so
/// that it never reverses the motion. Each read() after the first advances by one period. Deterministic: the same calls
/// give the same bits. noexcept, no allocation.
class SimDevice final : public HapticDevice {
 public:
  /// @param hand must outlive the device; it starts at hand.start_s() and the handle at rest at its first position.
  /// @throws InvalidInput when the period or a number of the caps is not finite or negative, the period or mass zero,
  ///         or the delay longer than 60 periods.
  SimDevice(const DeviceCaps& caps, const Trajectory& hand, double period_s, const HandCoupling& coupling = {});

  const DeviceCaps& caps() const noexcept override { return caps_; }
  bool read(DeviceState& state) noexcept override;
  bool write(Vec3 force_n) noexcept override;
  void stop() noexcept override;

  double time_s() const noexcept;                                   ///< Of the newest position.
  Vec3 hand() const noexcept { return hand_->position(time_s()); }  ///< Position of the trajectory.
  Vec3 true_position() const noexcept { return position_; }
  Vec3 velocity() const noexcept { return velocity_; }
  /// Work of the hand on the handle in joules: the passivity observer of the port between hand and device. From rest it
  /// never becomes negative when device and wall are passive; an unstable contact does work on the hand.
  double hand_work_j() const noexcept { return hand_work_; }

 private:
  static constexpr std::size_t k_history = 64;
  void advance() noexcept;
  Vec3 delayed_force(std::uint64_t tick, double offset_s) const noexcept;

  DeviceCaps caps_;
  const Trajectory* hand_;
  double period_;
  HandCoupling coupling_;
  Vec3 position_, velocity_;
  double hand_work_ = 0;
  std::uint64_t tick_ = 0;
  bool started_ = false;
  std::array<Vec3, k_history> force_{};  // force_[i % k_history] is held during tick i.
};

}  // namespace papilla
