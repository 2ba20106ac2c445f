// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "checks.hpp"
#include "fft.hpp"
#include "pieces.hpp"

namespace papilla::texture_detail {
namespace {

TEST(PieceSpans, WeightsOfASampleAddUpToOneAndLengthsAreSuitable) {
  for (const int side : {65, 300, 1000, 1031, 20000, 20011})
    for (const bool periodic : {false, true}) {
      PieceLayout layout{.core = 128, .overlap = 32, .periodic = periodic, .suitable = good_fft_size};
      std::vector<double> sums(static_cast<std::size_t>(side), 0.0);
      const std::vector<PieceSpan> spans = piece_spans(side, layout);
      for (std::size_t k = 0; k < spans.size(); ++k) {
        for (int i = 0; i < spans[k].length(); ++i) {
          const double weight = spans[k].weights[static_cast<std::size_t>(i)];
          EXPECT_GT(weight, 0);
          EXPECT_LE(weight, 1);
          ASSERT_TRUE(periodic || spans[k].begin + i < side);
          sums[static_cast<std::size_t>(wrapped(spans[k].begin + i, side))] += weight;
        }
        const bool goes_on = spans.size() > 1 && (periodic || k + 1 < spans.size());
        EXPECT_TRUE(!goes_on || spans[k].length() == good_fft_size(spans[k].length())) << side << ' ' << k;
      }
      for (const double sum : sums) EXPECT_NEAR(sum, 1, 1e-12) << side;
    }
}

}  // namespace
}  // namespace papilla::texture_detail
