// SPDX-License-Identifier: MIT
#include "papilla/haptic/proxy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/contact_audit.hpp"
#include "papilla/haptic/force_model.hpp"

namespace papilla {
namespace {

using testing::box;
using testing::height_grid;
using testing::plate;
using testing::rough_relief;
using testing::sphere;
using testing::Wanderer;

constexpr double k_tick = 1e-3;

ContactMaterial spring(double stiffness, double mu_static = 0, double mu_dynamic = 0) {
  ContactMaterial m;
  m.stiffness = stiffness;
  m.static_friction = mu_static;
  m.dynamic_friction = mu_dynamic;
  return m;
}

Vec3 force_at(const ContactSurface& surface, Proxy& proxy, Vec3 probe) {
  return heightfield_force(surface, proxy.update(probe, k_tick), probe, {});
}

TEST(Proxy, ForceOnAPlateIsStiffnessTimesDepth) {
  for (const double radius : {0.0, 1e-3}) {
    const ContactSurface surface(plate(10, 10, 0.1, 0.1), {spring(800)}, {}, radius);
    Proxy proxy(surface);
    proxy.reset({0.033, 0.047, 0.01});
    for (int i = 1; i <= 30; ++i) {
      const double depth = i * 1e-4;
      const Vec3 force = force_at(surface, proxy, {0.033, 0.047, radius - depth});
      EXPECT_NEAR(force.z, 800 * depth, 1e-6);
      EXPECT_NEAR(std::hypot(force.x, force.y), 0, 1e-6);
    }
  }
}

/// Below a crease the proxy rests where the skins of both faces meet, wherever edges cross that line: one sweep along
/// it and one down lead there. Above a flat crease that place is within the tolerance of both skins, and one plane
/// holds the proxy; in a deeper one both faces do, at times with one sweep more.
TEST(Proxy, ACreaseIsFollowedInTwoOrThreeSweepsATick) {
  for (const auto& [slope, most] : {std::pair{0.2, 220}, {0.5, 300}}) {
    const ContactSurface surface(
        height_grid(40, 40, 0.04, 0.04, [=](double x, double) { return slope * std::abs(x - 0.02); }), {spring(500)},
        {}, 0);
    const double above = surface.skin_m() * (std::sqrt(1 + slope * slope) - 1);
    Proxy proxy(surface);
    proxy.reset({0.02, 0.01, 0.005});
    proxy.update({0.02, 0.01, -2e-3}, k_tick);
    int sweeps = 0;
    for (int i = 1; i <= 100; ++i) {
      const Vec3 probe{0.02 + 1e-4 * std::sin(0.1 * i), 0.01 + i * 1.7e-4, -2e-3};
      const ProxyState& state = proxy.update(probe, k_tick);
      EXPECT_EQ(state.constraints, above < surface.tolerance_m() ? 1 : 2) << slope << ' ' << i;
      const Vec3 rest{0.02, probe.y, surface.skin_m() + above};
      EXPECT_LT(norm(state.proxy - rest), surface.tolerance_m()) << slope << ' ' << i;
      sweeps += state.sweeps;
    }
    EXPECT_LE(sweeps, most) << slope;
  }
}

/// A sheet holds the proxy up to its rim, and the rim does not, for slow probes, which descend, and fast ones, which
/// hop.
TEST(Proxy, GoesAroundTheRimOfASheet) {
  const ContactSurface surface(plate(10, 10, 0.1, 0.1), {spring(500)}, {}, 0);
  for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{0.8, 0.6, 0}, Vec3{0.6, 0.8, 0}})
    for (const double depth : {3e-4, 1e-3, 5e-3})
      for (const double step : {1e-5, 7e-5, 2e-4}) {
        Proxy proxy(surface);
        proxy.reset({0.099, 0.053, 1e-3});
        Vec3 probe{0.099, 0.053, -depth};
        for (; probe.x < 0.102; probe = probe + step * way) {
          const ProxyState& state = proxy.update(probe, k_tick);
          if (probe.x <= 0.1) {
            EXPECT_TRUE(state.in_contact) << probe.x << ' ' << depth << ' ' << step;
            EXPECT_NEAR(state.proxy.z, surface.contact_radius_m(), surface.tolerance_m());
          } else if (probe.x > 0.1001) {
            EXPECT_FALSE(state.in_contact) << probe.x << ' ' << depth << ' ' << step;
            EXPECT_EQ(state.proxy, probe);
          }
        }
      }
}

