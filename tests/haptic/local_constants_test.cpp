// SPDX-License-Identifier: MIT
// Stiffness, friction and damping by maps, as the hand feels them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact_triangles.hpp"
#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/haptic_tick.hpp"

namespace papilla {
namespace {

constexpr double k_size = 0.1, k_period = 1e-3;

/// A plate of 0.1 m with uv from 0 to 1.
ContactMesh unit_plate() {
  ContactMesh mesh = testing::plate(10, 10, k_size, k_size);
  mesh.corner_uv.clear();
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      mesh.corner_uv.push_back({mesh.positions[v].x / k_size, mesh.positions[v].y / k_size});
  return mesh;
}

/// A map of `pixels` texels along u of value(u) in [0, 1], in every channel.
template <class Value>
ChannelField along_u(int pixels, const std::array<std::optional<MapChannel>, 3>& channels, Value&& value) {
  std::vector<ChannelField::Texel> texels;
  for (int i = 0; i < pixels; ++i) {
    const auto v = static_cast<std::uint16_t>(std::lround(65535 * value((i + 0.5) / pixels)));
    texels.push_back({v, v, v});
  }
  return ChannelField(pixels, 1, texels, {channels, {}, {Wrap::clamp, Wrap::clamp}});
}

ContactSurface surface_of(ChannelField field, ContactMaterial material = {}) {
  material.channels = 0;
  return ContactSurface(unit_plate(), {material}, {}, 0, {std::move(field)});
}

double ramp(double u) { return u; }

TEST(LocalConstants, StiffnessIsThatOfThePlace) {
  const ContactSurface surface = surface_of(along_u(64, {MapChannel{Quantity::stiffness, 800, 100}}, ramp));
  for (const double x : {0.013, 0.031, 0.05, 0.077}) {
    Proxy proxy(surface);
    proxy.reset({x, 0.05, 1e-3});
    const Vec3 probe{x, 0.05, -1e-3};
    proxy.update(probe, k_period);
    const double expected = 1e-3 * (100 + 800 * x / k_size);
    EXPECT_NEAR(heightfield_force(surface, proxy.state(), probe, {}).z, expected, 1e-4 * expected) << x;
  }
}

/// The slope along the surface, on a triangle without a right angle whose texture is sheared.
TEST(LocalConstants, SlopeOfTheStiffnessIsThatOfFiniteDifferences) {
  ContactMesh mesh;
  mesh.positions = {{0.01, 0.02, 0.03}, {0.06, 0.01, 0.05}, {0.03, 0.07, 0.02}};
  mesh.triangles = {{0, 1, 2}};
  mesh.corner_uv = {{0.3, 0.3}, {0.7, 0.4}, {0.4, 0.7}};
  const ChannelField field(
      2, 2, {{0, 0, 0}, {20000, 0, 0}, {50000, 0, 0}, {65535, 0, 0}},
      {{MapChannel{Quantity::stiffness, 800, 100}, std::nullopt, std::nullopt}, {}, {Wrap::clamp, Wrap::clamp}});
  ContactMaterial material;
  material.channels = 0;
  material.most_stiffness = 1e6;
  const ContactTriangles triangles(mesh, {material}, {}, 0, {field});
  const auto at = [&](double v, double w) {
    return mesh.positions[0] + v * (mesh.positions[1] - mesh.positions[0]) +
           w * (mesh.positions[2] - mesh.positions[0]);
  };
  constexpr double e = 1e-4;
  const Vec3 slope = triangles.constants_at(0, at(0.3, 0.4)).stiffness_slope;
  EXPECT_GT(norm(slope), 0);
  for (const Vec2 way : {Vec2{e, 0}, Vec2{0, e}, Vec2{e, -e}}) {
    const Vec3 one = at(0.3 - way.x, 0.4 - way.y), other = at(0.3 + way.x, 0.4 + way.y);
    const double rise =
        triangles.constants_at(0, other).constants.stiffness - triangles.constants_at(0, one).constants.stiffness;
    EXPECT_NEAR(rise, dot(slope, other - one), 1e-3 * norm(slope) * norm(other - one));
  }
}

/// A probe that is dragged over a ramp of friction feels μ(x)·N, whatever material constants say.
TEST(LocalConstants, FrictionIsThatOfThePlace) {
  ContactMaterial constants;
  constants.static_friction = constants.dynamic_friction = 0.9;
  const ContactSurface surface =
      surface_of(along_u(64, {std::nullopt, MapChannel{Quantity::dynamic_friction, 0.8, 0.1}}, ramp), constants);
  Proxy proxy(surface);
  proxy.reset({0.02, 0.05, 1e-3});
  for (double x = 0.02; x < 0.09; x += 1e-4) {
    const Vec3 probe{x, 0.05, -1e-3};
    proxy.update(probe, k_period);
    const Vec3 force = heightfield_force(surface, proxy.state(), probe, {});
    if (x < 0.025) continue;  // Until it slides.
    EXPECT_NEAR(-force.x / force.z, 0.1 + 0.8 * proxy.state().proxy.x / k_size, 0.01) << x;
  }
}

TEST(LocalConstants, DampingIsThatOfThePlace) {
  const ContactSurface surface = surface_of(along_u(64, {MapChannel{Quantity::damping, 4, 0}}, ramp));
  Proxy proxy(surface);
  proxy.reset({0.05, 0.05, 1e-3});
  const Vec3 probe{0.05, 0.05, -1e-3};
  proxy.update(probe, k_period);
  const double still = heightfield_force(surface, proxy.state(), probe, {}).z;
  EXPECT_NEAR(heightfield_force(surface, proxy.state(), probe, {0, 0, -0.05}).z - still, 2 * 0.05, 1e-3);
}

/// Work on a hand that presses where it is soft, slides without friction to where it is hard, and lets go.
double gain(double depth, double low, double high, double width, bool is_map_felt_by_proxy) {
  // A smooth step of the stiffness of `width` around the middle.
  const auto step = [&](double u) {
    const double t = std::clamp((u - 0.5) * k_size / width + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  const ContactSurface surface = surface_of(along_u(1024, {MapChannel{Quantity::stiffness, high - low, low}}, step));
  Proxy proxy(surface);
  const std::vector<Vec3> corners{{0.03, 0.05, 1e-4}, {0.03, 0.05, -depth}, {0.07, 0.05, -depth}, {0.07, 0.05, 1e-4}};
  proxy.reset(corners[0]);
  Vec3 before = corners[0], force_before;
  double work = 0;
  constexpr int k_steps = 4000;
  for (std::size_t c = 1; c < corners.size(); ++c)
    for (int i = 1; i <= k_steps; ++i) {
      const Vec3 probe = corners[c - 1] + (static_cast<double>(i) / k_steps) * (corners[c] - corners[c - 1]);
      ProxyState state = proxy.update(probe, k_period);
      if (!is_map_felt_by_proxy) state.proxy = {probe.x, probe.y, state.proxy.z};
      const Vec3 force = heightfield_force(surface, state, probe, {});
      work += dot(0.5 * (force + force_before), probe - before);
      before = probe, force_before = force;
    }
  return work;
}

/// Slopes as gentle as bake writes them: ½δ·|∇ ln k| < ½. Without the pull to the softer side a hand gains ½Δkδ².
TEST(LocalConstants, SlidingFromSoftToHardGivesNoEnergy) {
  const double depth = 1.5e-3, low = 300, high = 900, free_energy = 0.5 * (high - low) * depth * depth;
  EXPECT_NEAR(gain(depth, low, high, 0.015, false), free_energy, 0.05 * free_energy);
  EXPECT_LT(std::abs(gain(depth, low, high, 0.015, true)), 0.05 * free_energy);
}

/// On an edge as sharp as a texel it takes what it can: never more than without it.
TEST(LocalConstants, ASharpEdgeGivesLessThanItWould) {
  const double depth = 1.5e-3, low = 300, high = 900, free_energy = 0.5 * (high - low) * depth * depth;
  const double sharp = gain(depth, low, high, 1e-4, true);
  EXPECT_LT(sharp, free_energy);
}

TEST(LocalConstants, AreHeldToTheLimitsOfTheDevice) {
  constexpr DeviceDynamics k_device{.mass_kg = 0.05, .damping = 0.6, .friction_n = 0.2, .encoder_step_m = 1e-5};
  ContactSurface surface = surface_of(
      along_u(64, {MapChannel{Quantity::stiffness, 2000, 0}, std::nullopt, MapChannel{Quantity::damping, 1, 0}}, ramp));
  const auto clamps = clamp_to_stable(surface, k_device, k_period);
  ASSERT_EQ(clamps.size(), 1U);
  EXPECT_NEAR(clamps[0].stiffness_wanted, 2000, 20);
  EXPECT_NEAR(clamps[0].damping_wanted, 1, 0.01);
  EXPECT_EQ(clamps[0].damping, 0.3);
  EXPECT_EQ(clamps[0].stiffness, stiffness_limit(k_device, k_period, 0.3));
  for (const double x : {0.01, 0.05, 0.09}) {
    Proxy proxy(surface);
    proxy.reset({x, 0.05, 1e-3});
    proxy.update({x, 0.05, -1e-3}, k_period);
    EXPECT_NEAR(proxy.state().constants.stiffness, std::min(clamps[0].stiffness, 2000 * x / k_size), 2);
    EXPECT_NEAR(proxy.state().constants.damping, std::min(0.3, x / k_size), 0.01);
  }
}

/// Bristles, whose friction is no proxy's, take it from the map, too.
TEST(LocalConstants, BristlesFeelTheMap) {
  ContactMaterial bristles;
  bristles.friction = FrictionModel::bristle;
  bristles.static_friction = bristles.dynamic_friction = 0.9;
  const ContactSurface surface =
      surface_of(along_u(64, {std::nullopt, MapChannel{Quantity::dynamic_friction, 0.8, 0.1}}, ramp), bristles);
  SafetyLimits limits = safety_limits(100);
  limits.soft_start_s = 0;
  HapticTick tick(surface, limits, k_period);
  tick.reset({0.04, 0.05, 1e-3});
  Vec3 force;
  double x = 0.04;
  for (; x < 0.06; x += 1e-5) force = tick({{x, 0.05, -1e-3}, 0, 0});
  EXPECT_NEAR(-force.x / force.z, 0.1 + 0.8 * x / k_size, 0.02);
}

TEST(LocalConstants, ConstantsWithoutMaps) {
  ContactMaterial material;
  material.stiffness = 700;
  material.static_friction = 0.4;
  const ContactSurface surface(unit_plate(), {material}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.05, 0.05, 1e-3});
  proxy.update({0.05, 0.05, -1e-3}, k_period);
  EXPECT_EQ(proxy.state().constants.stiffness, 700);
  EXPECT_EQ(proxy.state().constants.static_friction, 0.4);
  EXPECT_EQ(surface.most(0, Quantity::stiffness), 700);
  EXPECT_EQ(surface.most(0, Quantity::static_friction), 0.4);
}

TEST(LocalConstants, MissingMapsAreRefused) {
  ContactMaterial material;
  material.channels = 0;
  EXPECT_THROW(ContactSurface(unit_plate(), {material}, {}, 0), InvalidInput);
  ContactMesh bare = unit_plate();
  bare.corner_uv.clear();
  EXPECT_THROW(ContactSurface(bare, {material}, {}, 0, {along_u(4, {MapChannel{Quantity::stiffness, 1, 0}}, ramp)}),
               InvalidInput);
}

}  // namespace
}  // namespace papilla
