// SPDX-License-Identifier: MIT
#include "papilla/haptic/textured_normal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "haptic/closest_on_curve.hpp"
#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/haptic_tick.hpp"

namespace papilla {
namespace {

constexpr double k_width = 0.04, k_depth = 0.03, k_wave = 2e-3, k_stiffness = 500;
constexpr double k_turn = 2 * std::numbers::pi / k_wave;

/// offset + range/2·(1 + sin(2πx/λ)).
struct Sine {
  double range = 1e-4, offset = 0;
  double height(double x) const { return offset + 0.5 * range * (1 + std::sin(k_turn * x)); }
  HeightField field() const {
    constexpr int columns = 800, rows = 4;
    std::vector<std::uint16_t> samples;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        samples.push_back(
            static_cast<std::uint16_t>(std::lround(32767.5 * (1 + std::sin(k_turn * (i + 0.5) / columns * k_width)))));
    HeightFieldOptions options;
    options.scale_m = range;
    options.offset_m = offset;
    return HeightField(columns, rows, samples, options);
  }
  /// From (x, z) to the closest point of the sine.
  Vec3 way(double x, double z) const {
    return testing::way_to_curve([this](double a) { return height(a); }, x, z);
  }
};

ContactMaterial textured(double friction = 0, FrictionModel model = FrictionModel::coulomb) {
  ContactMaterial material;
  material.stiffness = k_stiffness;
  material.static_friction = material.dynamic_friction = friction;
  material.friction = model;
  material.model = ForceModel::textured_normal;
  material.height = 0;
  return material;
}

/// The same of the dilated sine: of a ball's centre.
Vec3 way_of_ball(const Sine& sine, double radius, double x, double z) {
  // The closest place of the centre lies on the normal of a point of the sine.
  Vec3 best{0, 0, 1};
  for (int i = -20000; i <= 20000; ++i) {
    const double a = x + 1e-7 * i, slope = 0.5 * sine.range * k_turn * std::cos(k_turn * a),
                 length = std::hypot(1, slope);
    const Vec3 way{a - radius * slope / length - x, 0, sine.height(a) + radius / length - z};
    if (norm(way) < norm(best)) best = way;
  }
  return best;
}

ContactSurface plate_of(const Sine& sine, const ContactMaterial& material = textured()) {
  return ContactSurface(testing::plate(24, 18, k_width, k_depth), {material}, {sine.field()}, 0);
}

SafetyLimits no_limits() { return {.max_force_n = 1000, .slew_n_per_s = 1e12, .soft_start_s = 0}; }

/// Forces along a path, one place a tick, after a start in free space above its first place.
std::vector<Vec3> felt(const ContactSurface& surface, const std::vector<Vec3>& path) {
  const auto tick = std::make_unique<HapticTick>(surface, no_limits(), 1e-3);
  DeviceState state;
  state.position = {path.front().x, path.front().y, 2e-3};
  (*tick)(state);
  std::vector<Vec3> forces;
  for (const Vec3& p : path) {
    state.position = p;
    forces.push_back((*tick)(state));
  }
  return forces;
}

std::vector<Vec3> line(Vec3 from, Vec3 to, int ticks) {
  std::vector<Vec3> path;
  for (int i = 0; i <= ticks; ++i) path.push_back(from + (static_cast<double>(i) / ticks) * (to - from));
  return path;
}

const std::vector<Sine> k_reliefs = {
    {1e-4, 0},      // Stands out.
    {1e-4, -1e-4},  // Goes in.
    {2e-4, -1e-4},  // Both.
    {1e-4, 5e-5},   // Stands out with a gap above the base.
    {4e-4, -1e-4},  // Steep: slopes up to 0.63.
};

TEST(TexturedNormal, IsTheDistanceToTheClosestTexturedPointInsideTheRelief) {
  for (const Sine& sine : k_reliefs) {
    const ContactSurface surface = plate_of(sine);
    double worst = 0;
    // From the surface to 1 mm below: above the base, below it, and deeper than the sine is curved.
    for (int step = 0; step <= 40; ++step) {
      const double x = 0.02 + k_wave * step / 40;
      std::vector<Vec3> path;
      for (const double depth : {2e-6, 1e-5, 3e-5, 6e-5, 1e-4, 2e-4, 5e-4, 1e-3})
        path.push_back({x, 0.013, sine.height(x) - depth});
      const std::vector<Vec3> forces = felt(surface, path);
      for (std::size_t i = 0; i < path.size(); ++i) {
        const Vec3 expected = k_stiffness * sine.way(x, path[i].z);
        worst = std::max(worst, std::abs(norm(forces[i]) - norm(expected)) / k_stiffness);
      }
    }
    EXPECT_LT(worst, 3e-7) << sine.range << ' ' << sine.offset;  // m
  }
}

TEST(TexturedNormal, PointsToTheClosestTexturedPoint) {
  const Sine sine{1e-4, -5e-5};
  const ContactSurface surface = plate_of(sine);
  // As deep as 0.15 mm the closest point is unique: the sine's radius of curvature is 1/(5e-5·k²) = 2 mm.
  for (int step = 0; step <= 40; ++step) {
    const double x = 0.02 + k_wave * step / 40, z = sine.height(x) - 1.5e-4;
    const Vec3 force = felt(surface, {{x, 0.013, z}}).back(), expected = k_stiffness * sine.way(x, z);
    EXPECT_NEAR(norm(force - expected), 0, 2e-3 * norm(expected)) << x;
  }
}

TEST(TexturedNormal, ABallFeelsTheSurfaceOfItsCentre) {
  const Sine sine{1e-4, -5e-5};  // Valleys rounder than the ball: a radius of 2 mm.
  constexpr double radius = 5e-4;
  const ContactSurface surface(testing::plate(24, 18, k_width, k_depth), {textured()},
                               {sine.field().dilated(radius, {k_width, k_depth})}, radius);
  for (int step = 0; step <= 20; ++step) {
    const double x = 0.02 + k_wave * step / 20;
    for (const double depth : {-2e-5, 2e-5, 1e-4, 3e-4, 7e-4}) {
      const double z = sine.height(x) + radius - depth;
      const Vec3 force = felt(surface, {{x, 0.013, z}}).back(), way = way_of_ball(sine, radius, x, z);
      EXPECT_NEAR(norm(force), way.z > 0 ? k_stiffness * norm(way) : 0, k_stiffness * 1e-6) << x << ' ' << depth;
    }
  }
}

/// A ball of 0.5 mm at 0.56 mm from a plate whose relief stands out by 0.1 mm: straight above it touches by 0.04 mm,
/// beside the edge, where the relief is felt by the cosine, it does not.
TEST(TexturedNormal, BesideAnEdgeTheReliefStandsOutByTheCosine) {
  constexpr double radius = 5e-4, distance = 5.6e-4, cosine = 0.3;
  HeightFieldOptions options;
  options.scale_m = 1e-4;
  const ContactSurface surface(testing::plate(24, 18, k_width, k_depth), {textured()},
                               {HeightField(4, 4, std::vector<std::uint16_t>(16, 65535), options)}, radius);
  const auto way = [&](Vec3 probe) {
    ProxyState state;
    state.in_contact = true;
    state.normal = {0, 0, 1};
    state.proxy = {probe.x, probe.y, 2e-3};
    return way_to_textured_surface(surface, state, probe);
  };
  EXPECT_NEAR(norm(way({0.01, 0.013, distance}) - Vec3{0, 0, 4e-5}), 0, 1e-7);
  EXPECT_EQ(way({-distance * std::sqrt(1 - cosine * cosine), 0.013, distance * cosine}), Vec3{});
}

TEST(TexturedNormal, NothingIsFeltAboveTheTexturedSurface) {
  for (const Sine& sine : k_reliefs) {
    const ContactSurface surface = plate_of(sine);
    for (int step = 0; step <= 40; ++step) {
      const double x = 0.02 + k_wave * step / 40;
      // Inside the skin, where the contact counts already.
      for (const Vec3& force : felt(surface, {{x, 0.013, sine.height(x) + 1.5e-5}, {x, 0.013, sine.height(x) + 2e-6}}))
        EXPECT_EQ(norm(force), 0) << x;
    }
  }
}

/// The distance to a surface changes by no more than the probe moves.
void expect_continuous(const std::vector<Vec3>& path, const std::vector<Vec3>& forces, const char* what,
                       double slack_m = 2e-7) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double moved = norm(path[i] - path[i - 1]);
    EXPECT_LE(std::abs(norm(forces[i]) - norm(forces[i - 1])), k_stiffness * (1.001 * moved + slack_m))
        << what << ' ' << i;
  }
}

