// SPDX-License-Identifier: MIT
#include "papilla/texture/texture_order.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/texture/resample.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

constexpr int k_blocks = 4;

TextureOrder order_of(const GreyImage& image) {
  TextureOrder order;
  const int w = image.width / k_blocks, h = image.height / k_blocks;
  for (int row = 0; row < k_blocks; ++row)
    for (int column = 0; column < k_blocks; ++column) order.add(crop(image, column * w, row * h, w, h));
  return order;
}

TEST(TextureOrder, PiecesTellWhatTheWholeTells) {
  for (const double stretch : {1.0, 8.0}) {
    const GreyImage image = test::make_image(256, 256, [&](int x, int y) {
      return 0.5 + 0.2 * std::sin(0.7 * x) * std::cos(0.9 * y / stretch) +
             0.1 * std::sin(0.31 * x + 0.05 * y / stretch);
    });
    const TextureOrder order = order_of(image);
    const TextureClass pieces = order.classify(0.2, 0.1), whole = classify(image, 0.2, 0.1);
    EXPECT_EQ(pieces.kind, whole.kind);
    EXPECT_NEAR(pieces.weakly_ordered, whole.weakly_ordered, 0.02);
    const Suitability a = order.suitability({}), b = measure_suitability(image, {});
    EXPECT_EQ(a.homogeneous, b.homogeneous);
    EXPECT_EQ(a.directional, b.directional);
    EXPECT_EQ(a.flat, b.flat);
    const OrientationField field = order.orientation(k_blocks, k_blocks);
    EXPECT_EQ(field.angle_deg.size(), 16U);
    EXPECT_NEAR(field.mean_coherence, orientation_field(image).mean_coherence, 0.05);
  }
}

TEST(TextureOrder, OneBrightPieceIsNotHomogeneous) {
  GreyImage image = test::noise_image(256, 256, 1);
  EXPECT_TRUE(order_of(image).suitability({}).homogeneous);
  for (int y = 64; y < 128; ++y)
    for (int x = 128; x < 192; ++x) image.at(x, y) += 2;
  EXPECT_FALSE(order_of(image).suitability({}).homogeneous);
}

TEST(TextureOrder, FlatPiecesOfDifferentGreyAreNotFlat) {
  TextureOrder order;
  order.add(test::make_image(8, 8, [](int, int) { return 0.25; }));
  EXPECT_TRUE(order.suitability({}).flat);
  order.add(test::make_image(8, 8, [](int, int) { return 0.5; }));
  EXPECT_FALSE(order.suitability({}).flat);
}

TEST(TextureOrder, RefusesEmptyPieces) { EXPECT_THROW(TextureOrder().add({}), InvalidInput); }

}  // namespace
}  // namespace papilla
