// SPDX-License-Identifier: MIT
#include "papilla/haptic/real_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_long = 0.12, k_wide = 0.07, k_amplitude = 5e-5, k_wave = 4e-3, k_stiffness = 800, k_radius = 5e-4;

/// h = A sin(2πx/λ) above and below the mesh, over uv along x.
HeightField waves(double length) {
  const int pixels = 4096;
  std::vector<std::uint16_t> samples;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < pixels; ++i)
      samples.push_back(static_cast<std::uint16_t>(
          std::lround(65535 * 0.5 * (1 + std::sin(2 * k_pi * (i + 0.5) / pixels * length / k_wave)))));
  HeightFieldOptions options;
  options.scale_m = 2 * k_amplitude;
  options.offset_m = -k_amplitude;
  return HeightField(pixels, 4, samples, options);
}

ContactMaterial grained() {
  ContactMaterial material;
  material.stiffness = k_stiffness;
  material.height = 0;
  return material;
}

ContactSurface textured_plate() {
  return ContactSurface(testing::plate(12, 7, k_long, k_wide), {grained()}, {waves(k_long)}, k_radius);
}

/// A turn about all axes, and a shift: where the part stands before the device, seen from the part.
Pose somewhere(double a, double b, double c, Vec3 shift) {
  const auto turn = [](Vec3 v, int axis, double angle) {
    double* p[3] = {&v.x, &v.y, &v.z};
    double &x = *p[(axis + 1) % 3], &y = *p[(axis + 2) % 3];
    const double turned = std::cos(angle) * x - std::sin(angle) * y;
    y = std::sin(angle) * x + std::cos(angle) * y;
    x = turned;
    return v;
  };
  Pose pose;
  const std::array<Vec3, 3> columns = {turn(turn(turn({1, 0, 0}, 0, a), 1, b), 2, c),
                                       turn(turn(turn({0, 1, 0}, 0, a), 1, b), 2, c),
                                       turn(turn(turn({0, 0, 1}, 0, a), 1, b), 2, c)};
  pose.rows = {Vec3{columns[0].x, columns[1].x, columns[2].x}, Vec3{columns[0].y, columns[1].y, columns[2].y},
               Vec3{columns[0].z, columns[1].z, columns[2].z}};
  pose.shift = shift;
  return pose;
}

Vec3 inverse(const Pose& pose, Vec3 p) { return pose.turned_back(p - pose.shift); }

const Pose k_truth = somewhere(0.4, -1.1, 2.3, {0.21, -0.08, 0.33});
constexpr std::array<Vec3, 3> k_marks{Vec3{0.01, 0.01, 0}, Vec3{0.1, 0.02, 0}, Vec3{0.04, 0.06, 0}};

TEST(Registration, OfThreePointsIsTheMotionThatMadeThem) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(-3, 3), place(-0.3, 0.3);
  for (int i = 0; i < 200; ++i) {
    const Pose truth = somewhere(angle(random), angle(random), angle(random), {place(random), place(random), 1});
    std::array<Vec3, 3> marks;
    for (Vec3& mark : marks) mark = {place(random), place(random), place(random)};
    if (norm(cross(marks[1] - marks[0], marks[2] - marks[0])) < 0.01) continue;
    std::array<Vec3, 3> touched;
    std::transform(marks.begin(), marks.end(), touched.begin(), [&](Vec3 p) { return inverse(truth, p); });
    const Registration found = register_points(touched, marks);
    EXPECT_LT(found.residual_m, 1e-12);
    const Vec3 other{0.2, -0.4, 0.1};
    EXPECT_LT(norm(found.to_part(other) - truth(other)), 1e-12);
  }
}

