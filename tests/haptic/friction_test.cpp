// SPDX-License-Identifier: MIT
#include "papilla/haptic/friction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {
namespace {

constexpr Vec3 k_up{0, 0, 1};

ContactMaterial bristles(double mu_static, double mu_dynamic, double stiffness) {
  ContactMaterial m;
  m.stiffness = 1e4;
  m.friction = FrictionModel::bristle;
  m.bristle_stiffness = stiffness;
  m.static_friction = mu_static;
  m.dynamic_friction = mu_dynamic;
  return m;
}

TEST(FrictionModels, HaveNames) {
  for (const FrictionModel model : {FrictionModel::coulomb, FrictionModel::bristle})
    EXPECT_EQ(friction_model(name_of(model)), model);
  EXPECT_EQ(friction_model("glue"), std::nullopt);
}

TEST(FrictionCoefficient, FallsAtOnceWithoutAStribeckVelocity) {
  ContactMaterial material;
  material.static_friction = 0.6;
  material.dynamic_friction = 0.2;
  material.stribeck_velocity = 0;
  EXPECT_EQ(friction_coefficient(material, 0), 0.6);
  EXPECT_NEAR(friction_coefficient(material, 1e-9), 0.2, 1e-12);
}

TEST(BristleFriction, PullsAlongTheFaceOnlyAfterAnEdge) {
  const ContactMaterial material = bristles(0.5, 0.5, 2000);
  BristleFriction friction;
  EXPECT_GT(norm(friction.force(material, k_up, 3, {1e-4, 2e-4, 0}, 1e-3)), 0.1);
  const Vec3 round_the_edge = friction.force(material, {1, 0, 0}, 3, {0, 0, 0}, 1e-3);
  EXPECT_NEAR(round_the_edge.x, 0, 1e-12);
  EXPECT_LT(round_the_edge.y, -0.1);
}

TEST(BristleFriction, FollowsDahlsEquation) {
  // F(x) = −μN(1 − exp(−σx/μN)), whatever the length of a tick.
  const ContactMaterial material = bristles(0.4, 0.4, 2000);
  for (const double step : {1e-6, 1e-5, 1.5e-4}) {
    BristleFriction friction;
    for (int i = 1; i * step <= 3e-3; ++i) {
      const double limit = 0.4 * 3, x = i * step;
      const Vec3 force = friction.force(material, k_up, 3, {step, 0, 0}, 1e-3);
      ASSERT_NEAR(force.x, -limit * (1 - std::exp(-2000 * x / limit)), 1e-9) << x;
      ASSERT_EQ(force.y, 0);
      ASSERT_EQ(force.z, 0);
    }
  }
}

TEST(BristleFriction, IsASpringFromRest) {
  BristleFriction friction;
  const double x = 1e-8;
  EXPECT_NEAR(friction.force(bristles(0.5, 0.3, 2000), k_up, 3, {0, x, 0}, 1e-3).y / x, -2000, 0.1);
}

TEST(BristleFriction, BreaksAwayAtStaticAndSlidesAtStribeckFriction) {
  const ContactMaterial material = bristles(0.6, 0.2, 5000);
  const double load = 2;
  for (const double speed : {1e-4, 0.01, 0.02, 0.2}) {
    BristleFriction friction;
    double largest = 0, last = 0;
    for (int i = 0; i < 60000; ++i) {
      last = -friction.force(material, k_up, load, {speed * 1e-3, 0, 0}, 1e-3).x;
      largest = std::max(largest, last);
    }
    const double ratio = speed / material.stribeck_velocity;
    EXPECT_NEAR(last, load * (0.2 + 0.4 * std::exp(-ratio * ratio)), 1e-6) << speed;
    EXPECT_LE(largest, 0.6 * load + 1e-12);
    if (speed < 1e-3) {
      EXPECT_GT(largest, 0.999 * 0.6 * load);
    }
  }
}

TEST(BristleFriction, IsTheSameAtEveryRate) {
  const ContactMaterial material = bristles(0.6, 0.3, 3000);
  const auto after = [&](int ticks) {
    BristleFriction friction;
    Vec3 force;
    for (int i = 0; i < ticks; ++i)
      force = friction.force(material, k_up, 1, {0.02 * 0.05 / ticks, 0, 0}, 0.05 / ticks);
    return force.x;
  };
  const double finest = after(64000);
  EXPECT_NEAR(after(2000), finest, 1e-3 * std::abs(finest));
  EXPECT_NEAR(after(50), finest, 0.03 * std::abs(finest));
}

TEST(BristleFriction, IsReleasedWithTheLoadAndAtMostAsStiffAsTheMaterial) {
  const ContactMaterial material = bristles(0.5, 0.5, 1e9);
  BristleFriction friction;
  EXPECT_NEAR(friction.force(material, k_up, 2, {1e-9, 0, 0}, 1e-3).x, -1e4 * 1e-9, 1e-9);
  for (int i = 0; i < 100; ++i) friction.force(material, k_up, 2, {1e-4, 0, 0}, 1e-3);
  EXPECT_NEAR(norm(friction.force(material, k_up, 0.5, {}, 1e-3)), 0.25, 1e-12);
  EXPECT_EQ(norm(friction.force(material, k_up, 0, {1e-4, 0, 0}, 1e-3)), 0);
  EXPECT_EQ(norm(friction.force(material, k_up, 1, {}, 1e-3)), 0);
}

TEST(BristleFriction, ActsInAStrokeOverAPlate) {
  // The tick: 1 mm deep at 500 N/m, 0.5 N of load; pulled by 20 µm, then far.
  ContactMaterial material = bristles(0.4, 0.4, 500);
  material.stiffness = 500;
  const ContactSurface surface(testing::plate(10, 10, 0.1, 0.1), {material}, {}, 0);
  SafetyLimits limits = safety_limits(10);
  limits.soft_start_s = 0;
  HapticTick tick(surface, limits, 1e-3);
  tick.reset({0.02, 0.05, 0.001});
  const auto at = [&](double x, double z) {
    DeviceState device;
    device.position = {x, 0.05, z};
    return tick(device);
  };
  for (int i = 0; i < 20; ++i) at(0.02, -1e-3);
  const double limit = 0.4 * 0.5;
  EXPECT_NEAR(at(0.02002, -1e-3).x, -limit * (1 - std::exp(-500 * 2e-5 / limit)), 1e-4);
  for (int i = 0; i < 200; ++i) at(0.02002 + 1e-4 * i, -1e-3);
  EXPECT_NEAR(at(0.0401, -1e-3).x, -limit, 0.01 * limit);
}

/// Forces of a ball of 1 mm drawn over a rough mesh at 0.2 m/s, at every millisecond.
std::vector<Vec3> forces_over_a_rough_mesh(const ContactSurface& surface, int ticks_per_ms) {
  Proxy proxy(surface);
  proxy.reset({0.005, 0.003, 0.01});
  std::vector<Vec3> forces;
  for (int i = 0; i <= 60 * ticks_per_ms; ++i) {
    const double ms = static_cast<double>(i) / ticks_per_ms;
    const Vec3 probe{0.005 + 2e-4 * ms, 0.003, 5e-4};
    proxy.update(probe, 1e-3 / ticks_per_ms);
    if (i % ticks_per_ms == 0) forces.push_back(heightfield_force(surface, proxy.state(), probe, {}));
  }
  return forces;
}

TEST(Friction, OfABallOnARoughMeshConvergesInProportionToTheTick) {
  ContactMaterial material;
  material.static_friction = 0.24;
  material.dynamic_friction = 0.2;
  const auto relief = [](double x, double y) {
    return 2e-4 * std::sin(1200 * x) * std::cos(900 * y) + 5e-5 * std::sin(6000 * x + 1) * std::sin(5500 * y);
  };
  const ContactSurface surface(testing::height_grid(240, 60, 0.024, 0.006, relief), {material}, {}, 1e-3);
  const std::vector<Vec3> fine = forces_over_a_rough_mesh(surface, 16);
  const auto error = [&](int ticks_per_ms) {
    const std::vector<Vec3> forces = forces_over_a_rough_mesh(surface, ticks_per_ms);
    double off = 0, all = 0;
    for (std::size_t i = 10; i < fine.size(); ++i) {
      off += dot(forces[i] - fine[i], forces[i] - fine[i]);
      all += dot(fine[i], fine[i]);
    }
    return std::sqrt(off / all);
  };
  const double coarse = error(1), finer = error(4);
  EXPECT_GT(coarse, 5e-3);  // The error is measurable.
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(finer, 0.5 * coarse);
}

}  // namespace
}  // namespace papilla
