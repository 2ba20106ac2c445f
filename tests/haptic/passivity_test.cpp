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

INSTANTIATE_TEST_SUITE_P(Device, Passivity, ::testing::ValuesIn(device_presets().begin(), device_presets().end()),
                         [](const auto& preset) { return std::string(preset.param.name); });

}  // namespace
}  // namespace papilla