/// The skin rounds a step of a sheet to a slope that holds a deep probe until it is far beyond. A step below a quarter
/// of the skin, as between sheets that should be one, is passed as soon as the nearest place is beyond it.
TEST(Proxy, LowStepsHoldNothing) {
  constexpr double edge = 0.05, width = 0.1;
  for (const double height : {1e-6, 3e-6, 4.8e-6}) {
    ContactMesh mesh = height_grid(3, 10, width, 0.1, [=](double x, double) { return x > edge ? height : 0; });
    for (Vec3& p : mesh.positions)
      if (p.x > 0 && p.x < width) p.x = edge;
    const ContactSurface surface(std::move(mesh), {spring(500)}, {}, 0);
    ASSERT_LT(height, surface.skin_m() / 4);
    for (const double depth : {1e-3, 5e-3})
      for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{0.6, 0.8, 0}}) {
        constexpr double step = 2e-4;
        Proxy proxy(surface);
        proxy.reset({0.045, 0.03, 1e-3});
        for (Vec3 probe{0.045, 0.03, -depth}; probe.x < 0.055; probe = probe + step * way) {
          const ProxyState& state = proxy.update(probe, k_tick);
          EXPECT_TRUE(state.in_contact);
          EXPECT_LT(norm(state.proxy - Vec3{probe.x, probe.y, state.proxy.z}), 2 * step) << probe.x;
        }
        EXPECT_NEAR(proxy.state().proxy.z, height + surface.contact_radius_m(), surface.tolerance_m());
      }
  }
}

/// Loose triangles that cross each other: rims, wedges and narrow gaps without an inside.
TEST(Proxy, NeverPassesATriangleOfASoup) {
  for (const unsigned seed : {1U, 2U, 3U})
    for (const double radius : {0.0, 1e-3})
      for (const double step : {1e-4, 2e-3}) {
        std::mt19937_64 random(seed);
        const auto uniform = [&](double low, double high) {
          return low + (high - low) * std::ldexp(static_cast<double>(random() >> 11), -53);
        };
        const auto place = [&](double size) { return Vec3{uniform(0, size), uniform(0, size), uniform(0, size)}; };
        ContactMesh mesh;
        for (std::uint32_t t = 0; t < 200; ++t) {
          const Vec3 at = place(0.1);
          for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + place(0.05));
          mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        }
        const ContactSurface surface(std::move(mesh), {spring(500)}, {}, radius);
        Proxy proxy(surface);
        ContactAudit audit(surface);
        Vec3 probe{-0.01, 0.05, 0.05}, way{step, 0, 0};
        proxy.reset(probe);
        int held = 0, lost = audit.update(probe, proxy.state(), proxy.waypoints());
        for (int i = 0; i < 5000; ++i) {
          way = way + 0.3 * step * (place(2) - Vec3{1, 1, 1}) + 2 * step * (Vec3{0.075, 0.075, 0.075} - probe);
          way = (step / norm(way)) * way;
          probe = probe + way;
          held += proxy.update(probe, k_tick).in_contact;
          lost += audit.update(probe, proxy.state(), proxy.waypoints());
        }
        EXPECT_GT(held, 500) << seed << ' ' << radius << ' ' << step;
        EXPECT_EQ(lost, 0) << seed << ' ' << radius << ' ' << step;
      }
}