TEST(TexturedNormal, PressingInAndOutHasNoJump) {
  for (const Sine& sine : k_reliefs)
    for (const double x : {0.0201, 0.02065, 0.0205, 0.0213}) {
      std::vector<Vec3> path = line({x, 0.011, 3e-4 + sine.offset + sine.range}, {x + 1e-4, 0.011, -6e-4}, 1500);
      path.insert(path.end(), path.rbegin(), path.rend());
      const std::vector<Vec3> forces = felt(plate_of(sine), path);
      expect_continuous(path, forces, "press");
      EXPECT_EQ(norm(forces.front()), 0);
      EXPECT_EQ(norm(forces.back()), 0);
      EXPECT_GT(norm(forces[1500]), 0.2);
    }
}

TEST(TexturedNormal, StrokesThroughCrestsHaveNoJump) {
  for (const Sine& sine : k_reliefs)
    for (const double share : {0.9, 0.5, 0.1, -1.0}) {
      // At a height that leaves and enters the relief at every wave, or stays below it, aslant to waves and triangles.
      const double z = sine.offset + share * sine.range;
      const std::vector<Vec3> path = line({0.01, 0.01, z}, {0.02, 0.013, z}, 5000);
      expect_continuous(path, felt(plate_of(sine), path), "stroke");
    }
}

