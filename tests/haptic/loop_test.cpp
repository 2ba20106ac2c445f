// SPDX-License-Identifier: MIT
#include "papilla/haptic/haptic_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_audit.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/stroke.hpp"

namespace papilla {
namespace {

ContactSurface stable_plate() {
  ContactMaterial material;
  material.stiffness = 2000;
  material.static_friction = 0.3;
  material.dynamic_friction = 0.2;
  ContactSurface surface(testing::plate(20, 20, 0.1, 0.1), {material}, {}, 0);
  clamp_to_stable(surface, device_preset("touch").caps().dynamics, 1e-3);
  return surface;
}

struct Played {
  LoopResult result;
  std::vector<RecordRow> rows;
};

Played play(const ContactSurface& surface, const Trajectory& hand, std::uint64_t ticks) {
  SimDevice device(device_preset("touch").caps(), hand, 1e-3);
  Played run;
  LoopOptions options;
  options.ticks = ticks;
  options.paced = false;
  options.hand = &hand;
  options.record = &run.rows;
  run.result = run_haptic_loop(device, surface, options);
  return run;
}

TEST(HapticLoop, StrokeIsFeltAndNeverLost) {
  const ContactSurface surface = stable_plate();
  const Trajectory hand = press_and_stroke(surface, 0, {0.05, 0.05, 0}, {});
  const Played run = play(surface, hand, 2000);
  EXPECT_EQ(run.result.ticks, 2000U);
  EXPECT_GT(run.result.contact_ticks, 1700U);
  EXPECT_EQ(run.result.lost_contact_ticks, 0U);
  EXPECT_EQ(run.result.tick_us.count(), 2000U);
  // At rest the spring of the hand (1000 N/m) and the wall (400 N/m) share 1 mm, up to the friction.
  EXPECT_NEAR(run.result.max_force_n, 1e-3 * 400 * 1000 / 1400, 0.15);
  EXPECT_FALSE(run.result.device_lost);
}

/// The loop wakes before a tick is due and spins.
TEST(HapticLoop, TicksBeginWhenTheyAreDue) {
  const ContactSurface surface = stable_plate();
  const Trajectory hand = press_and_stroke(surface, 0, {0.05, 0.05, 0}, {});
  for (const double rate : {100.0, 1000.0, 10000.0}) {
    SimDevice device(device_preset("touch").caps(), hand, 1 / rate);
    LoopOptions options;
    options.rate_hz = rate;
    options.ticks = 10;
    const LoopResult result = run_haptic_loop(device, surface, options);
    EXPECT_GE(result.seconds, 10 / rate);
    EXPECT_LE(result.wakeup_us.count(), 10U);
  }
}

TEST(HapticLoop, RecordingPlayedAgainGivesTheSameBits) {
  const ContactSurface surface = stable_plate();
  const Trajectory hand = press_and_stroke(surface, 0, {0.05, 0.05, 0}, {});
  const std::string first = record_csv(play(surface, hand, 1000).rows);
  const std::string second = record_csv(play(surface, parse_trajectory(first, "first"), 1000).rows);
  EXPECT_EQ(first, second);
}

TEST(HapticLoop, OthersSeeTheNewestTick) {
  const ContactSurface surface = stable_plate();
  const Trajectory hand = press_and_stroke(surface, 0, {0.05, 0.05, 0}, {});
  SimDevice device(device_preset("touch").caps(), hand, 1e-3);
  LatestSlot<RecordRow> slot;
  LoopOptions options;
  options.ticks = 300;
  options.paced = false;
  options.hand = &hand;
  options.latest = &slot;
  run_haptic_loop(device, surface, options);
  RecordRow seen;
  EXPECT_EQ(slot.load(seen), 300U);
  EXPECT_EQ(record_csv({&seen, 1}), record_csv({&play(surface, hand, 300).rows.back(), 1}));
}

TEST(HapticLoop, StopEndsItAndLeavesNoForce) {
  class Counting final : public HapticDevice {
   public:
    const DeviceCaps& caps() const noexcept override { return caps_; }
    bool read(DeviceState& state) noexcept override {
      state.position = {0.05, 0.05, reads_ == 0 ? 0.01 : -0.001};
      if (++reads_ == 50) stop_flag = true;
      return reads_ < fail_at;
    }
    bool write(Vec3 force) noexcept override {
      last = force;
      largest = std::max(largest, norm(force));
      return true;
    }
    void stop() noexcept override { ++stops; }
    std::atomic<bool> stop_flag{false};
    int fail_at = 1000, stops = 0;
    Vec3 last;
    double largest = 0;

   private:
    DeviceCaps caps_{"counting", 3, 0.1, {}};
    int reads_ = 0;
  };
  const ContactSurface surface = stable_plate();
  LoopOptions options;
  options.paced = false;
  Counting stopped;
  options.stop = &stopped.stop_flag;
  EXPECT_EQ(run_haptic_loop(stopped, surface, options).ticks, 50U);
  EXPECT_GT(stopped.largest, 0);
  EXPECT_EQ(stopped.last, Vec3{});
  EXPECT_EQ(stopped.stops, 1);

  Counting lost;
  lost.fail_at = 20;
  options.stop = nullptr;
  const LoopResult result = run_haptic_loop(lost, surface, options);
  EXPECT_TRUE(result.device_lost);
  EXPECT_EQ(result.ticks, 19U);
  EXPECT_EQ(lost.last, Vec3{});
  EXPECT_EQ(lost.stops, 1);
}

/// Every look takes a microsecond, sleeping takes what it should.
class FakeClock final : public LoopClock {
 public:
  double now_s() noexcept override { return now_s_ += 1e-6; }
  void sleep_until(double time_s) noexcept override { now_s_ = std::max(now_s_, time_s); }
  void jump(double seconds) noexcept { now_s_ += seconds; }

