// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/safety.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"

namespace papilla {
namespace {

Trajectory rest() { return Trajectory(std::vector<Trajectory::Sample>{{0, {0, 0, 0}}}); }

DeviceCaps device(double mass, double damping, double friction, double step, double delay) {
  return {"test", 10, 0.1, {mass, damping, friction, step, delay}};
}

double last_position(SimDevice& sim, int ticks, Vec3 force) {
  DeviceState state;
  sim.read(state);
  for (int i = 0; i < ticks; ++i) {
    sim.write(force);
    sim.read(state);
  }
  return state.position.x;
}

TEST(SimDevice, FreeMassWithDamperHasItsClosedForm) {
  const double m = 0.1, b = 0.5, f = 0.2, t = 0.4;
  const Trajectory hand = rest();
  SimDevice sim(device(m, b, 0, 0, 0), hand, 1e-3, {0, 0});
  const double x = last_position(sim, 400, {f, 0, 0});
  EXPECT_NEAR(x, f / b * (t - m / b * (1 - std::exp(-b * t / m))), 1e-12);
  EXPECT_NEAR(sim.velocity().x, f / b * (1 - std::exp(-b * t / m)), 1e-12);
}

TEST(SimDevice, WithoutDampingTheWayIsThatOfAConstantForce) {
  const Trajectory hand = rest();
  SimDevice sim(device(0.1, 0, 0, 0, 0), hand, 1e-3, {0, 0});
  EXPECT_NEAR(last_position(sim, 100, {0.2, 0, 0}), 0.2 * 0.1 * 0.1 / (2 * 0.1), 1e-12);
}

TEST(SimDevice, EveryAxisMovesAsItsForceAndIsRoundedToSteps) {
  const double step = 7e-5;
  const Trajectory hand = rest();
  SimDevice sim(device(0.1, 0.5, 0, step, 0), hand, 1e-3, {0, 0});
  const Vec3 force{0.2, -0.3, 0.5};
  DeviceState state;
  sim.read(state);
  for (int i = 0; i < 400; ++i) {
    sim.write(force);
    sim.read(state);
  }
  const Vec3 exact = (1 / 0.5 * (0.4 - 0.1 / 0.5 * (1 - std::exp(-0.5 * 0.4 / 0.1)))) * force;
  EXPECT_NEAR(state.position.x, step * std::round(exact.x / step), 1e-12);
  EXPECT_NEAR(state.position.y, step * std::round(exact.y / step), 1e-12);
  EXPECT_NEAR(state.position.z, step * std::round(exact.z / step), 1e-12);
}

/// A hand at rest that only damps: v = F/B (1 − exp(−Bt/m)), and what it takes is B ∫ v².
TEST(SimDevice, WorkOfADampingHandIsTheClosedForm) {
  const double m = 0.1, b = 0.5, f = 1, t = 5e-5;
  const Trajectory hand = rest();
  for (const int ticks : {1, 400}) {
    SimDevice sim(device(m, 0, 0, 0, 0), hand, t, {0, b});
    last_position(sim, ticks, {f, 0, 0});
    const double end = ticks * t, z = b * end / m;
    const double square = z < 1e-3
                              ? f * f / (m * m) * end * end * end / 3
                              : f * f / (b * b) * (end + m / b * (-1.5 + 2 * std::exp(-z) - 0.5 * std::exp(-2 * z)));
    EXPECT_NEAR(sim.hand_work_j() / (-b * square), 1, 1e-3) << ticks;
  }
}

TEST(SimDevice, FrictionHoldsUpToItsForceAndBrakesByIt) {
  const Trajectory hand = rest();
  SimDevice held(device(0.1, 0, 0.3, 0, 0), hand, 1e-3, {0, 0});
  EXPECT_EQ(last_position(held, 100, {0.29, 0, 0}), 0);
  SimDevice pushed(device(0.1, 0, 0.3, 0, 0), hand, 1e-3, {0, 0});
  EXPECT_NEAR(last_position(pushed, 100, {0.5, 0, 0}), 0.5 * (0.5 - 0.3) / 0.1 * 0.1 * 0.1, 1e-4);
  // Without the push it comes to rest and stays.
  DeviceState state;
  for (int i = 0; i < 300; ++i) {
    pushed.write({});
    pushed.read(state);
  }
  EXPECT_EQ(pushed.velocity(), Vec3{});
}

TEST(SimDevice, HandSpringSwingsWithItsFrequency) {
  const Trajectory hand = rest();
  const double m = 0.1, k = 100, c = 0.4, f = 1;
  SimDevice sim(device(m, c, 0, 0, 0), hand, 1e-3, {k, 0});
  const double t = 0.15, d = c / (2 * m), w = std::sqrt(k / m - d * d);
  const double expected = f / k * (1 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)));
  EXPECT_NEAR(last_position(sim, 150, {f, 0, 0}), expected, 0.005 * expected);
}

