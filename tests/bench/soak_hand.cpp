// SPDX-License-Identifier: MIT
#include "soak_hand.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "papilla/haptic/haptic_tick.hpp"

namespace papilla::bench {
namespace {

constexpr double k_period_s = 1e-3, k_free_m = 8e-3;
constexpr double k_energy_tolerance_j = 1e-6;  // Rounding.

/// Collects the samples of a random hand.
class RandomHand {
 public:
  RandomHand(const ContactSurface& surface, std::uint64_t seed)
      : surface_(surface), random_(seed), extent_(norm(surface.high() - surface.low())) {
    here_ = place();
    samples_.push_back({0, above(k_free_m)});
  }

  double time_s() const { return samples_.back().t; }
  std::vector<Trajectory::Sample> take() { return std::move(samples_); }

  void act() {
    switch (random_() % 8) {
      case 0: return plunge();
      case 1: return tap();
      case 2: return vibrate();
      case 3: return rest();
      case 4: return visit(place());
      default: return stroke();
    }
  }

 private:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  /// Slow as often as fast.
  double speed() { return std::exp(between(std::log(0.02), std::log(0.5))); }
  double depth() { return between(-5e-4, 3e-3); }
  Vec3 above(double height_m) const { return here_.point + (surface_.probe_radius_m() + height_m) * here_.face_normal; }

  SurfacePoint place() {
    for (;;) {
      const Vec3 size = surface_.high() - surface_.low();
      const Vec3 p = surface_.low() + Vec3{between(0, 1) * size.x, between(0, 1) * size.y, between(0, 1) * size.z};
      if (const auto found = surface_.closest_point(p, 2 * extent_)) return *found;
    }
  }

  void go(Vec3 to, double speed_m_per_s) {
    const double way = norm(to - samples_.back().position);
    samples_.push_back({time_s() + std::max(way / speed_m_per_s, 1e-3), to});
  }

  void visit(SurfacePoint next) {
    go(above(k_free_m), speed());
    here_ = next;
    go(above(k_free_m), 0.5);
    go(above(-depth()), speed());
  }

  void stroke() {
    const double way = between(5e-3, 6e-2), step = 1e-3, fast = speed();
    Vec3 direction = normalized(cross(here_.face_normal, Vec3{between(-1, 1), between(-1, 1), between(-1, 1)}));
    double deep = depth();
    for (double gone = 0; gone < way; gone += step) {
      const auto next = surface_.closest_point(here_.point + step * direction, step);
      if (!next || norm(next->point - here_.point) < 0.1 * step) return;
      here_ = *next;
      direction = normalized(direction - dot(direction, here_.face_normal) * here_.face_normal);
      deep = std::clamp(deep + between(-1e-4, 1e-4), -5e-4, 3e-3);
      go(above(-deep), fast);
    }
  }

  void tap() {
    const int taps = static_cast<int>(between(1, 6));
    const double fast = speed();
    for (int i = 0; i < taps; ++i) {
      go(above(between(5e-4, 3e-3)), fast);
      go(above(-depth()), fast);
    }
  }

  void vibrate() {
    const double hertz = between(2, 30), size_m = between(1e-4, 2e-3), seconds = between(0.1, 0.5), deep = depth();
    const double begin = time_s();
    for (double t = 2e-3; t < seconds; t += 2e-3) {
      const double at = deep + size_m * std::sin(2 * std::numbers::pi * hertz * t);
      samples_.push_back({begin + t, above(-at)});
    }
  }

  void rest() { samples_.push_back({time_s() + between(0.05, 1), samples_.back().position}); }

  /// Through the surface and back.
  void plunge() {
    const double fast = speed();
    go(above(-between(3e-3, 1.5e-2)), fast);
    go(above(k_free_m), fast);
  }

  const ContactSurface& surface_;
  std::mt19937_64 random_;
  double extent_;
  SurfacePoint here_;
  std::vector<Trajectory::Sample> samples_;
};

/// Energy of the hand on the device from one free flight to the next.
class EpisodeEnergy {
 public:
  explicit EpisodeEnergy(double mass_kg) : mass_(mass_kg) {}