TEST(Proxy, DampingActsAlongTheNormalAndNeverPulls) {
  ContactMaterial material = spring(500);
  material.damping = 2;
  const ContactSurface surface(plate(4, 4, 0.1, 0.1), {material}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.05, 0.03, 0.01});
  const Vec3 probe{0.05, 0.03, -1e-3};
  const ProxyState state = proxy.update(probe, k_tick);
  EXPECT_NEAR(heightfield_force(surface, state, probe, {0, 0, -0.1}).z, 0.5 + 0.2, 1e-6);
  EXPECT_NEAR(heightfield_force(surface, state, probe, {0.3, 0, 0.1}).z, 0.5 - 0.2, 1e-6);
  EXPECT_EQ(heightfield_force(surface, state, probe, {0, 0, 10}).z, 0);
}

TEST(Proxy, SphereNormalIsRadialWhileItIsStroked) {
  const ContactSurface surface(sphere(300, 0.05), {spring(1000)}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.06, 0, 0});
  for (int i = 0; i < 2000; ++i) {
    const double around = 0.004 * i;
    const Vec3 out{std::cos(around), std::sin(around) * 0.8, std::sin(around) * 0.6};
    const Vec3 force = force_at(surface, proxy, 0.048 * out);
    EXPECT_GT(dot(normalized(force), out), 0.9995);
    EXPECT_NEAR(norm(force), 2.0, 0.02);
  }
}

TEST(Proxy, FrictionSticksUpToStaticAndSlidesAtDynamic) {
  const double mu_s = 0.5, mu_d = 0.3, depth = 1e-3, k = 900;
  const ContactSurface surface(plate(40, 40, 0.1, 0.1), {spring(k, mu_s, mu_d)}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.02, 0.05, 0.01});
  force_at(surface, proxy, {0.02, 0.05, -depth});
  const double stuck = proxy.state().proxy.x;
  // Pulled by less than μs·depth the proxy stays.
  for (int i = 1; i <= 49; ++i) {
    const Vec3 force = force_at(surface, proxy, {0.02 + i * 1e-5, 0.05, -depth});
    EXPECT_NEAR(proxy.state().proxy.x, stuck, 1e-9);
    EXPECT_NEAR(force.x, -k * i * 1e-5, 1e-5);
  }
  // Far over it, at 0.2 m/s, twenty times the Stribeck velocity, it slides at μd.
  Vec3 force;
  for (int i = 1; i <= 200; ++i) force = force_at(surface, proxy, {0.0205 + i * 2e-4, 0.05, -depth});
  EXPECT_TRUE(proxy.state().sliding);
  EXPECT_NEAR(-force.x / force.z, mu_d, 0.01 * mu_d);
  EXPECT_NEAR(force.y, 0, 1e-6);
}

TEST(Proxy, StribeckFadesFromStaticToDynamic) {
  ContactMaterial material = spring(900, 0.6, 0.2);
  material.stribeck_velocity = 0.05;
  const ContactSurface surface(plate(40, 40, 0.1, 0.1), {material}, {}, 0);
  for (const double speed : {0.05, 0.1}) {
    Proxy proxy(surface);
    proxy.reset({0.01, 0.05, 0.01});
    Vec3 force;
    for (int i = 0; i < 800; ++i) {
      force = force_at(surface, proxy, {0.01 + i * speed * k_tick, 0.05, -1e-3});
      if (0.01 + i * speed * k_tick > 0.09) break;
    }
    const double expected = 0.2 + 0.4 * std::exp(-(speed / 0.05) * (speed / 0.05));
    EXPECT_NEAR(-force.x / force.z, expected, 0.01 * expected) << speed;
  }
}