TEST(TexturedNormal, GivesBackWhatWasPutIn) {
  const Sine sine{2e-4, -1e-4};
  std::vector<Vec3> path;
  constexpr int ticks = 8000;
  for (int i = 0; i <= ticks; ++i) {
    const double angle = 2 * std::numbers::pi * i / ticks;
    path.push_back({0.02 + 3e-3 * std::cos(angle), 0.015 + 2e-3 * std::sin(angle), -2e-4 + 3e-4 * std::cos(3 * angle)});
  }
  const std::vector<Vec3> forces = felt(plate_of(sine), path);
  double work = 0, through = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double part = dot(0.5 * (forces[i] + forces[i - 1]), path[i] - path[i - 1]);
    work += part;
    through += std::abs(part);
  }
  EXPECT_LT(std::abs(work), 2e-3 * through);
}

TEST(TexturedNormal, KeepsCoulombsAndBristleFriction) {
  const Sine flat{0, 5e-5};
  for (const FrictionModel model : {FrictionModel::coulomb, FrictionModel::bristle}) {
    const ContactSurface surface = plate_of(flat, textured(0.4, model));
    std::vector<Vec3> path = line({0.01, 0.01, 1e-3}, {0.01, 0.01, -4e-4}, 200);
    const std::vector<Vec3> way = line({0.01, 0.01, -4e-4}, {0.014, 0.013, -4e-4}, 400);
    path.insert(path.end(), way.begin(), way.end());
    const std::vector<Vec3> forces = felt(surface, path);
    const double load = k_stiffness * 4.5e-4;
    const Vec3 force = forces.back(), first = forces[202];
    EXPECT_NEAR(force.z, load, 1e-3 * load);
    EXPECT_NEAR(force.x, -0.4 * load * 0.8, 2e-3 * load);
    EXPECT_NEAR(force.y, -0.4 * load * 0.6, 2e-3 * load);
    // From rest a spring: one step of 12.5 µm.
    EXPECT_NEAR(-first.x, k_stiffness * 1e-5, model == FrictionModel::coulomb ? 1e-9 : 0.05 * k_stiffness * 1e-5);
    expect_continuous(path, forces, "friction");
  }
}

TEST(TexturedNormal, FrictionOnWavesStaysInItsCone) {
  const Sine sine{2e-4, -1e-4};
  for (const FrictionModel model : {FrictionModel::coulomb, FrictionModel::bristle}) {
    const ContactSurface smooth = plate_of(sine), rough = plate_of(sine, textured(0.5, model));
    const std::vector<Vec3> path = line({0.01, 0.01, -1.5e-4}, {0.02, 0.013, -1.5e-4}, 3000);
    const std::vector<Vec3> normal = felt(smooth, path), both = felt(rough, path);
    double most = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_LE(norm(both[i] - normal[i]), 0.5 * norm(normal[i]) * (1 + 1e-9) + 1e-12);
      most = std::max(most, norm(both[i] - normal[i]) / norm(normal[i]));
    }
    EXPECT_GT(most, 0.49);
  }
}

TEST(TexturedNormal, DampingFadesAtTheSurface) {
  ContactMaterial material;
  material.stiffness = 500;
  material.damping = 2;
  const Vec3 way{0, 0, 1e-4};
  EXPECT_NEAR(textured_normal_force(material, way, {0, 0, -0.01}).z, 0.05 + 0.02, 1e-12);
  EXPECT_NEAR(textured_normal_force(material, way, {0, 0, -1}).z, 0.1, 1e-12);
  EXPECT_EQ(norm(textured_normal_force(material, way, {0, 0, 1})), 0);
  EXPECT_EQ(norm(textured_normal_force(material, {}, {0, 0, -1})), 0);
}