TEST(SimDevice, ForceArrivesAfterTheDelayAndPositionsAreSteps) {
  const Trajectory hand = rest();
  SimDevice sim(device(0.1, 1, 0, 1e-6, 3e-3), hand, 1e-3, {0, 0});
  DeviceState state;
  sim.read(state);
  int first_move = 0;
  for (int i = 1; i <= 10 && first_move == 0; ++i) {
    sim.write({5, 0, 0});
    sim.read(state);
    if (sim.velocity().x > 0) first_move = i;
    EXPECT_NEAR(std::remainder(state.position.x, 1e-6), 0, 1e-15);
  }
  EXPECT_EQ(first_move, 4);
}

TEST(SimDevice, EveryPresetIsCompleteAndSaysItsSources) {
  ASSERT_EQ(device_presets().size(), 7U);
  EXPECT_EQ(device_presets().front().name, "touch");
  for (const DevicePreset& p : device_presets())
    for (const Sourced& s :
         {p.max_force_n, p.workspace_radius_m, p.mass_kg, p.damping, p.friction_n, p.encoder_step_m, p.delay_s}) {
      EXPECT_GT(s.value, 0) << p.name;
      EXPECT_FALSE(s.source.empty()) << p.name;
    }
  EXPECT_EQ(device_preset("falcon").max_force_n.value, 8);
  EXPECT_THROW(device_preset("nothing"), DeviceError);
}

TEST(SimDevice, RefusesImpossibleNumbers) {
  const Trajectory hand = rest();
  EXPECT_THROW(SimDevice(device(0, 1, 0, 0, 0), hand, 1e-3), InvalidInput);
  EXPECT_THROW(SimDevice(device(1, -1, 0, 0, 0), hand, 1e-3), InvalidInput);
  EXPECT_THROW(SimDevice(device(1, 1, 0, 0, std::nan("")), hand, 1e-3), InvalidInput);
  EXPECT_THROW(SimDevice(device(1, 1, 0, 0, 1), hand, 1e-3), InvalidInput);
  EXPECT_THROW(SimDevice(device(1, 1, 0, 0, 0), hand, 0), InvalidInput);
}

TEST(Stability, LimitIsTheFormula) {
  EXPECT_DOUBLE_EQ(stiffness_limit({0.1, 0.5, 1e9, 1e-6, 0}, 1e-3, 0), 1000);  // 2b/T.
  EXPECT_DOUBLE_EQ(stiffness_limit({0.1, 0.5, 1e9, 1e-6, 1e-3}, 1e-3, 0),
                   1000.0 / 3);  // A frame of delay costs a factor 3.
  EXPECT_DOUBLE_EQ(stiffness_limit({0.1, 0.5, 1e9, 1e-6, 0}, 1e-3, 0.2), 600);
  EXPECT_DOUBLE_EQ(stiffness_limit({0.1, 0.5, 1e9, 1e-6, 0}, 1e-3, -0.2), 600);
  EXPECT_DOUBLE_EQ(stiffness_limit({0.1, 50, 0.2, 1e-3, 0}, 1e-3, 0), 400);  // 2 f_c/Δ.
  EXPECT_EQ(stiffness_limit({0.1, 0.5, 1, 1e-6, 0}, 1e-3, 0.7), 0);
  EXPECT_DOUBLE_EQ(stiffness_limit({0.1, 0.5, 0, 0, 0}, 1e-3, 0), 1000);
}