TEST(Proxy, FrictionIsTheSameAtEveryRate) {
  // On a wave, static and dynamic friction apart: the force after the same stroke, at 1 kHz and at finer ticks.
  const auto wave = [](double x, double) { return 2e-4 * std::sin(2 * std::numbers::pi * x / 0.01); };
  const ContactSurface surface(height_grid(400, 2, 0.1, 0.02, wave), {spring(500, 0.5, 0.3)}, {}, 0);
  const auto stroke = [&](int ticks_per_ms) {
    Proxy proxy(surface);
    proxy.reset({0.01, 0.01, 0.01});
    const double tick = k_tick / ticks_per_ms;
    std::vector<Vec3> forces;
    for (int i = 0; i <= 400 * ticks_per_ms; ++i) {
      const Vec3 probe{0.01 + 0.1 * i * tick, 0.01, -1e-3};
      const ProxyState& state = proxy.update(probe, tick);
      if (i % (20 * ticks_per_ms) == 0) forces.push_back(heightfield_force(surface, state, probe, {}));
    }
    return forces;
  };
  const auto finest = stroke(32), fine = stroke(8), coarse = stroke(1);
  for (std::size_t i = 0; i < finest.size(); ++i) {
    EXPECT_LT(norm(coarse[i] - finest[i]), 0.05 * norm(finest[i])) << i;
    EXPECT_LT(norm(fine[i] - finest[i]), 0.01 * norm(finest[i])) << i;
  }
}

TEST(Proxy, FrictionHoldsWithoutCreeping) {
  // A tenth of a millimetre aside on a slope, at 32 kHz for a second.
  const auto slope = [](double x, double) { return 0.2 * x; };
  const ContactSurface surface(height_grid(50, 2, 0.1, 0.02, slope), {spring(500, 0.6, 0.6)}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.05, 0.01, 0.02});
  Vec3 first;
  for (int i = 0; i < 32000; ++i) {
    const ProxyState& state = proxy.update({0.0501, 0.01, 0.009}, k_tick / 32);
    if (i == 0) first = state.proxy;
  }
  EXPECT_LT(norm(proxy.state().proxy - first), 2 * surface.tolerance_m());
}

TEST(Proxy, CornerHoldsWithThreeConstraints) {
  ContactMesh inside = box({0, 0, 0}, {0.1, 0.1, 0.1});  // Felt from within.
  const ContactSurface surface(inside, {spring(500)}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.05, 0.05, 0.05});
  const Vec3 probe{-0.002, -0.003, -0.004};
  const Vec3 force = force_at(surface, proxy, probe);
  EXPECT_EQ(proxy.state().constraints, 3);
  EXPECT_NEAR(force.x, 500 * 0.002, 0.02);
  EXPECT_NEAR(force.y, 500 * 0.003, 0.02);
  EXPECT_NEAR(force.z, 500 * 0.004, 0.02);
  const double s = surface.skin_m();
  EXPECT_NEAR(norm(proxy.state().proxy - Vec3{s, s, s}), 0, surface.tolerance_m());
}

/// Three walls at angles of their own: the proxy rests where their skins meet.
TEST(Proxy, ALeaningCornerHoldsWithThreeConstraints) {
  const Vec3 edges[] = {0.1 * Vec3{1, 0.1, 0}, 0.1 * Vec3{0.3, 1, -0.1}, 0.1 * Vec3{0.2, 0.4, 1}};
  ContactMesh corner;
  corner.positions = {{}, edges[0], edges[1], edges[2]};
  corner.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  const ContactSurface surface(corner, {spring(500)}, {}, 0);
  Proxy proxy(surface);
  proxy.reset(0.1 * (edges[0] + edges[1] + edges[2]));
  const Vec3 normals[] = {normalized(cross(edges[0], edges[1])), normalized(cross(edges[1], edges[2])),
                          normalized(cross(edges[2], edges[0]))};
  const Vec3 probe = -0.002 * normals[0] - 0.003 * normals[1] - 0.004 * normals[2];
  const ProxyState& state = proxy.update(probe, k_tick);
  EXPECT_EQ(state.constraints, 3);
  for (const Vec3& normal : normals) EXPECT_NEAR(dot(normal, state.proxy), surface.skin_m(), surface.tolerance_m());
  EXPECT_NEAR(state.load_m, norm(state.proxy - probe) - surface.skin_m(), surface.tolerance_m());
  EXPECT_LT(norm(state.normal - normalized(state.proxy - probe)), 1e-3);
}

