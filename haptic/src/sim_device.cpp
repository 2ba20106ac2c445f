// SPDX-License-Identifier: MIT
#include "papilla/haptic/sim_device.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr std::string_view k_chai = "CHAI3D 3.3.0 device table";
constexpr std::string_view k_assumed = "assumed";
/// b is chosen so that 2b/(T + 2·t_d) at 1 kHz is the largest closed-loop stiffness that CHAI3D's table gives.
constexpr std::string_view k_from_limit = "assumed: the damping that CHAI3D's largest stiffness at 1 kHz implies";

constexpr double k_delay = 1e-3;
constexpr double damping_for(double largest_stiffness) { return largest_stiffness * (1e-3 + 2 * k_delay) / 2; }

constexpr DevicePreset preset(std::string_view name, std::string_view title, double force, double radius,
                              double stiffness, double mass, double friction, double step) {
  return {name,
          title,
          {force, k_chai},
          {radius, k_chai},
          {mass, k_assumed},
          {damping_for(stiffness), k_from_limit},
          {friction, k_assumed},
          {step, k_assumed},
          {k_delay, "assumed: one full-speed USB frame"},
          {k_default_probe_radius_m, "assumed: a blunt pen tip"}};
}

constexpr DevicePreset k_presets[] = {
    preset("touch", "Touch", 3.3, 0.075, 400, 0.045, 0.26, 55e-6),
    preset("omni", "Phantom Omni", 3.3, 0.10, 700, 0.045, 0.26, 55e-6),
    preset("desktop", "Phantom Desktop", 7.9, 0.10, 1000, 0.045, 0.06, 23e-6),
    preset("premium15", "Phantom Premium 1.5", 8.5, 0.12, 800, 0.075, 0.04, 30e-6),
    preset("falcon", "Novint Falcon", 8, 0.04, 3000, 0.15, 0.3, 60e-6),
    preset("omega3", "omega.3", 12, 0.075, 5000, 0.2, 0.1, 10e-6),
    preset("lambda7", "lambda.7", 12, 0.1125, 8000, 0.3, 0.1, 10e-6),
};

constexpr double k_longest_step_s = 5e-5;

double quantised(double x, double step) noexcept { return step > 0 ? step * std::round(x / step) : x; }

}  // namespace

DeviceCaps DevicePreset::caps() const {
  return {"sim:" + std::string(name),
          max_force_n.value,
          workspace_radius_m.value,
          {mass_kg.value, damping.value, friction_n.value, encoder_step_m.value, delay_s.value},
          probe_radius_m.value};
}

std::span<const DevicePreset> device_presets() noexcept { return k_presets; }

const DevicePreset& device_preset(std::string_view name) {
  std::string names;
  for (const DevicePreset& candidate : k_presets) {
    if (candidate.name == name) return candidate;
    names += (names.empty() ? "" : ", ") + std::string(candidate.name);
  }
  throw DeviceError("device sim:" + std::string(name) + ": there is no such preset, only " + names);
}

SimDevice::SimDevice(const DeviceCaps& caps, const Trajectory& hand, double period_s, const HandCoupling& coupling)
    : caps_(caps), hand_(&hand), period_(period_s), coupling_(coupling), position_(hand.samples().front().position) {
  const DeviceDynamics& d = caps.dynamics;
  for (const double value : {d.mass_kg, d.damping, d.friction_n, d.encoder_step_m, d.delay_s, caps.max_force_n,
                             period_s, coupling.stiffness, coupling.damping})
    if (!(value >= 0) || !std::isfinite(value)) throw InvalidInput("SimDevice: a number of the device is not >= 0");
  if (!(period_s > 0) || !(d.mass_kg > 0)) throw InvalidInput("SimDevice: period and mass must be > 0");
  if (d.delay_s > 60 * period_s) throw InvalidInput("SimDevice: the delay is longer than 60 periods");
}

double SimDevice::time_s() const noexcept { return hand_->start_s() + static_cast<double>(tick_) * period_; }

/// The force written `delay` before tick + offset.
Vec3 SimDevice::delayed_force(std::uint64_t tick, double offset_s) const noexcept {
  const double late = caps_.dynamics.delay_s - offset_s;
  const auto back = late > 0 ? static_cast<std::uint64_t>(std::ceil(late / period_ * (1 - 1e-12))) : 0;
  return back > tick ? Vec3{} : force_[(tick - back) % k_history];
}

/// Integrates one period from tick_ on. Between steps force, spring and hand velocity are constant, so that
/// m·v' = G − C·v with C = b + B has a closed form; friction then shortens the new velocity by f_c·φ.
void SimDevice::advance() noexcept {
  const DeviceDynamics& d = caps_.dynamics;
  const Vec3 hand0 = hand_->position(time_s());
  const Vec3 hand1 = hand_->position(hand_->start_s() + static_cast<double>(tick_ + 1) * period_);
  const Vec3 hand_velocity = (1 / period_) * (hand1 - hand0);
  const int steps = std::max(1, static_cast<int>(std::ceil(period_ / k_longest_step_s * (1 - 1e-9))));
  const double h = period_ / steps, c = d.damping + coupling_.damping;
  const double decay = std::exp(-c * h / d.mass_kg);
  const double phi = c > 0 ? -std::expm1(-c * h / d.mass_kg) / c : h / d.mass_kg;  // ∂v/∂G over a step.
  const double psi = c > 0 ? (h - d.mass_kg * phi) / c : 0.5 * h * h / d.mass_kg;  // ∂x/∂G over a step.
  for (int i = 0; i < steps; ++i) {
    const double offset = i * h;
    const Vec3 hand = hand0 + (offset / period_) * (hand1 - hand0);
    const Vec3 g =
        delayed_force(tick_, offset) + coupling_.stiffness * (hand - position_) + coupling_.damping * hand_velocity;
    const Vec3 free_velocity = decay * velocity_ + phi * g;
    const Vec3 free_way = (d.mass_kg * phi) * velocity_ + psi * g;
    const double speed = norm(free_velocity), lost = d.friction_n * phi;
    const double kept = speed > lost ? 1 - lost / speed : 0;
    const Vec3 before = velocity_, moved = kept * free_way;
    position_ = position_ + moved;
    velocity_ = kept * free_velocity;
    // ∫ F_h·v with the spring as it was held; ∫ v² of a velocity that is close to linear within a step.
    const double square = h / 3 * (dot(before, before) + dot(before, velocity_) + dot(velocity_, velocity_));
    hand_work_ += dot(coupling_.stiffness * (hand - position_ + moved) + coupling_.damping * hand_velocity, moved) -
                  coupling_.damping * square;
  }
  ++tick_;
  force_[tick_ % k_history] = force_[(tick_ - 1) % k_history];
}

bool SimDevice::read(DeviceState& state) noexcept {
  if (started_) advance();
  started_ = true;
  const double step = caps_.dynamics.encoder_step_m;
  state.position = {quantised(position_.x, step), quantised(position_.y, step), quantised(position_.z, step)};
  state.age_s = 0;
  state.buttons = 0;
  return true;
}

bool SimDevice::write(Vec3 force_n) noexcept {
  force_[tick_ % k_history] = force_n;
  return true;
}

void SimDevice::stop() noexcept { force_.fill({}); }

}  // namespace papilla