/// Sheets of a mesh at heights z, fronts up or down.
ContactMesh sheets(const std::vector<std::pair<double, bool>>& at) {
  ContactMesh mesh;
  for (const auto& [z, up] : at) {
    const ContactMesh sheet = testing::plate(6, 5, k_width, k_depth);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : sheet.positions) mesh.positions.push_back({p.x, p.y, z});
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
      const auto& c = sheet.triangles[t];
      mesh.triangles.push_back({first + c[0], first + c[up ? 1 : 2], first + c[up ? 2 : 1]});
      for (const std::size_t k : {std::size_t{0}, std::size_t{up ? 1U : 2U}, std::size_t{up ? 2U : 1U}})
        mesh.corner_uv.push_back(sheet.corner_uv[3 * t + k]);
    }
  }
  return mesh;
}

TEST(TexturedNormal, NothingTunnelsThroughThinSheets) {
  const Sine sine{1e-4, 0};
  // A panel 0.6 mm thick, a single sheet, and two sheets that face the same way.
  for (const ContactMesh& mesh :
       {sheets({{0, true}, {-6e-4, false}}), sheets({{0, true}}), sheets({{0, true}, {-6e-4, true}})}) {
    const ContactSurface surface(mesh, {textured()}, {sine.field()}, 0);
    const std::vector<Vec3> path = line({0.0201, 0.013, 1e-3}, {0.0203, 0.0131, -3e-3}, 2000);
    const std::vector<Vec3> forces = felt(surface, path);
    for (std::size_t i = 0; i < path.size(); ++i)
      if (path[i].z < -1e-5) {
        EXPECT_GT(forces[i].z, 0.95 * k_stiffness * -path[i].z) << path[i].z;
      }
    // The proxy rests within the tolerance of 1.25 µm.
    expect_continuous(path, forces, "panel", 2.5e-6);
    // As fast as 4 mm in a tick.
    EXPECT_GT(felt(surface, {{0.0201, 0.013, 1e-3}, {0.0203, 0.0131, -3e-3}}).back().z, 0.95 * k_stiffness * 3e-3);
  }
}

TEST(TexturedNormal, TheBackIsTheSmoothBase) {
  const ContactSurface surface = plate_of({1e-4, 0});
  const auto tick = std::make_unique<HapticTick>(surface, no_limits(), 1e-3);
  DeviceState state;
  for (const double z : {-1e-3, -1e-5, 2e-4}) {
    state.position = {0.0203, 0.0131, z};
    const Vec3 force = (*tick)(state);
    EXPECT_NEAR(force.z, z > 0 ? -k_stiffness * z : 0, 0.05 * k_stiffness * 2e-4) << z;
  }
}

TEST(TexturedNormal, WorksOnADrumOfFacets) {
  // 96 facets around, radius 20 mm, waves of 2 mm along the axis.
  constexpr double radius = 0.02;
  constexpr int around = 96, along = 12;
  ContactMesh mesh = testing::height_grid(along, around, k_width, 1, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) {
    const double angle = -2 * std::numbers::pi * p.y;
    p = {p.x, radius * std::cos(angle), radius * std::sin(angle)};
  }
  const Sine sine{2e-4, -1e-4};
  const ContactSurface surface(mesh, {textured()}, {sine.field()}, 0);
  const auto tick = std::make_unique<HapticTick>(surface, no_limits(), 1e-3);
  DeviceState state;
  state.position = {0.01, 0.03, 0};
  (*tick)(state);
  double last = 0;
  Vec3 before = state.position;
  for (int i = 0; i < 6000; ++i) {
    const double angle = 1.5 * i / 6000, r = radius - 1.5e-4, x = 0.01 + 0.01 * i / 6000;
    state.position = {x, r * std::cos(angle), r * std::sin(angle)};
    const Vec3 force = (*tick)(state);
    const double moved = norm(state.position - before);
    if (i > 0) {
      EXPECT_LE(std::abs(norm(force) - last), k_stiffness * (1.01 * moved + 4e-7)) << i;
      const double expected = k_stiffness * norm(sine.way(x, -1.5e-4));
      // Facets lie up to r(1 − cos(π/96)) = 11 µm inside.
      EXPECT_NEAR(norm(force), expected, k_stiffness * 1.3e-5) << i;
    }
    last = norm(force);
    before = state.position;
  }
}

}  // namespace
}  // namespace papilla