 private:
  double now_s_ = 5;
};

/// Presses a millimetre into the plate, and stands still for `pause_s` while tick `pause_at` is read or written. After
/// that the hand is somewhere else: it lifts for 20 ticks and presses again.
class PausingDevice final : public HapticDevice {
 public:
  PausingDevice(FakeClock& clock, int pause_at, double pause_s, bool in_write, bool is_clock)
      : clock_(clock), pause_at_(pause_at), pause_s_(pause_s), in_write_(in_write), is_clock_(is_clock) {}
  const DeviceCaps& caps() const noexcept override { return caps_; }
  bool is_clock() const noexcept override { return is_clock_; }
  double wait(double) noexcept override {
    clock_.jump(1e-3);
    ++waits;
    return 0;
  }
  bool read(DeviceState& state) noexcept override {
    const int tick = static_cast<int>(forces.size());
    const int since = tick > pause_at_ ? tick - pause_at_ - 16 : tick;  // Once as the force fades in, and once more.
    const bool lifted = since < 5 || (since >= 100 && since < 105);
    state.position = {0.05, 0.05, lifted ? 0.01 : -0.001};
    if (tick == pause_at_ && !in_write_) clock_.jump(pause_s_);
    return true;
  }
  bool write(Vec3 force) noexcept override {
    if (static_cast<int>(forces.size()) == pause_at_ && in_write_) clock_.jump(pause_s_);
    if (forces.size() < forces.capacity()) forces.push_back(force);
    return true;
  }
  void stop() noexcept override {}
  std::vector<Vec3> forces;
  int waits = 0;

