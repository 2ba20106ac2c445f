// SPDX-License-Identifier: MIT
#include "papilla/haptic/haptic_loop.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"

namespace papilla {
namespace {

constexpr int k_priority = 80;  // Below the kernel's own threads at 99, above interrupt threads at 50.
constexpr std::uint64_t k_longest_recording = 20'000'000;
constexpr double k_longest_frame_s = 0.05;    // The guard reports a device that is silent for longer.
constexpr double k_largest_lag_periods = 10;  // After a longer stall the schedule is moved instead of caught up.
// Wake-up before a tick, as a share of the period and at most; the rest is spun.
constexpr double k_early_share = 0.05, k_longest_spin_s = 5e-5;

double thread_cpu_seconds() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Schedule of the ticks.
class Pacer {
 public:
  Pacer(LoopClock& clock, double period_s) noexcept
      : clock_(clock),
        period_s_(period_s),
        early_s_(std::min(k_early_share * period_s, k_longest_spin_s)),
        start_s_(clock.now_s()) {}

  /// Sleeps until just before tick `i` and spins until it is due. @returns the lateness in microseconds; nothing when
  /// the tick is overdue already, so that one stall counts once, as in cyclictest.
  std::optional<double> wait(std::uint64_t i) noexcept {
    const double due = due_s(i);
    if (clock_.now_s() >= due) return std::nullopt;
    clock_.sleep_until(due - early_s_);
    double now = clock_.now_s();
    while (now < due) now = clock_.now_s();
    return (now - due) * 1e6;
  }

  /// After tick `i` - 1: how many ticks have missed their deadline since, 1 when tick `i` is overdue. After a long
  /// stall the later ticks are moved, and those that fall out count.
  std::uint64_t missed_before(std::uint64_t i) noexcept {
    const double late = clock_.now_s() - due_s(i);
    if (!(late > 0)) return 0;
    return late > k_largest_lag_periods * period_s_ ? 1 + skip_overdue(i) : 1;
  }

  /// Moves the schedule by whole periods, so that tick `i` was due less than a period ago.
  /// @returns by how many: the ticks that fall out.
  std::uint64_t skip_overdue(std::uint64_t i) noexcept {
    const double periods = std::max(0.0, std::floor((clock_.now_s() - due_s(i)) / period_s_));
    start_s_ += periods * period_s_;
    return static_cast<std::uint64_t>(periods);
  }

 private:
  double due_s(std::uint64_t i) const noexcept { return start_s_ + period_s_ * static_cast<double>(i + 1); }

  LoopClock& clock_;
  double period_s_, early_s_, start_s_;
};

/// Fixed priority and locked memory for its lifetime, where the system grants them.
class Realtime {
 public:
  explicit Realtime(LoopResult& result) {
    sched_param parameters{};
    policy_ = sched_getscheduler(0);
    sched_getparam(0, &before_);
    parameters.sched_priority = k_priority;
    const auto note = [&](const char* what) {
      if (!result.realtime_note.empty()) result.realtime_note += "; ";
      result.realtime_note += std::string(what) + " refused (" + std::strerror(errno) + ")";
    };
    fixed_ = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
    if (!fixed_) note("SCHED_FIFO");
    locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    if (!locked_) note("mlockall");
    // While this file is open, processors stay out of deep sleep states.
    constexpr std::int32_t k_no_latency = 0;
    latency_ = ::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    if (latency_ >= 0 && ::write(latency_, &k_no_latency, sizeof k_no_latency) < 0) note("/dev/cpu_dma_latency");
    result.fixed_priority = fixed_;
    result.memory_locked = locked_;
  }
  ~Realtime() {
    if (latency_ >= 0) ::close(latency_);
    if (locked_) munlockall();
    if (fixed_) sched_setscheduler(0, policy_, &before_);
  }
  Realtime(const Realtime&) = delete;
  Realtime& operator=(const Realtime&) = delete;

 private:
  int policy_ = SCHED_OTHER, latency_ = -1;
  sched_param before_{};
  bool fixed_ = false, locked_ = false;
};

/// Stops the device at the end of its scope.
class StopAtEnd {
 public:
  explicit StopAtEnd(HapticDevice& device) noexcept : device_(device) {}
  ~StopAtEnd() {
    device_.write({});
    device_.stop();
  }
  StopAtEnd(const StopAtEnd&) = delete;
  StopAtEnd& operator=(const StopAtEnd&) = delete;

 private:
  HapticDevice& device_;
};

void publish_status(LoopStatus& status, const LoopResult& result, double force_n, double tick_us,
                    double late_us) noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  status.ticks.store(result.ticks, relaxed);
  status.contact_ticks.store(result.contact_ticks, relaxed);
  status.lost_contact_ticks.store(result.lost_contact_ticks, relaxed);
  status.missed_deadlines.store(result.missed_deadlines, relaxed);
  status.force_n.store(force_n, relaxed);
  status.tick_us.store(tick_us, relaxed);
  status.wakeup_us.store(late_us, relaxed);
}

void append(std::string& text, double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, error == std::errc() ? end : buffer);
}

}  // namespace