  void update(const SimDevice& device, bool free, SoakRun& run) {
    const double work = device.hand_work_j(), kinetic = 0.5 * mass_ * dot(device.velocity(), device.velocity());
    const double step = work - last_work_;
    last_work_ = work;
    if (free) {
      if (open_ && ++free_ticks_ >= k_settled_ticks) close(work, kinetic, run);
      if (!open_) start_work_ = work, start_kinetic_ = kinetic;
      return;
    }
    if (!open_) put_in_ = 0;
    open_ = true;
    free_ticks_ = 0;
    put_in_ += std::max(0.0, step);
    run.put_in_j += std::max(0.0, step);
    run.returned_j -= std::min(0.0, step);
  }

 private:
  static constexpr int k_settled_ticks = 5;  // The force has fallen to zero and has reached the handle.

  void close(double work, double kinetic, SoakRun& run) {
    const double kept = (work - start_work_) - (kinetic - start_kinetic_);
    run.least_kept_j = std::min(run.least_kept_j, kept);
    run.active_episodes += kept < -k_energy_tolerance_j;
    if (put_in_ > k_energy_tolerance_j) run.least_kept_share = std::min(run.least_kept_share, kept / put_in_);
    ++run.episodes;
    open_ = false;
  }

  double mass_, last_work_ = 0, start_work_ = 0, start_kinetic_ = 0, put_in_ = 0;
  int free_ticks_ = 0;
  bool open_ = false;
};

}  // namespace

void SoakRun::add(const SoakRun& o) noexcept {
  ticks += o.ticks, contact_ticks += o.contact_ticks, lost += o.lost, not_finite += o.not_finite;
  too_strong += o.too_strong, too_steep += o.too_steep, faults += o.faults, episodes += o.episodes;
  active_episodes += o.active_episodes;
  put_in_j += o.put_in_j, returned_j += o.returned_j;
  largest_share = std::max(largest_share, o.largest_share);
  longest_step = std::max(longest_step, o.longest_step);
  least_kept_j = std::min(least_kept_j, o.least_kept_j);
  least_kept_share = std::min(least_kept_share, o.least_kept_share);
}

Trajectory random_hand(const ContactSurface& surface, std::uint64_t seed, double seconds) {
  RandomHand hand(surface, seed);
  while (hand.time_s() < seconds) hand.act();
  return Trajectory(hand.take());
}

SoakRun soak(const ContactSurface& surface, const DevicePreset& preset, std::uint64_t seed, double seconds) {
  constexpr double k_rounding = 1 + 1e-9, k_steady_share = 0.02;
  constexpr int k_new_ticks = 2;
  const DeviceCaps caps = preset.caps();
  const Trajectory hand = random_hand(surface, seed, seconds);
  SimDevice device(caps, hand, k_period_s);
  const auto tick = std::make_unique<HapticTick>(surface, safety_limits(caps.max_force_n), k_period_s);
  EpisodeEnergy energy(caps.dynamics.mass_kg);
  SoakRun run;
  Vec3 last_force, last_probe;
  int in_contact = 0;
  for (auto left = static_cast<std::uint64_t>(seconds / k_period_s); left > 0; --left) {
    DeviceState state;
    device.read(state);
    const Vec3 force = (*tick)(state);
    device.write(force);
    const ProxyState& proxy = tick->proxy();
    const double size = norm(force);
    ++run.ticks;
    run.contact_ticks += proxy.in_contact;
    run.lost += tick->lost();
    run.not_finite += !is_finite(force) || !is_finite(proxy.proxy);
    run.too_strong += size > k_rounding * caps.max_force_n;
    run.faults += tick->guard().fault() != ForceGuard::Fault::none;
    run.largest_share = std::max(run.largest_share, size / caps.max_force_n);
    if (in_contact >= k_new_ticks && proxy.in_contact) {
      const double spring =
          surface.material(proxy.material).stiffness * std::abs(dot(proxy.normal, state.position - last_probe));
      const double step = norm(force - last_force) / std::max(k_steady_share * caps.max_force_n, spring);
      run.longest_step = std::max(run.longest_step, step);
      run.too_steep += step > k_rounding;
    }
    in_contact = proxy.in_contact ? in_contact + 1 : 0;
    last_force = force;
    last_probe = state.position;
    energy.update(device, !proxy.in_contact && size == 0, run);
  }
  return run;
}

}  // namespace papilla::bench