class Speed : public ::testing::TestWithParam<double> {};

TEST_P(Speed, NothingPassesAThinPlate) {
  const double speed = GetParam();
  for (const double radius : {0.0, 5e-4}) {
    const ContactSurface surface(box({0, 0, -1e-4}, {0.1, 0.1, 0}), {spring(500)}, {}, radius);
    for (int run = 0; run < 200; ++run) {
      Proxy proxy(surface);
      Vec3 probe{0.01 + 3.7e-4 * run, 0.013 + 2.9e-4 * run, 0.0205 + 1e-5 * run};
      proxy.reset(probe);
      for (int i = 0; i < 60; ++i) {
        probe = probe + Vec3{0.1 * speed * k_tick, 0, -speed * k_tick};
        const ProxyState& state = proxy.update(probe, k_tick);
        ASSERT_GT(state.proxy.z, radius) << "run " << run << " tick " << i;
        if (probe.z < radius) {
          ASSERT_TRUE(state.in_contact) << probe.z;
        } else if (probe.z > surface.contact_radius_m()) {
          ASSERT_FALSE(state.in_contact) << probe.z;
        }
        if (probe.z < -0.02) break;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Proxy, Speed, ::testing::Values(0.05, 0.5, 2.0));

TEST(Proxy, NeverLosesAPlateOfSlivers) {
  // 40 000 triangles of 0.02 × 10 mm.
  const ContactSurface surface(plate(2000, 10, 0.04, 0.1), {spring(500)}, {}, 0);
  ASSERT_EQ(surface.skipped_triangles(), 0U);
  Proxy proxy(surface);
  Wanderer wanderer(11, 0.04, 0.004, 2e-4);
  proxy.reset({0.02, 0.02, 0.01});
  int lost = 0;
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec2 at = wanderer.next();
    const Vec3 probe{at.x, at.y + 0.03, -0.002 + 0.001 * std::cos(0.01 * i)};
    const ProxyState& state = proxy.update(probe, k_tick);
    if (!state.in_contact) ++lost;
    worst = std::max(worst, norm(Vec3{state.proxy.x - probe.x, state.proxy.y - probe.y, 0}));
  }
  EXPECT_EQ(lost, 0);
  EXPECT_LT(worst, 1e-5);  // Without friction it is above the probe.
}

TEST(Proxy, TrianglesOfNoWidthAreFelt) {
  // As wide as a float can tell from zero: the square of an edge vanishes beside its products with other lengths.
  for (const double width : {1e-40, 1e-45, 1e-20}) {
    ContactMesh needle;
    needle.positions = {{0, 0, -0.5}, {width, 0, 0.5}, {0, width, 0.5}};
    needle.triangles = {{0, 1, 2}};
    const ContactSurface surface(needle, {spring(500)}, {}, 5e-4);
    Proxy proxy(surface);
    proxy.reset({0.002, 1e-7, 0.1});
    for (int i = 0; i < 60; ++i) {
      const ProxyState& state = proxy.update({0.002 - 1e-4 * i, 1e-7, 0.1}, k_tick);
      ASSERT_TRUE(is_finite(state.proxy) && is_finite(state.normal)) << width << " at tick " << i;
    }
  }
}

TEST(Proxy, SoupWithGapsDuplicatesAndTJunctionsHolds) {
  ContactMesh soup;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-4e-6, 4e-6);
  const int n = 40;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = 1e-3 * i, y = 1e-3 * j, dx = j % 2 ? 5e-4 : 0;  // Rows are shifted against each other.
      const auto base = static_cast<std::uint32_t>(soup.positions.size());
      for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1e-3, 0.0}, {1e-3, 1e-3}, {0.0, 1e-3}})
        soup.positions.push_back({x + u + dx + jitter(random), y + v + jitter(random), jitter(random)});
      soup.triangles.push_back({base, base + 1, base + 2});
      soup.triangles.push_back({base, base + 2, base + 3});
      if ((i + j) % 7 == 0) soup.triangles.push_back({base, base + 1, base + 2});
      if ((i + j) % 5 == 0) soup.triangles.push_back({base + 1, base, base + 2});  // Facing the other way.
    }
  const ContactSurface surface(soup, {spring(500)}, {}, 0);
  Proxy proxy(surface);
  Wanderer wanderer(5, 0.04, 0.004, 3e-5);
  proxy.reset({0.02, 0.02, 0.01});
  for (int i = 0; i < 20000; ++i) {
    const Vec2 at = wanderer.next();
    const ProxyState& state = proxy.update({at.x, at.y, -0.001}, k_tick);
    ASSERT_TRUE(state.in_contact) << i;
    ASSERT_GT(state.proxy.z, 0) << i;
  }
}