LoopResult run_haptic_loop(HapticDevice& device, const ContactSurface& surface, const LoopOptions& options) {
  if (!(options.rate_hz >= 1) || !(options.rate_hz <= 1e5))
    throw InvalidInput("run_haptic_loop: the rate of " + std::to_string(options.rate_hz) + " Hz is not in [1, 100000]");
  if (options.record && options.ticks > k_longest_recording)
    throw InvalidInput("run_haptic_loop: a recording of " + std::to_string(options.ticks) + " ticks is longer than " +
                       std::to_string(k_longest_recording));
  LoopResult result;
  const double period = 1 / options.rate_hz;
  const double start_s = options.hand ? options.hand->start_s() : 0;
  if (options.record) {
    options.record->clear();
    options.record->resize(options.ticks);  // Touches every page, so that none faults in the loop.
  }
  SafetyLimits limits = safety_limits(device.caps().max_force_n);
  limits.watchdog_s = options.watchdog_s;
  HapticTick tick(surface, limits, period);
  if (options.control_passivity) tick.control_passivity(device.caps().dynamics);
  if (options.real_part) tick.follow(*options.real_part);
  const StopAtEnd stop_at_end(device);
  {
    const bool timed = device.is_clock() || options.paced;
    std::optional<Realtime> realtime;
    if (timed) realtime.emplace(result);
    LoopClock system;
    LoopClock& clock = options.clock ? *options.clock : system;
    const double begin = clock.now_s();
    double awake = begin;  // When the last tick began.
    Pacer pacer(clock, period);
    while (result.ticks < options.ticks && !(options.stop && options.stop->load(std::memory_order_relaxed))) {
      const std::uint64_t i = result.ticks;
      std::optional<double> late_us;
      if (device.is_clock())
        late_us = 1e6 * device.wait(k_longest_frame_s);
      else if (options.paced)
        late_us = pacer.wait(i);
      if (late_us) result.wakeup_us.add(*late_us);
      const double stood_s = clock.now_s() - awake - period;
      const bool stood_still = timed && i > 0 && stood_s > options.watchdog_s;
      if (stood_still) {
        ++result.pauses;
        result.longest_pause_s = std::max(result.longest_pause_s, stood_s);
        result.missed_deadlines +=
            device.is_clock() ? static_cast<std::uint64_t>(stood_s / period) : pacer.skip_overdue(i);
        if (device.is_clock()) device.wait(k_longest_frame_s);  // What was queued in the meantime is old.
      }
      awake = clock.now_s();
      const double before = thread_cpu_seconds();
      DeviceState state;
      result.device_lost = !device.read(state);
      if (result.device_lost) break;
      if (stood_still) tick.reset(state.position);
      Vec3 force = tick(state);
      if (timed && clock.now_s() - awake > options.watchdog_s) force = {};  // Stopped since the read: it is old.
      result.device_lost = !device.write(force);
      const double tick_us = (thread_cpu_seconds() - before) * 1e6;
      result.tick_us.add(tick_us);

      ++result.ticks;
      if (device.is_clock())
        result.missed_deadlines += clock.now_s() - awake > period;
      else if (options.paced)
        result.missed_deadlines += pacer.missed_before(i + 1);
      if (tick.proxy().in_contact) ++result.contact_ticks;
      if (tick.lost()) ++result.lost_contact_ticks;
      result.max_force_n = std::max(result.max_force_n, norm(force));
      if (options.record || options.latest || !options.recent.empty()) {
        const double t = start_s + static_cast<double>(i) * period;
        const RecordRow row = {t,
                               options.hand ? options.hand->position(t) : state.position,
                               state.position,
                               tick.proxy().proxy,
                               force,
                               tick.proxy().in_contact};
        if (options.record) (*options.record)[i] = row;
        if (!options.recent.empty()) options.recent[i % options.recent.size()] = row;
        if (options.latest) options.latest->store(row);
      }
      if (options.status) publish_status(*options.status, result, norm(force), tick_us, late_us.value_or(0));
      result.fault = tick.guard().fault();
      if (result.device_lost || result.fault != ForceGuard::Fault::none) break;
    }
    result.seconds = clock.now_s() - begin;
    result.passivity_interventions = tick.passivity_interventions();
  }
  if (options.record) options.record->resize(result.ticks);
  return result;
}

std::string record_csv(std::span<const RecordRow> rows) {
  std::string text = "t,x,y,z,probe_x,probe_y,probe_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,contact\n";
  for (const RecordRow& row : rows) {
    append(text, row.t);
    for (const Vec3& v : {row.hand, row.probe, row.proxy, row.force})
      for (const double value : {v.x, v.y, v.z}) {
        text += ',';
        append(text, value);
      }
    text += row.in_contact ? ",1\n" : ",0\n";
  }
  return text;
}

}  // namespace papilla