/// No turn by a small angle about any axis brings the points nearer.
TEST(Registration, IsTheBestInTheSenseOfLeastSquares) {
  std::array<Vec3, 3> touched{Vec3{0.001, 0, 0}, Vec3{0.101, 0.003, -0.002}, Vec3{0.03, 0.08, 0.004}};
  const std::array<Vec3, 3> marks{Vec3{0, 0.1, 0}, Vec3{0.01, 0.2, 0.02}, Vec3{-0.08, 0.13, 0}};
  const Registration found = register_points(touched, marks);
  const auto squares = [&](const Pose& pose) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(norm(pose(touched[i]) - marks[i]), 2);
    return sum;
  };
  const double best = squares(found.to_part);
  EXPECT_NEAR(std::sqrt(best / 3), found.residual_m, 1e-12);
  const Vec3 middle = (1.0 / 3) * (marks[0] + marks[1] + marks[2]);
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-1e-3, 1e-3}) {
      const Pose by = somewhere(axis == 0 ? angle : 0, axis == 1 ? angle : 0, axis == 2 ? angle : 0, {});
      Pose turned;
      for (std::size_t r = 0; r < 3; ++r) {
        const Vec3 row = by.rows[r];
        turned.rows[r] = row.x * found.to_part.rows[0] + row.y * found.to_part.rows[1] + row.z * found.to_part.rows[2];
      }
      turned.shift = by.turned(found.to_part.shift - middle) + middle;
      EXPECT_GT(squares(turned), best);
    }
}

TEST(Registration, LaysAPlaneUponTheOther) {
  std::array<Vec3, 3> touched;
  std::transform(k_marks.begin(), k_marks.end(), touched.begin(), [](Vec3 p) { return inverse(k_truth, p); });
  const Registration found = register_plane(touched, {0.05, 0.03, 0}, {0, 0, 1}, {0, 1, 0});
  EXPECT_LT(norm(found.to_part(touched[0]) - Vec3{0.05, 0.03, 0}), 1e-12);
  EXPECT_NEAR(found.to_part(touched[1]).z, 0, 1e-12);
  EXPECT_NEAR(found.to_part(touched[2]).z, 0, 1e-12);
  EXPECT_NEAR(found.to_part(touched[1]).x, 0.05, 1e-12);  // Along y, as was asked.
  EXPECT_LT(found.to_part(touched[2]).x, 0.05);           // The third one on the left of it.
  // A direction that leans out of the plane counts as its part in it.
  const Registration leaning = register_plane(touched, {0.05, 0.03, 0}, {0, 0, 1}, {0, 1, 2});
  for (const Vec3 p : touched) EXPECT_LT(norm(leaning.to_part(p) - found.to_part(p)), 1e-12);
}

TEST(Registration, RefusesWhatTellsNoPlace) {
  const std::array<Vec3, 3> line{Vec3{0, 0, 0}, Vec3{0.1, 0, 0}, Vec3{0.2, 1e-4, 0}};
  EXPECT_THROW(register_points(line, k_marks), InvalidInput);
  EXPECT_THROW(register_points(k_marks, line), InvalidInput);
  EXPECT_THROW(register_points({Vec3{}, Vec3{}, Vec3{}}, k_marks), InvalidInput);
  EXPECT_THROW(register_points({Vec3{std::numeric_limits<double>::quiet_NaN(), 0, 0}, k_marks[1], k_marks[2]}, k_marks),
               InvalidInput);
  EXPECT_THROW(register_plane(k_marks, {}, {0, 0, 1}, {0, 0, 2}), InvalidInput);
}

/// A stylus that slides over the real plate, in the device's frame.
TEST(RealPart, GivesTheDeviationOfTheTextureAlone) {
  const ContactSurface surface = textured_plate();
  RealPart part(surface, k_truth, {.press_n = 0.6});
  const double w = 2 * k_pi / k_wave;
  double normal_error = 0, lateral_error = 0, across = 0, mean = 0;
  int count = 0;
  for (double x = 0.02; x < 0.1; x += 7.3e-5, ++count) {
    const Vec3 tip{x, 0.03 + 0.1 * (x - 0.02), k_radius};
    const Vec3 force = k_truth.turned(part.force(inverse(k_truth, tip)));
    const double spring = k_stiffness * k_amplitude * std::sin(w * x);
    normal_error = std::max(normal_error, std::abs(force.z - spring));
    lateral_error = std::max(lateral_error, std::abs(force.x + (0.6 + spring) * k_amplitude * w * std::cos(w * x)));
    across = std::max(across, std::abs(force.y));
    mean += force.z;
    EXPECT_TRUE(part.state().in_contact);
    EXPECT_LT(norm(k_truth(part.state().proxy) - tip), 1e-6);
  }
  const double range = k_stiffness * k_amplitude;
  EXPECT_LT(normal_error, 0.05 * range);  // What the ball of the tip takes of the valleys.
  EXPECT_LT(lateral_error, 0.05 * 0.64 * k_amplitude * w);
  EXPECT_LT(across, 1e-3 * range);
  EXPECT_LT(std::abs(mean / count), 0.05 * range);
}

