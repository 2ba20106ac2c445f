// SPDX-License-Identifier: MIT
// Skin over backing: two stiffnesses and the depth between.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"

namespace papilla {
namespace {

constexpr double k_skin = 400, k_backing = 1600, k_depth = 1e-3, k_period = 1e-3;

ContactMaterial layered(double friction = 0) {
  ContactMaterial m;
  m.stiffness = k_skin;
  m.backing_stiffness = k_backing;
  m.backing_depth_m = k_depth;
  m.static_friction = m.dynamic_friction = friction;
  return m;
}

ContactSurface plate_of(const ContactMaterial& material) {
  return ContactSurface(testing::plate(10, 10, 0.1, 0.1), {material}, {}, 0);
}

/// Force of a probe that went down to a depth below the plate.
double force_at(const ContactSurface& surface, double depth) {
  Proxy proxy(surface);
  proxy.reset({0.05, 0.05, 1e-3});
  const Vec3 probe{0.05, 0.05, -depth};
  proxy.update(probe, k_period);
  return heightfield_force(surface, proxy.state(), probe, {}).z;
}

/// N(δ) = kδ down to D, kD + K(δ − D) below.
TEST(Backing, ForceOverDepthIsTheClosedForm) {
  const ContactSurface surface = plate_of(layered());
  for (const double depth : {1e-5, 2e-4, 5e-4, 9.99e-4, 1e-3, 1.001e-3, 1.5e-3, 3e-3, 8e-3}) {
    const double expected = depth <= k_depth ? k_skin * depth : k_skin * k_depth + k_backing * (depth - k_depth);
    EXPECT_NEAR(force_at(surface, depth), expected, 1e-9 + 1e-6 * expected) << depth;
  }
}

TEST(Backing, ForceIsContinuousWhereItIsReached) {
  const ContactSurface surface = plate_of(layered());
  constexpr double k_step = 1e-7;
  EXPECT_NEAR(force_at(surface, k_depth + k_step) - force_at(surface, k_depth - k_step), (k_skin + k_backing) * k_step,
              0.02 * k_skin * k_step);
}

TEST(Backing, AtNoDepthOnlyTheBackingIsFelt) {
  ContactMaterial bare = layered();
  bare.backing_depth_m = 0;
  EXPECT_NEAR(force_at(plate_of(bare), 2e-3), k_backing * 2e-3, 1e-6);
  EXPECT_NEAR(force_at(plate_of(ContactMaterial{}), 8e-3), 500 * 8e-3, 1e-6);  // None: as ever.
}

/// W(δ) = ½kδ², below D: ½kD² + kD(δ − D) + ½K(δ − D)²; its derivative by k.
TEST(Backing, EnergyIsTheIntegralOfTheForce) {
  const ContactMaterial m = layered();
  for (const double depth : {3e-4, 1e-3, 2.5e-3}) {
    const auto energy = [&](double k) {
      double sum = 0;
      constexpr int n = 20000;
      for (int i = 0; i < n; ++i) sum += spring_force(m, k, (i + 0.5) * depth / n) * depth / n;
      return sum;
    };
    EXPECT_NEAR(energy_by_stiffness(m, depth), (energy(k_skin + 1) - energy(k_skin - 1)) / 2, 1e-6 * depth * depth);
  }
}

/// Work that a probe gets out of a contact along a closed way.
double work_of(const ContactSurface& surface, const std::vector<Vec3>& corners, int steps) {
  Proxy proxy(surface);
  proxy.reset(corners.front());
  double work = 0;
  Vec3 before = corners.front(), force_before;
  for (std::size_t c = 1; c < corners.size(); ++c)
    for (int i = 1; i <= steps; ++i) {
      const Vec3 probe = corners[c - 1] + (static_cast<double>(i) / steps) * (corners[c] - corners[c - 1]);
      proxy.update(probe, k_period);
      const Vec3 force = heightfield_force(surface, proxy.state(), probe, {});
      work += dot(0.5 * (force + force_before), probe - before);
      before = probe, force_before = force;
    }
  return work;
}

/// Down, aside, up and back again, held by friction all the way: a spring gives back what was put in.
TEST(Backing, GivesBackWhatWasPutInWhileItSticks) {
  const ContactSurface surface = plate_of(layered(2));
  const std::vector<Vec3> loop{{0.05, 0.05, 1e-4},    {0.05, 0.05, -3e-3}, {0.0515, 0.05, -3e-3},
                               {0.0515, 0.05, -8e-4}, {0.05, 0.05, -8e-4}, {0.05, 0.05, 1e-4}};
  const double stored = 0.5 * k_skin * k_depth * k_depth + 2e-3 * (k_skin * k_depth + 0.5 * k_backing * 2e-3);
  EXPECT_NEAR(work_of(surface, loop, 4000), 0, 2e-3 * stored);
}

TEST(Backing, SlidingTakesEnergyOut) {
  const ContactSurface surface = plate_of(layered(0.4));
  const std::vector<Vec3> loop{{0.05, 0.05, 1e-4}, {0.05, 0.05, -3e-3}, {0.06, 0.05, -3e-3}, {0.06, 0.05, 1e-4}};
  const double normal = k_skin * k_depth + k_backing * 2e-3;
  // It slides on from where it broke away, and back by as much as the spring holds at most.
  const double work = work_of(surface, loop, 4000);
  EXPECT_LT(work, -0.4 * normal * 8e-3);
  EXPECT_GT(work, -0.4 * normal * 1e-2);
}

/// Friction is that of the whole load: μ·N with N of both layers.
TEST(Backing, FrictionCarriesTheWholeLoad) {
  const ContactSurface surface = plate_of(layered(0.3));
  Proxy proxy(surface);
  proxy.reset({0.03, 0.05, 1e-3});
  Vec3 probe{0.03, 0.05, -2e-3};
  for (int i = 0; i < 200; ++i) proxy.update(probe = {0.03 + 1e-4 * i, 0.05, -2e-3}, k_period);
  const Vec3 force = heightfield_force(surface, proxy.state(), probe, {});
  EXPECT_NEAR(-force.x / force.z, 0.3, 0.01);
  EXPECT_NEAR(force.z, k_skin * k_depth + k_backing * 1e-3, 0.05 * force.z);
}

TEST(Backing, TexturedNormalPushesWithBothLayers) {
  ContactMaterial m = layered();
  EXPECT_NEAR(textured_normal_force(m, {0, 0, 3e-3}, {}).z, k_skin * k_depth + k_backing * 2e-3, 1e-12);
  m.damping = 1e6;  // Damping never pulls, and never more than doubles the push.
  EXPECT_NEAR(textured_normal_force(m, {0, 0, 3e-3}, {0, 0, -1}).z, 2 * (k_skin * k_depth + k_backing * 2e-3), 1e-12);
  EXPECT_EQ(textured_normal_force(m, {0, 0, 3e-3}, {0, 0, 1}).z, 0);
}

constexpr DeviceDynamics k_device{.mass_kg = 0.05, .damping = 0.6, .friction_n = 0.2, .encoder_step_m = 1e-5};

TEST(Backing, TheStiffestLayerIsHeldToTheLimit) {
  const double limit = stiffness_limit(k_device, k_period, 0);
  ASSERT_EQ(limit, 1200);
  ContactSurface surface = plate_of(layered());
  const auto clamps = clamp_to_stable(surface, k_device, k_period);
  ASSERT_EQ(clamps.size(), 1U);
  EXPECT_EQ(clamps[0].stiffness_wanted, k_backing);
  EXPECT_EQ(clamps[0].stiffness, limit);
  EXPECT_EQ(surface.material(0).stiffness, k_skin);  // What is soft enough stays.
  EXPECT_EQ(surface.material(0).backing_stiffness, limit);

  ContactMaterial hard_skin = layered();
  std::swap(hard_skin.stiffness, hard_skin.backing_stiffness);
  ContactSurface crust = plate_of(hard_skin);
  ASSERT_EQ(clamp_to_stable(crust, k_device, k_period).size(), 1U);
  EXPECT_EQ(crust.material(0).stiffness, limit);
  EXPECT_EQ(crust.material(0).backing_stiffness, k_skin);

  ContactMaterial both = layered();
  both.stiffness = 1500;
  ContactSurface hard = plate_of(both);
  clamp_to_stable(hard, k_device, k_period);
  EXPECT_EQ(hard.material(0).stiffness, limit);
  EXPECT_EQ(hard.material(0).backing_stiffness, limit);

  ContactMaterial soft = layered();
  soft.backing_stiffness = 1100;
  ContactSurface gentle = plate_of(soft);
  EXPECT_TRUE(clamp_to_stable(gentle, k_device, k_period).empty());
}

/// A hand that presses through the skin on a simulated device: with the clamp it comes to rest, with a backing of eight
/// times the limit it shakes.
TEST(Backing, IsStableOnADeviceOnlyWithTheClamp) {
  const DeviceCaps caps = device_preset("touch").caps();
  const auto speed = [&](bool clamped) {
    ContactMaterial m = layered();
    m.backing_stiffness = 8 * stiffness_limit(caps.dynamics, k_period, 0);
    m.stiffness = 0.5 * stiffness_limit(caps.dynamics, k_period, 0);
    ContactSurface surface(testing::plate(1, 1, 0.2, 0.2), {m}, {}, 0);
    if (clamped) clamp_to_stable(surface, caps.dynamics, k_period);
    const Trajectory hand(std::vector<Trajectory::Sample>{{0, {0.1, 0.1, 5e-3}}, {0.03, {0.1, 0.1, -1e-2}}});
    SimDevice device(caps, hand, k_period, {.stiffness = 300, .damping = 0});
    SafetyLimits limits = safety_limits(1e6);
    limits.soft_start_s = 0;
    HapticTick tick(surface, limits, k_period);
    double sum = 0;
    constexpr int k_ticks = 8000, k_last = 300;
    for (int i = 0; i < k_ticks; ++i) {
      DeviceState state;
      device.read(state);
      device.write(tick(state));
      if (i >= k_ticks - k_last) sum += dot(device.velocity(), device.velocity());
    }
    return std::sqrt(sum / k_last);
  };
  EXPECT_LT(speed(true), 1e-3);
  EXPECT_GT(speed(false), 1e-2);
}

TEST(Backing, OddNumbersAreRefused) {
  for (const double odd : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    ContactMaterial m = layered();
    m.backing_stiffness = odd;
    EXPECT_THROW(plate_of(m), InvalidInput);
    m = layered();
    m.backing_depth_m = odd;
    EXPECT_THROW(plate_of(m), InvalidInput);
  }
}

}  // namespace
}  // namespace papilla