/// A proxy of its own, slow and simple: creeps down |x − probe|² over the true height function in steps of 2 µm.
Vec3 descent(Vec3 x, Vec3 probe) {
  const double e = 1e-7;
  double last = norm(x - probe);
  for (double step = 2e-5; step > 1e-6;) {
    const double hx = (rough_relief(x.x + e, x.y) - rough_relief(x.x - e, x.y)) / (2 * e);
    const double hy = (rough_relief(x.x, x.y + e) - rough_relief(x.x, x.y - e)) / (2 * e);
    const Vec3 d = probe - x;
    const Vec2 g{d.x + hx * d.z, d.y + hy * d.z};
    const double length = norm(g);
    if (length == 0) break;
    Vec3 y{x.x + step * g.x / length, x.y + step * g.y / length, 0};
    y.z = rough_relief(y.x, y.y);
    const double now = norm(y - probe);
    if (now < last) {
      x = y;
      last = now;
    } else {
      step /= 2;
    }
  }
  return x;
}

TEST(Proxy, IsNeverStuckOnARoughRelief) {
  const ContactSurface surface(height_grid(500, 500, 0.1, 0.1, rough_relief), {spring(500)}, {}, 0);
  Proxy proxy(surface);
  Wanderer wanderer(2, 0.1, 0.01, 2e-4);
  proxy.reset({0.05, 0.05, 0.02});
  int stuck = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec2 at = wanderer.next();
    const Vec3 probe{at.x, at.y, rough_relief(at.x, at.y) - 0.0015};
    const Vec3 before = proxy.state().proxy;
    const ProxyState& state = proxy.update(probe, k_tick);
    ASSERT_TRUE(state.in_contact);
    if (i == 0) continue;
    const Vec3 there = descent({before.x, before.y, rough_relief(before.x, before.y)}, probe);
    if (norm(state.proxy - probe) > norm(there - probe) + 1e-4 + 2e-4) ++stuck;
  }
  EXPECT_EQ(stuck, 0);
}

/// The crease between the skins of edges and corners bends around a deep probe, so each step along it is a small part
/// of the rest.
TEST(Proxy, ABallDoesNotCreepAlongBentCreases) {
  const ContactSurface surface(testing::height_grid(316, 316, 0.2, 0.2, testing::rough_relief), {ContactMaterial{}}, {},
                               1e-3);
  Proxy proxy(surface);
  Wanderer wanderer(1, 0.2, 0.02, 2e-4);
  int most = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec2 at = wanderer.next();
    const Vec3 probe{at.x, at.y, testing::rough_relief(at.x, at.y) - 0.002 + 0.001 * std::cos(0.01 * i)};
    if (i == 0) proxy.reset(probe + Vec3{0, 0, 0.02});
    most = std::max(most, proxy.update(probe, k_tick).sweeps);
  }
  EXPECT_LT(most, 40);
}

