// SPDX-License-Identifier: MIT
#include "papilla/pipeline/measure_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla {
namespace {

/// A part of 100 mm² beside one of 300 mm².
TEST(TotalDistortion, WeighsPartsByTheirArea) {
  DistortionReport small, large;
  small.area_mm2 = 100, large.area_mm2 = 300;
  small.stretch_l2 = 1, large.stretch_l2 = 2;
  small.stretch_linf = 5, large.stretch_linf = 3;
  small.angle_error_deg.mean = 8, large.angle_error_deg.mean = 4;
  small.symmetric_dirichlet.mean = 6, large.symmetric_dirichlet.mean = 4;
  const DistortionTotals total = total_distortion({&small, &large});
  EXPECT_DOUBLE_EQ(total.area_mm2, 400);
  EXPECT_DOUBLE_EQ(total.stretch_l2, std::sqrt((1 * 1 + 3 * 4) / 4.0)) << "a root mean square";
  EXPECT_DOUBLE_EQ(total.stretch_linf, 5);
  EXPECT_DOUBLE_EQ(total.angle_error_deg_mean, 5);
  EXPECT_DOUBLE_EQ(total.symmetric_dirichlet_mean, 4.5);
}

}  // namespace
}  // namespace papilla
