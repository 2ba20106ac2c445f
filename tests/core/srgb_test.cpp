// SPDX-License-Identifier: MIT
#include "papilla/core/srgb.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace papilla {
namespace {

// 8-bit values and their linear ones to six digits, by the formula of IEC 61966-2-1 evaluated with 50 digits.
TEST(Srgb, ValuesOfTheStandard) {
  for (const auto& [byte, linear] : {std::pair{0, 0.0},
                                     {1, 0.000303527},
                                     {10, 0.00303527},
                                     {11, 0.00334654},
                                     {64, 0.0512695},
                                     {128, 0.215861},
                                     {188, 0.502886},
                                     {255, 1.0}})
    EXPECT_NEAR(linear_from_srgb(byte / 255.0), linear, 5e-6 * linear) << byte;
}

TEST(Srgb, EveryByteComesBack) {
  for (int byte = 0; byte <= 255; ++byte)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(byte / 255.0)) * 255, byte, 1e-4) << byte;
}

// The standard's rounded constants leave a step of less than 1e-7 between the straight and the curved part.
TEST(Srgb, RisesWithoutVisibleSteps) {
  double last = 0;
  for (int i = 1; i <= 100000; ++i) {
    const double linear = linear_from_srgb(i * 1e-5);
    EXPECT_GT(linear, last);
    EXPECT_LT(linear - last, 2.4e-5);
    last = linear;
  }
  EXPECT_NEAR(linear_from_srgb(0.04045), linear_from_srgb(0.04045 + 1e-12), 1e-7);
  EXPECT_NEAR(srgb_from_linear(0.0031308), srgb_from_linear(0.0031308 + 1e-12), 1e-6);
}

TEST(Srgb, ValuesOutsideAreCut) {
  EXPECT_EQ(linear_from_srgb(-1), 0);
  EXPECT_EQ(linear_from_srgb(2), 1);
  EXPECT_EQ(srgb_from_linear(-1), 0);
  EXPECT_DOUBLE_EQ(srgb_from_linear(2), 1);
}

}  // namespace
}  // namespace papilla
