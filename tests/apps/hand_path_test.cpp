// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/hand_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "studio/feel_loop.hpp"

namespace papilla::app {
namespace {

TEST(HandPath, IsLinearBetweenSamplesAndConstantAround) {
  HandPath path;
  EXPECT_FALSE(path.is_begun());
  path.add({1, {0, 0, 0}});
  path.add({2, {3, -6, 9}});
  path.add({2, {100, 0, 0}});  // No later than the one before.
  path.add({1.5, {100, 0, 0}});
  path.add({4, {3, 0, 9}});
  EXPECT_EQ(path.begin_s(), 1);
  EXPECT_EQ(path.newest_s(), 4);
  EXPECT_EQ(path.position(0.5), (Vec3{0, 0, 0}));
  EXPECT_EQ(path.position(1), (Vec3{0, 0, 0}));
  EXPECT_NEAR(norm(path.position(1.25) - Vec3{0.75, -1.5, 2.25}), 0, 1e-15);
  EXPECT_EQ(path.position(2), (Vec3{3, -6, 9}));
  EXPECT_NEAR(norm(path.position(3) - Vec3{3, -3, 9}), 0, 1e-15);
  EXPECT_EQ(path.position(9), (Vec3{3, 0, 9}));
}

TEST(HandPath, IsLiftedOnceAndTakesNoMoreThanItHolds) {
  HandPath path;
  EXPECT_FALSE(path.lifted_s());
  path.lift(2);
  path.lift(1);
  EXPECT_EQ(path.lifted_s(), 2);
  path.clear();
  EXPECT_FALSE(path.lifted_s());
  for (std::size_t i = 0; i <= HandPath::k_most; ++i) path.add({static_cast<double>(i), {}});
  EXPECT_EQ(path.newest_s(), static_cast<double>(HandPath::k_most - 1));
}

/// A plate of 100 x 60 mm that is turned, with friction.
ContactSurface plate() {
  const double c = std::cos(0.4), s = std::sin(0.4);
  ContactMesh mesh;
  for (const Vec2 p : {Vec2{-0.05, -0.03}, Vec2{0.05, -0.03}, Vec2{0.05, 0.03}, Vec2{-0.05, 0.03}})
    mesh.positions.push_back({p.x * c, p.y, p.x * s});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  ContactMaterial material;
  material.stiffness = 300;
  material.static_friction = 0.5, material.dynamic_friction = 0.3;
  return {mesh, {material}, {}, k_default_probe_radius_m};
}

/// The player's loop and this one: the same bits.
TEST(FeelLoop, GivesTheForcesOfThePlayer) {
  const ContactSurface surface = plate();
  const DeviceCaps device = device_preset("touch").caps();
  const double c = std::cos(0.4), s = std::sin(0.4);
  std::vector<Trajectory::Sample> samples;
  HandPath path;
  for (int i = 0; i <= 60; ++i) {
    const double t = 0.25 + 0.007 * i, x = 0.0005 * i - 0.01, up = std::max(-0.003, 0.004 - 0.0004 * i);
    samples.push_back({t, {x * c - up * s, 0.0002 * i, x * s + up * c}});
    path.add(samples.back());
  }
  path.lift(samples.back().t);
  std::vector<FeelRow> rows;
  std::size_t sound = 0, batches = 0;
  const auto take = [&](const FeelBatch& batch) {
    ++batches;
    EXPECT_LE(batch.rows.size(), FeelBatch::k_ticks);
    rows.insert(rows.end(), batch.rows.begin(), batch.rows.end());
    sound += batch.sound.size();
  };
  EXPECT_EQ(run_feel_loop(surface, device, path, take, std::atomic<bool>{false}), FeelEnd::lifted);
  ASSERT_EQ(rows.size(), 421U);
  EXPECT_EQ(batches, (rows.size() + FeelBatch::k_ticks - 1) / FeelBatch::k_ticks);
  EXPECT_NEAR(static_cast<double>(sound), k_feel_sound_hz / k_feel_rate_hz * static_cast<double>(rows.size()), 32);

  const Trajectory hand(samples);
  SimDevice simulated(device, hand, 1 / k_feel_rate_hz);
  std::vector<RecordRow> record;
  LoopOptions loop;
  loop.ticks = rows.size();
  loop.paced = false;
  loop.hand = &hand;
  loop.record = &record;
  run_haptic_loop(simulated, surface, loop);
  ASSERT_EQ(record.size(), rows.size());
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].t, record[i].t);
    EXPECT_NEAR(norm(rows[i].hand - record[i].hand), 0, 1e-15);
    EXPECT_NEAR(norm(rows[i].force - record[i].force), 0, 1e-9) << i;
    EXPECT_EQ(rows[i].in_contact, record[i].in_contact) << i;
    contacts += rows[i].in_contact;
  }
  EXPECT_GT(contacts, 200U);
  EXPECT_LT(contacts, rows.size());
}

TEST(FeelLoop, EndsWhenNothingMoreComesAndWhenItIsStopped) {
  const ContactSurface surface = plate();
  HandPath path;
  path.add({0, {0, 0, 0.02}});
  const DeviceCaps device = device_preset("omega3").caps();
  std::size_t ticks = 0;
  const auto take = [&](const FeelBatch& batch) { ticks += batch.rows.size(); };
  EXPECT_EQ(run_feel_loop(surface, device, path, take, std::atomic<bool>{true}), FeelEnd::stopped);
  EXPECT_EQ(ticks, 1U);
  EXPECT_EQ(run_feel_loop(surface, device, path, take, std::atomic<bool>{false}), FeelEnd::silent);
  EXPECT_EQ(ticks, 1U + 3002U) << "three seconds";
}

}  // namespace
}  // namespace papilla::app