TEST(Stability, ClampsOnlyWhatIsTooStiff) {
  ContactMaterial soft, hard, damped;
  soft.stiffness = 200;
  hard.stiffness = 3000;
  damped.stiffness = 100;
  damped.damping = 9;
  ContactSurface surface(testing::plate(2, 2, 0.1, 0.1), {soft, hard, damped}, {}, 0);
  const auto clamps = clamp_to_stable(surface, {0.1, 0.5, 1e9, 1e-6, 0}, 1e-3);
  ASSERT_EQ(clamps.size(), 2U);
  EXPECT_EQ(clamps[0].material, 1U);
  EXPECT_EQ(clamps[0].stiffness_wanted, 3000);
  EXPECT_DOUBLE_EQ(surface.material(1).stiffness, 1000);
  EXPECT_EQ(clamps[1].material, 2U);
  EXPECT_DOUBLE_EQ(surface.material(2).damping, 0.25);
  EXPECT_DOUBLE_EQ(surface.material(2).stiffness, 100);
  EXPECT_EQ(surface.material(0).stiffness, 200);
}

SafetyLimits sharp() { return {.max_force_n = 2, .slew_n_per_s = 1e9, .soft_start_s = 0, .watchdog_s = 0.01}; }

TEST(ForceGuard, LimitsTheLengthAndKeepsTheDirection) {
  ForceGuard guard(sharp());
  const Vec3 out = guard.apply({30, 40, 0}, 1e-3, 0);
  EXPECT_NEAR(out.x, 1.2, 1e-12);
  EXPECT_NEAR(out.y, 1.6, 1e-12);
}

TEST(ForceGuard, LimitsTheChange) {
  SafetyLimits limits = sharp();
  limits.slew_n_per_s = 100;
  ForceGuard guard(limits);
  for (int i = 1; i <= 15; ++i) EXPECT_NEAR(guard.apply({0, 0, 5}, 1e-3, 0).z, std::min(2.0, 0.1 * i), 1e-12);
  EXPECT_NEAR(guard.apply({0, 0, -5}, 1e-3, 0).z, 1.5 - 0.1, 1e-12);
}

/// 2 % of the largest force a millisecond while a contact goes on; a new or a lost one is free to change in 2 ms.
TEST(ForceGuard, StepsAreSmallWhileAContactGoesOn) {
  SafetyLimits limits = safety_limits(3);
  limits.soft_start_s = 0;
  for (const double period : {1e-3, 2.5e-4}) {
    ForceGuard guard(limits);
    const auto ms = static_cast<int>(1e-3 / period + 0.5);
    const auto out = [&](double force, bool contact, double spring = 0) {
      return guard.apply({0, 0, force}, period, 0, {contact, spring}).z;
    };
    double last = 0;
    for (int i = 0; i < 2 * ms; ++i) last = out(1, true);
    EXPECT_EQ(last, 1);
    for (int i = 0; i < 5 * ms; ++i) {
      const double now = out(3, true);
      EXPECT_NEAR(now - last, 0.06 / ms, 1e-12);
      last = now;
    }
    for (int i = 0; i < 5 * ms; ++i) {
      const double now = out(-3, true);
      EXPECT_NEAR(last - now, 0.06 / ms, 1e-12);
      last = now;
    }
    // The hand itself goes in: the spring may follow, as far as a new contact may.
    const double most = std::min(0.5, 1.5 / ms);
    EXPECT_NEAR(out(1 + most, true, 0.5), 1 + most, 1e-12);
    last = out(3, true, 0.5);
    EXPECT_NEAR(last, 1 + 2 * most, 1e-12);
    for (int i = 0; i < 2 * ms; ++i) last = out(0, false);
    EXPECT_EQ(last, 0);
    EXPECT_NEAR(out(1, true), std::min(1.0, 1.5 / ms), 1e-12);
  }
}

TEST(ForceGuard, FadesInTheFirstForceAndAfterAResume) {
  SafetyLimits limits = sharp();
  limits.soft_start_s = 0.01;
  ForceGuard guard(limits);
  for (int i = 0; i < 5; ++i) guard.apply({}, 1e-3, 0);
  for (int round = 0; round < 2; ++round) {
    for (int i = 1; i <= 10; ++i) EXPECT_NEAR(guard.apply({1, 0, 0}, 1e-3, 0).x, 0.1 * i, 1e-12);
    EXPECT_EQ(guard.apply({1, 0, 0}, 1e-3, 0).x, 1);
    guard.resume();
  }
}

