// SPDX-License-Identifier: MIT
#include "texture/published_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla {
namespace {

class DimensionTable : public testing::TestWithParam<test::DimensionCell> {};

/// Schulze 2005, table 6.1.
TEST_P(DimensionTable, IsReproduced) {
  const test::FourDimensions measured = test::measured_dimensions(GetParam());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(measured[i], GetParam().published[i], 0.12) << i;
  EXPECT_NEAR(measured[3], GetParam().published[3], 0.04);
}

INSTANTIATE_TEST_SUITE_P(Cells, DimensionTable, testing::ValuesIn(test::k_dimension_table));

/// Cho et al. 2017, table 2.
TEST(SignatureTable, IsReproduced) {
  double sta_squares = 0, str_squares = 0;
  for (const test::SignatureRow& published : test::k_signature_table) {
    const test::SignatureRow measured = test::measured_signature(published.hurst);
    EXPECT_NEAR(measured.sta, published.sta, 0.06) << "H " << published.hurst;
    EXPECT_NEAR(measured.str, published.str, 0.06) << "H " << published.hurst;
    sta_squares += std::pow(measured.sta - published.sta, 2) / test::k_signature_table.size();
    str_squares += std::pow(measured.str - published.str, 2) / test::k_signature_table.size();
  }
  EXPECT_LT(std::sqrt(sta_squares), 0.03);
  EXPECT_LT(std::sqrt(str_squares), 0.03);
}

}  // namespace
}  // namespace papilla
