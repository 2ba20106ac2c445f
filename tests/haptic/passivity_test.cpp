// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "haptic/passive_contact.hpp"

namespace papilla {
namespace {

class Passivity : public ::testing::TestWithParam<DevicePreset> {};

TEST_P(Passivity, HoldsAtNineTenthsOfTheLimit) {
  const testing::PortEnergy energy = testing::wall_contact(GetParam(), 0.9, 20, 1);
  EXPECT_GT(energy.contact_share, 0.2);
  EXPECT_GE(energy.least_j, 0);
}

TEST_P(Passivity, FailsWithoutTheGuardAtThreeTimesTheLimit) {
  EXPECT_LT(testing::speed_at_rest(GetParam(), 0.9), 1e-3);
  EXPECT_GT(testing::speed_at_rest(GetParam(), 3), 1e-2);
}

TEST_P(Passivity, ControllerTakesEnergyOutOfAnUnstableWall) {
  EXPECT_LT(testing::speed_at_rest(GetParam(), 3, true), 0.5 * testing::speed_at_rest(GetParam(), 3));
}

TEST(PassivityController, LeavesASpringAloneAndSoftensASource) {
  PassivityController controller({.mass_kg = 0.1, .damping = 0.5});
  double x = 0;
  for (int i = 0; i < 200; ++i) {
    const double next = 1e-3 * std::sin(0.03 * i);
    const Vec3 force{-100 * next, 0, 0};
    EXPECT_EQ(controller.apply(force, {next - x, 0, 0}, 1e-3), force);
    x = next;
  }
  EXPECT_EQ(controller.interventions(), 0U);
  for (int i = 0; i < 10; ++i) controller.apply({1, 0, 0}, {1e-4, 0, 0}, 1e-3);
  EXPECT_GT(controller.interventions(), 5U);
  EXPECT_LT(controller.share(), 0.7);
}

INSTANTIATE_TEST_SUITE_P(Device, Passivity, ::testing::ValuesIn(device_presets().begin(), device_presets().end()),
                         [](const auto& preset) { return std::string(preset.param.name); });

}  // namespace
}  // namespace papilla