HeightField sine_field(double amplitude, int waves) {
  const int n = 512;
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < n; ++x)
      samples.push_back(static_cast<std::uint16_t>(
          std::lround(32767.5 + 32767.5 * std::sin(2 * std::numbers::pi * waves * (x + 0.5) / n))));
  HeightFieldOptions options;
  options.scale_m = 2 * amplitude;
  options.offset_m = -amplitude;
  return HeightField(n, 2, samples, options);
}

/// A place of a rough relief where the descent can reach two hollows, 0.3 mm apart: the nearest one, and one that is 5
/// µm farther.
TEST(Proxy, TakesTheNearerOfTwoHollows) {
  const auto height = [](double x, double y) { return 5 * testing::rough_relief(x / 5, y / 5); };
  const Vec3 corner{0.68, 0.755, 0};
  const ContactMesh mesh =
      testing::height_grid(20, 20, 0.02, 0.02, [&](double x, double y) { return height(corner.x + x, corner.y + y); });
  const ContactSurface surface(mesh, {ContactMaterial{}}, {}, 0);
  Proxy proxy(surface);
  const Vec3 rest = Vec3{0.687896285, 0.764078381, 0.001422326} - corner;
  const Vec3 probe = Vec3{0.688278924, 0.763642124, -0.001485704} - corner;
  proxy.reset(rest + Vec3{0, 0, 1e-6});
  proxy.update(Vec3{0.688109545, 0.763748476, -0.001509808} - corner, 1e-3);
  ASSERT_LT(norm(proxy.state().proxy - rest), 1e-5);
  proxy.update(probe, 1e-3);
  const auto nearest = surface.closest_point(probe, 0.01);
  ASSERT_TRUE(nearest);
  EXPECT_LT(norm(proxy.state().proxy - nearest->point), surface.contact_radius_m() + 1e-5);
}

TEST(Proxy, ReliefForceFollowsTheSine) {
  // 0.1 mm waves of 5 mm on a plate; the force is normal to the wave at the point nearest to the probe.
  ContactMaterial material = spring(1000);
  material.height = 0;
  const double a = 1e-4, w = 2 * std::numbers::pi / 5e-3;
  const ContactSurface surface(plate(7, 5, 0.1, 0.1), {material}, {sine_field(a, 20)}, 0);
  Proxy proxy(surface);
  proxy.reset({0.01, 0.05, 0.01});
  double error2 = 0, sum2 = 0;
  int n = 0;
  for (int i = 0; i < 400; ++i, ++n) {
    const double x = 0.01 + i * 2e-4;  // 0.2 m/s.
    const Vec3 probe{x, 0.05, -5e-4};
    const Vec3 force = force_at(surface, proxy, probe);
    double s = x;  // Nearest point (s, a·sin(ws)) by Newton on (s − x) + (h − z)·h' = 0.
    for (int k = 0; k < 50; ++k) {
      const double h = a * std::sin(w * s), d = a * w * std::cos(w * s), dd = -a * w * w * std::sin(w * s);
      s -= ((s - x) + (h - probe.z) * d) / (1 + d * d + (h - probe.z) * dd);
    }
    const Vec3 expected{1000 * (s - x), 0, 1000 * (a * std::sin(w * s) - probe.z)};
    error2 += dot(force - expected, force - expected);
    sum2 += dot(expected, expected);
  }
  EXPECT_LT(std::sqrt(error2 / sum2), 0.01);
}

