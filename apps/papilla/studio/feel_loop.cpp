// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/feel_loop.hpp"

#include <chrono>
#include <optional>
#include <thread>

#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/vibration.hpp"

namespace papilla::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double k_behind_s = 0.03;  // The hand is played so long after it moved.
constexpr double k_silent_s = 3;     // A page tells the place of its pointer 60 times a second.

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// When ticks are due.
class Pace {
 public:
  /// Waits until the tick is due. @returns whether it is late by more than a period.
  bool wait(double due_s) const {
    const double late = seconds_since(begin_) - k_behind_s - due_s;
    if (late < 0) std::this_thread::sleep_for(std::chrono::duration<double>(-late));
    return late > 1 / k_feel_rate_hz;
  }

 private:
  const Clock::time_point begin_ = Clock::now();
};

/// What a device needs of the hand's path for its way from the tick before to this one. It counts time from `first`.
Trajectory piece_of(const Trajectory::Sample& first, const Trajectory::Sample& before, const Trajectory::Sample& now) {
  if (before.t > first.t) return Trajectory({first, before, now});
  return Trajectory({first, now});
}

std::optional<FeelEnd> end_of(const HandPath& path, double t, ForceGuard::Fault fault, bool stops) {
  if (stops) return FeelEnd::stopped;
  if (fault != ForceGuard::Fault::none) return FeelEnd::fault;
  if (const auto lifted = path.lifted_s(); lifted && t >= *lifted) return FeelEnd::lifted;
  if (t > path.newest_s() + k_silent_s) return FeelEnd::silent;
  return std::nullopt;
}

}  // namespace

FeelEnd run_feel_loop(const ContactSurface& surface, const DeviceCaps& caps, HandPath& path,
                      const std::function<void(const FeelBatch&)>& tell, const std::atomic<bool>& stops) {
  constexpr double k_period = 1 / k_feel_rate_hz;
  const Trajectory::Sample first{path.begin_s(), path.position(path.begin_s())};
  Trajectory hand({first});
  Trajectory::Sample before = first;
  SimDevice device(caps, hand, k_period);
  HapticTick tick(surface, safety_limits(caps.max_force_n), k_period);
  VibrationOptions sound;
  sound.rate_hz = k_feel_rate_hz;
  sound.sample_rate_hz = k_feel_sound_hz;
  Vibration vibration(surface, sound);
  FeelBatch batch;
  const Pace pace;
  for (std::uint64_t i = 0;; ++i) {
    const double t = first.t + static_cast<double>(i) * k_period;
    if (pace.wait(t - first.t)) ++batch.late;
    const Trajectory::Sample now{t, path.position(t)};
    if (i > 0) hand = piece_of(first, before, now);
    before = now;
    DeviceState state;
    device.read(state);
    const Vec3 force = tick(state);
    device.write(force);
    const ProxyState& proxy = tick.proxy();
    batch.rows.push_back({t, now.position, state.position, proxy.proxy, force, proxy.normal, proxy.in_contact});
    vibration.tick({proxy.proxy, norm(force), proxy.in_contact}, batch.sound);
    const std::optional<FeelEnd> end = end_of(path, t, tick.guard().fault(), stops);
    if (!end && batch.rows.size() < FeelBatch::k_ticks) continue;
    tell(batch);
    batch.rows.clear();
    batch.sound.clear();
    if (end) return *end;
  }
}

}  // namespace papilla::app