TEST(ForceGuard, FadingInGivesNoEnergyToAHandInAWall) {
  constexpr double k_stiffness = 1000, k_period = 1e-3;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> rate(1, 60), size(5e-4, 3e-3), turn(0, 2 * std::numbers::pi);
  double largest = 0;
  for (int hand = 0; hand < 200; ++hand) {
    const double a = size(random), b = size(random), f = rate(random), g = rate(random), phase = turn(random);
    const auto depth_at = [&](double t) {
      return a * std::sin(2 * std::numbers::pi * f * t) +
             b * (std::sin(2 * std::numbers::pi * g * t + phase) - std::sin(phase));
    };
    ForceGuard guard({.max_force_n = 100, .slew_n_per_s = 1e9, .steady_share = 1, .soft_start_s = 0.05});
    double work = 0, last_depth = 0, last_force = 0;
    for (int i = 1; i < 300; ++i) {
      const double depth = std::max(0.0, depth_at(i * k_period));
      const double force =
          guard.apply({0, 0, k_stiffness * depth}, k_period, 0, {depth > 0, 0, k_stiffness, {0, 0, last_depth - depth}})
              .z;
      const double step = (last_force + force) / 2 * (depth - last_depth);
      work += step;
      ASSERT_GE(work, -1e-12) << "hand " << hand << " at " << i << " ms";
      last_depth = depth;
      last_force = force;
      largest = std::max(largest, force);
    }
  }
  EXPECT_GT(largest, 2);
}

TEST(ForceGuard, AWallIsAsStiffAsItIsOnceFadedInAndWholeInTheNextContact) {
  ForceGuard guard({.max_force_n = 100, .slew_n_per_s = 1e9, .steady_share = 1, .soft_start_s = 0.01});
  const auto press = [&](double raw) { return guard.apply({0, raw, 0}, 1e-3, 0, {raw > 0, 0}).y; };
  double expected = 0;
  for (int i = 1; i <= 10; ++i) EXPECT_NEAR(press(0.1 * i), expected += 0.01 * i, 1e-12);  // Shares 0.1, 0.2, ... 1.
  EXPECT_NEAR(press(1.5), expected + 0.5, 1e-12);
  EXPECT_NEAR(press(0.6), expected - 0.4, 1e-12);
  EXPECT_EQ(press(0.3), 0);  // Less than what is held back.
  EXPECT_EQ(press(0), 0);
  EXPECT_EQ(press(0.3), 0.3);
}

/// A hand that jumps 1 mm into a wall of 400 N/m and slides on with a friction of 0.5: that work pays for the rest.
TEST(ForceGuard, WhatFadingInHeldBackReturnsWhileFrictionPaysForIt) {
  ForceGuard guard({.max_force_n = 100, .slew_n_per_s = 1e9, .steady_share = 1, .soft_start_s = 0.05});
  double work = 0, last = 0;
  for (int i = 0; i < 400; ++i) {
    const double slid = i == 0 ? 0 : 6e-5;
    const Vec3 force = guard.apply({-0.2, 0, 0.4}, 1e-3, 0, {true, 0, 400, {slid, 0, i == 0 ? -1e-3 : 0}});
    EXPECT_NEAR(force.z, -2 * force.x, 1e-12);
    const double stored = dot(force, force) / (2 * 400);
    work += last * slid;
    EXPECT_LE(stored, work + 1e-6 * (i < 50)) << i;  // At first no more than the share of the first millisecond.
    last = -force.x;
  }
  EXPECT_NEAR(last, 0.2, 1e-12);
}

TEST(ForceGuard, NoNumberAndOldInputMeanNoForceUntilResumed) {
  for (const double odd : {std::nan(""), std::numeric_limits<double>::infinity(), 1e308}) {
    ForceGuard guard(sharp());
    guard.apply({1, 0, 0}, 1e-3, 0);
    EXPECT_EQ(guard.apply({odd, odd, 0}, 1e-3, 0), Vec3{});
    EXPECT_EQ(guard.fault(), ForceGuard::Fault::not_finite);
    EXPECT_EQ(guard.apply({1, 0, 0}, 1e-3, 0), Vec3{});
    guard.resume();
    EXPECT_EQ(guard.apply({1, 0, 0}, 1e-3, 0).x, 1);
  }
  ForceGuard guard(sharp());
  EXPECT_EQ(guard.apply({1, 0, 0}, 1e-3, 0.02), Vec3{});
  EXPECT_EQ(guard.fault(), ForceGuard::Fault::stale_input);
  EXPECT_EQ(ForceGuard(sharp()).apply({1, 0, 0}, 1e-3, std::nan("")), Vec3{});
}

}  // namespace
}  // namespace papilla