TEST(Proxy, ReliefIsTheSameOnCoarseAndFineTriangles) {
  ContactMaterial material = spring(1000);
  material.height = 0;
  const ContactSurface coarse(plate(1, 1, 0.1, 0.1), {material}, {sine_field(1e-4, 20)}, 0);
  const ContactSurface fine(plate(90, 70, 0.1, 0.1), {material}, {sine_field(1e-4, 20)}, 0);
  Proxy a(coarse), b(fine);
  a.reset({0.01, 0.04, 0.01});
  b.reset({0.01, 0.04, 0.01});
  for (int i = 0; i < 400; ++i) {
    const Vec3 probe{0.01 + i * 2e-4, 0.04 + i * 1e-4, -5e-4};
    EXPECT_NEAR(norm(force_at(coarse, a, probe) - force_at(fine, b, probe)), 0, 0.01) << i;
  }
}

TEST(Proxy, FractalReliefWithFrictionIsFollowed) {
  ContactMaterial material = spring(500, 0.3, 0.2);
  material.height = 0;
  std::mt19937 random(8);
  std::vector<std::uint16_t> samples(256 * 256);
  for (auto& v : samples) v = static_cast<std::uint16_t>(random() % 65536);
  HeightFieldOptions options;
  options.scale_m = 6e-5;
  options.offset_m = -3e-5;
  options.uv_transform.scale = {2, 2};
  const ContactSurface surface(plate(20, 20, 0.1, 0.1), {material}, {HeightField(256, 256, samples, options)}, 0);
  Proxy proxy(surface);
  proxy.reset({0.01, 0.05, 0.01});
  for (int i = 0; i < 4000; ++i) {
    const Vec3 probe{0.01 + i * 2e-5, 0.05, -8e-4};
    const ProxyState& state = proxy.update(probe, k_tick);
    ASSERT_TRUE(state.in_contact);
    ASSERT_LT(norm(state.proxy - probe), 2.5e-3) << i;
    ASSERT_GE(surface.clearance(state.proxy, 0.01), -2 * surface.tolerance_m()) << i;
  }
}

TEST(Proxy, PositionThatIsNoNumberChangesNothing) {
  const ContactSurface surface(plate(4, 4, 0.1, 0.1), {spring(500)}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.05, 0.05, 0.01});
  proxy.update({0.05, 0.05, -0.001}, k_tick);
  const Vec3 before = proxy.state().proxy;
  proxy.update({std::nan(""), 0, 0}, k_tick);
  EXPECT_EQ(proxy.state().proxy, before);
}

/// Regression: a step over the relief below the resolution of its parameter made a tick endless.
TEST(Proxy, ATickEndsHoweverFarTheProbeJumps) {
  ContactMaterial material = spring(1000);
  material.height = 0;
  const ContactSurface surface(plate(7, 5, 0.1, 0.1), {material}, {sine_field(1e-4, 20)}, 0);
  for (const double far : {1.0, 1e3, 9e5, 1e6, 1e9, 1e20, 1e300}) {
    Proxy proxy(surface);
    proxy.reset({0.05, 0.05, 1e-3});
    const Vec3 before = proxy.state().proxy;
    proxy.update({0.05 + far / 1024, 0.05, -far}, k_tick);
    if (far > ContactSurface::k_farthest_m) {
      EXPECT_EQ(proxy.state().proxy, before);
    }
    proxy.update({-far, 0.05, 1e-4}, k_tick);
    proxy.update({far, 0.05, 1e-4}, k_tick);
    EXPECT_TRUE(is_finite(proxy.state().proxy)) << far;
  }
}

TEST(Proxy, ExtentsFromMillimetresToTenMetres) {
  for (const double size : {1e-3, 0.1, 10.0}) {
    const ContactSurface surface(sphere(100, size / 2), {spring(500)}, {}, 0);
    Proxy proxy(surface);
    proxy.reset({size, 0, 0});
    for (int i = 0; i < 500; ++i) {
      const Vec3 out{std::cos(0.01 * i), std::sin(0.01 * i), 0};
      const ProxyState& state = proxy.update(0.47 * size * out, k_tick);
      ASSERT_TRUE(state.in_contact) << size;
      ASSERT_NEAR(norm(state.proxy), 0.5 * size, 2e-3 * size);
    }
  }
}

}  // namespace
}  // namespace papilla