 private:
  FakeClock& clock_;
  DeviceCaps caps_{"pausing", 3, 0.1, {}};
  int pause_at_;
  double pause_s_;
  bool in_write_, is_clock_;
};

struct PausedRun {
  LoopResult result;
  std::vector<Vec3> forces;
  std::vector<RecordRow> rows;
};

constexpr int k_pause_at = 200, k_paused_ticks = 400;

PausedRun play_with_pause(double pause_s, bool in_write, bool is_clock) {
  const ContactSurface surface = stable_plate();
  FakeClock clock;
  PausingDevice device(clock, k_pause_at, pause_s, in_write, is_clock);
  device.forces.reserve(k_paused_ticks);
  PausedRun run;
  LoopOptions options;
  options.ticks = k_paused_ticks;
  options.clock = &clock;
  options.record = &run.rows;
  run.result = run_haptic_loop(device, surface, options);
  run.forces = device.forces;
  return run;
}

/// The force on the wall at full depth is 0.4 N.
TEST(HapticLoop, ForceFadesInAgainAfterAPause) {
  for (const bool in_write : {false, true})
    for (const bool is_clock : {false, true}) {
      const PausedRun run = play_with_pause(3, in_write, is_clock);
      const auto force = [&](int tick) { return norm(run.forces[static_cast<std::size_t>(tick)]); };
      EXPECT_EQ(run.result.pauses, 1U);
      EXPECT_NEAR(run.result.longest_pause_s, 3, 2e-3);
      EXPECT_NEAR(static_cast<double>(run.result.missed_deadlines), 3000, 2);
      EXPECT_NEAR(force(k_pause_at - 1), 0.4, 1e-3);
      // Stopped between read and write: the force is old.
      EXPECT_NEAR(force(k_pause_at), in_write ? 0.4 : 0, 1e-3);
      const RecordRow& after = run.rows[k_pause_at + 1];
      EXPECT_EQ(after.proxy, after.probe);
      EXPECT_FALSE(after.in_contact);
      EXPECT_EQ(force(k_pause_at + 1), 0);
      for (int k = 1; k <= 50; ++k) EXPECT_LE(force(k_pause_at + 20 + k), 0.4 * k / 50 + 1e-3) << k;
      EXPECT_GT(force(k_pause_at + 80), 0);
      EXPECT_NEAR(force(k_pause_at + 130), 0.4, 1e-3);
    }
}

/// A probe that is inside after a pause stays free until it leaves: no force pushes it out of a wall that it is in.
TEST(HapticLoop, ProxyIsPutToTheProbeAfterAPause) {
  const ContactSurface surface(testing::box({0, 0, 0}, {0.1, 0.1, 0.1}), {ContactMaterial{}}, {}, 0);
  class Inside final : public HapticDevice {
   public:
    explicit Inside(FakeClock& clock) : clock_(clock) {}
    const DeviceCaps& caps() const noexcept override { return caps_; }
    bool read(DeviceState& state) noexcept override {
      state.position = {0.05, 0.05, tick_ < 5 ? 0.11 : 0.098};
      if (++tick_ == 100) clock_.jump(0.02);
      return true;
    }
    bool write(Vec3) noexcept override { return true; }
    void stop() noexcept override {}

   private:
    FakeClock& clock_;
    DeviceCaps caps_{"inside", 3, 0.1, {}};
    int tick_ = 0;
  };
  FakeClock clock;
  Inside device(clock);
  std::vector<RecordRow> rows;
  LoopOptions options;
  options.ticks = 200;
  options.clock = &clock;
  options.record = &rows;
  EXPECT_EQ(run_haptic_loop(device, surface, options).pauses, 1U);
  EXPECT_TRUE(rows[98].in_contact);
  for (std::size_t i = 100; i < rows.size(); ++i) EXPECT_EQ(rows[i].force, Vec3{}) << i;
}

TEST(HapticLoop, ShortPausesChangeNothingAndCount) {
  const PausedRun still = play_with_pause(0, false, false), late = play_with_pause(8e-3, false, false);
  EXPECT_EQ(late.result.pauses, 0U);
  EXPECT_EQ(still.result.missed_deadlines, 0U);
  EXPECT_NEAR(static_cast<double>(late.result.missed_deadlines), 8, 1);
  EXPECT_EQ(late.forces, still.forces);
}

TEST(HapticLoop, RefusesImpossibleRates) {
  const ContactSurface surface = stable_plate();
  const Trajectory hand(std::vector<Trajectory::Sample>{{0, {}}});
  SimDevice device(device_preset("touch").caps(), hand, 1e-3);
  for (const double rate : {0.0, -1.0, std::nan(""), 1e9}) {
    LoopOptions options;
    options.rate_hz = rate;
    EXPECT_THROW(run_haptic_loop(device, surface, options), InvalidInput);
  }
}

ProxyState free_at(Vec3 proxy) {
  ProxyState state;
  state.proxy = proxy;
  return state;
}

ProxyState held_at(Vec3 proxy) {
  ProxyState state = free_at(proxy);
  state.in_contact = true;
  state.normal = {0, 0, 1};
  return state;
}

TEST(ContactAudit, DetectsAProxyThatReleases) {
  const ContactSurface surface(testing::box({0, 0, 0}, {0.1, 0.1, 0.1}), {ContactMaterial{}}, {}, 0);
  ContactAudit audit(surface);
  const auto lost = [&](Vec3 probe, const ProxyState& state) { return audit.update(probe, state, {}); };
  const auto free = [&](Vec3 probe) { return lost(probe, free_at(probe)); };
  EXPECT_FALSE(free({0.03, 0.04, 0.12}));
  EXPECT_FALSE(lost({0.03, 0.04, 0.099}, held_at({0.03, 0.04, 0.10002})));
  EXPECT_TRUE(free({0.03, 0.04, 0.098}));
  EXPECT_TRUE(free({0.04, 0.04, 0.050}));
  EXPECT_TRUE(free({0.04, 0.04, 0.12}));  // Not from inside either.
  EXPECT_FALSE(free({0.04, 0.04, 0.13}));
  EXPECT_TRUE(free({0.04, 0.04, -0.13}));  // Through both sides at once.
  EXPECT_FALSE(free({0.04, 0.05, -0.13}));
}

TEST(ContactAudit, DetectsAProxyBehindAWall) {
  const ContactSurface surface(testing::plate(4, 4, 0.1, 0.1), {ContactMaterial{}}, {}, 0);
  ContactAudit audit(surface);
  EXPECT_FALSE(audit.update({0.03, 0.04, -0.001}, held_at({0.03, 0.04, 2e-5}), {}));
  EXPECT_TRUE(audit.update({0.03, 0.04, -0.001}, held_at({0.03, 0.04, -2e-5}), {}));
}

TEST(ContactAudit, DetectsAFreeProxyThatDoesNotFollow) {
  const ContactSurface surface(testing::plate(4, 4, 0.1, 0.1), {ContactMaterial{}}, {}, 0);
  ContactAudit audit(surface);
  EXPECT_FALSE(audit.update({0.03, 0.04, 0.02}, free_at({0.03, 0.04, 0.02}), {}));
  EXPECT_TRUE(audit.update({0.03, 0.04, -0.02}, free_at({0.03, 0.04, 0.01}), {}));
}

/// A path around a rim is accepted whatever the waypoints are; a path through the sheet is lost whatever they are.
TEST(ContactAudit, AcceptsThePathAroundARim) {
  const ContactSurface sheet(testing::plate(10, 10, 0.1, 0.1), {ContactMaterial{}}, {}, 0);
  const auto lost_after = [&](Vec3 held, Vec3 probe, std::vector<Vec3> turns) {
    ContactAudit audit(sheet);
    EXPECT_FALSE(audit.update({held.x, held.y, -0.002}, held_at(held), {}));
    return audit.update(probe, free_at(probe), turns);
  };
  const Vec3 above{0.0995, 0.05, 2e-5}, under{0.0992, 0.05, -0.002}, beyond{0.1001, 0.05, 0};
  EXPECT_FALSE(lost_after(above, {0.1005, 0.05, -0.002}, {{0.1001, 0.05, 2e-5}}));
  EXPECT_FALSE(lost_after(above, under, {beyond}));
  EXPECT_TRUE(lost_after(above, under, {}));
  EXPECT_TRUE(lost_after(above, under, {{0.0999, 0.05, 0.001}}));
  EXPECT_TRUE(lost_after({0.05, 0.05, 2e-5}, {0.05, 0.05, -0.002}, {}));
}

TEST(ContactAudit, DetectsAProxyInsideTheRelief) {
  ContactMaterial material;
  material.height = 0;
  HeightFieldOptions options;
  options.scale_m = 1e-3;
  const ContactSurface surface(testing::plate(4, 4, 0.1, 0.1), {material}, {HeightField(1, 1, {65535}, options)}, 0);
  ContactAudit audit(surface);
  EXPECT_FALSE(audit.update({0.03, 0.04, 2e-3}, free_at({0.03, 0.04, 2e-3}), {}));
  EXPECT_TRUE(audit.update({0.03, 0.04, 5e-4}, free_at({0.03, 0.04, 5e-4}), {}));
}

TEST(Stroke, StaysAtItsDepthAndSpeedOnASphere) {
  const ContactSurface surface(testing::sphere(200, 0.05), {ContactMaterial{}}, {}, 0);
  const Trajectory hand = press_and_stroke(surface, 0, {0, 0, 0.06}, {});
  EXPECT_GE(hand.end_s(), 2);
  const auto& samples = hand.samples();
  for (std::size_t i = 2; i < samples.size(); ++i) {
    EXPECT_NEAR(norm(samples[i].position), 0.049, 2e-4);
    EXPECT_NEAR(norm(samples[i].position - samples[i - 1].position) / (samples[i].t - samples[i - 1].t), 0.1, 1e-6);
  }
  EXPECT_THROW(press_and_stroke(surface, 1, {}, {}), InvalidInput);
}

/// Two plates that look at each other across a gap of 4 mm, and one behind the upper one.
TEST(Stroke, BeginsBeforeTheWallOnTheOtherSide) {
  const ContactMesh plate = testing::plate(4, 4, 0.1, 0.1);
  ContactMesh facing;
  facing.positions = plate.positions, facing.triangles = plate.triangles;
  for (const double z : {4e-3, 5e-3}) {
    const auto first = static_cast<std::uint32_t>(facing.positions.size());
    for (const Vec3& p : plate.positions) facing.positions.push_back({p.x, p.y, z});
    for (const auto& [a, b, c] : plate.triangles) facing.triangles.push_back({first + a, first + c, first + b});
  }
  for (const double radius : {0.0, 1e-3}) {
    const ContactSurface surface(facing, {ContactMaterial{}}, {}, radius);
    const Vec3 start = press_and_stroke(surface, 0, {0.05, 0.05, 0}, {}).samples().front().position;
    EXPECT_GT(start.z, radius + 0.5e-3);
    EXPECT_LT(start.z, 4e-3 - radius);
  }
  const ContactSurface open(plate, {ContactMaterial{}}, {}, 1e-3);
  EXPECT_NEAR(press_and_stroke(open, 0, {0.05, 0.05, 0}, {}).samples().front().position.z, 6e-3, 1e-12);
}

/// Counter-clockwise as seen from outside, on a plate that looks along +z and on one along -z.
TEST(Stroke, CirclesTurnLeftWithTheirRadius) {
  StrokeOptions options;
  options.motion = Motion::circle;
  options.circle_m = 0.015;
  ContactMesh plate = testing::plate(10, 10, 0.1, 0.1);
  for (const double side : {1.0, -1.0}) {
    const Trajectory hand =
        press_and_stroke(ContactSurface(plate, {ContactMaterial{}}, {}, 0), 0, {0.05, 0.05, 0}, options);
    const auto& samples = hand.samples();
    double turn = 0, way = 0;
    for (std::size_t i = 3; i < samples.size(); ++i) {
      const Vec3 before = samples[i - 1].position - samples[i - 2].position,
                 after = samples[i].position - samples[i - 1].position;
      turn += std::asin(side * cross(before, after).z / (norm(before) * norm(after)));
      way += norm(after);
    }
    ASSERT_GT(way, 0.1);
    EXPECT_NEAR(turn, way / options.circle_m, 1e-3 * turn) << side;
    for (auto& triangle : plate.triangles) std::swap(triangle[1], triangle[2]);
  }
}

TEST(Trajectory, ReadsCsvWithHeadingCommentsAndFurtherColumns) {
  const Trajectory t = parse_trajectory("t,x,y,z\n# comment\n0,1,2,3\r\n\n 0.5 , 2, 2 ,3, 9, text\n", "T.csv");
  ASSERT_EQ(t.samples().size(), 2U);
  EXPECT_EQ(t.position(0.25), (Vec3{1.5, 2, 3}));
  EXPECT_EQ(t.position(-1), (Vec3{1, 2, 3}));
  EXPECT_EQ(t.position(7), (Vec3{2, 2, 3}));
}

TEST(Trajectory, NamesTheLineThatIsWrong) {
  const auto message = [](const char* csv) -> std::string {
    try {
      parse_trajectory(csv, "T.csv");
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("0,1,2,3\n0,1,2,3\n").find("T.csv:2: the time"), std::string::npos);
  EXPECT_NE(message("0,1,2,3\n1,1,2\n").find("T.csv:2: column 4"), std::string::npos);
  EXPECT_NE(message("0,1,2,3\n1;1;2;3\n").find("T.csv:2: column 1"), std::string::npos);
  EXPECT_NE(message("0,1,2,3\n1,1e20,2,3\n").find("T.csv:2: a position is farther"), std::string::npos);
  EXPECT_NE(message("0,nan,2,3\n").find("T.csv:1"), std::string::npos);
  EXPECT_NE(message("0,1,2,1e999\n").find("T.csv:1"), std::string::npos);
  EXPECT_NE(message("").find("T.csv: holds no line"), std::string::npos);
  EXPECT_NE(message("t,x\nheading,again\n").find("T.csv:2"), std::string::npos);
}

TEST(Histogram, QuantilesOfKnownNumbers) {
  Histogram h;
  for (int i = 1; i <= 1000; ++i) h.add(i);
  EXPECT_NEAR(h.quantile(0.5), 500, 500 * 0.011);
  EXPECT_NEAR(h.quantile(0.99), 990, 990 * 0.011);
  EXPECT_EQ(h.max(), 1000);
  EXPECT_EQ(h.quantile(1), 1000);
  EXPECT_EQ(Histogram().quantile(0.5), 0);

  Histogram slow, both;
  for (int i = 1001; i <= 2000; ++i) slow.add(i);
  both.add(h);
  both.add(slow);
  EXPECT_EQ(both.count(), 2000U);
  EXPECT_EQ(both.max(), 2000);
  EXPECT_NEAR(both.quantile(0.5), 1000, 1000 * 0.011);
  EXPECT_NEAR(both.quantile(0.75), 1500, 1500 * 0.011);
}

}  // namespace
}  // namespace papilla