TEST(RealPart, IsConservative) {
  const ContactSurface surface = textured_plate();
  RealPart part(surface, {}, {.press_n = 0.8});
  const auto energy = [&](double x) {
    const double spring = part.force({x, 0.03, k_radius}).z;
    return std::pow(0.8 + spring, 2) / (2 * k_stiffness);
  };
  double work = 0;
  const double begin = 0.0213, end = 0.0577, step = 1e-6;
  for (double x = begin; x < end - step / 2; x += step) work += step * part.force({x + step / 2, 0.03, k_radius}).x;
  EXPECT_NEAR(work, energy(begin) - energy(end), 0.01 * energy(begin));
}

TEST(RealPart, ASmoothPartIsNoForce) {
  ContactMaterial smooth;
  const ContactSurface surface(testing::sphere(40, 0.05), {smooth}, {}, k_radius);
  RealPart part(surface, k_truth);
  for (double angle = 0; angle < 3; angle += 0.1) {
    const Vec3 tip = (0.05 + k_radius) * Vec3{std::cos(angle), std::sin(angle), 0.0};
    EXPECT_EQ(norm(part.force(inverse(k_truth, tip))), 0);
  }
}

TEST(RealPart, ALiftedTipFeelsNothingAndNoStepOnTheWay) {
  const ContactSurface surface = textured_plate();
  RealPart part(surface, {}, {.reach_m = 1e-3});
  const double crest = 0.02 + k_wave / 4;
  const double full = part.force({crest, 0.03, k_radius}).z;
  EXPECT_NEAR(full, k_stiffness * k_amplitude, 0.02 * full);
  EXPECT_NEAR(part.force({crest, 0.03, k_radius + 4.9e-4}).z, full, 1e-6);  // Registration may be off by that.
  EXPECT_NEAR(part.force({crest, 0.03, k_radius - 4.9e-4}).z, full, 1e-6);
  double last = full;
  for (double up = 0; up < 3e-3; up += 1e-6) {
    const double now = part.force({crest, 0.03, k_radius + up}).z;
    EXPECT_LT(std::abs(now - last), 1e-2 * full);
    if (up > 1.001e-3) EXPECT_EQ(now, 0);
    last = now;
  }
  EXPECT_EQ(norm(part.force({1, 1, 1})), 0);
}

TEST(RealPart, TicksGoThroughTheGuard) {
  const ContactSurface surface = textured_plate();
  HapticTick tick(surface, safety_limits(3.3), 1e-3);
  tick.follow(RealPart(surface, k_truth, {.press_n = 0.6}));
  DeviceState state;
  Vec3 force;
  for (int i = 0; i < 400; ++i) {
    state.position = inverse(k_truth, {0.02 + 5e-5 * i, 0.03, k_radius});
    force = tick(state);
    EXPECT_LE(norm(force), 3.3);
    if (i == 0) {
      EXPECT_LT(norm(force), 2e-3);  // Fades in.
    }
  }
  RealPart alone(surface, k_truth, {.press_n = 0.6});
  EXPECT_LT(norm(force - alone.force(state.position)), 1e-9);
  EXPECT_TRUE(tick.proxy().in_contact);
  state.position = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  EXPECT_EQ(norm(tick(state)), 0);
}

TEST(RealPart, RefusesBadOptions) {
  const ContactSurface surface = textured_plate();
  EXPECT_THROW(RealPart(surface, {}, {.press_n = -1}), InvalidInput);
  EXPECT_THROW(RealPart(surface, {}, {.reach_m = 0}), InvalidInput);
}

}  // namespace
}  // namespace papilla
