// SPDX-License-Identifier: MIT
#include "papilla/pipeline/quantity_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/decode_grey16.hpp"

namespace papilla {
namespace {

/// Maps of 64 x 4 texels of `pitch_mm`; value(u) of u in [0, 1).
template <class Value>
Values<float> along_u(Value&& value) {
  Values<float> values;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 64; ++x) values.push_back(static_cast<float>(value((x + 0.5) / 64)));
  return values;
}

double wave(double u) { return 1 + 0.5 * std::sin(2 * std::numbers::pi * u); }

QuantityMaps maps_of(double pitch_mm, std::vector<QuantityMap> maps) {
  return {64, 4, pitch_mm, pitch_mm, true, std::move(maps)};
}

ChannelField field_of(const MapsTag& tag) {
  const std::string png = decode_data_uri(tag.uri).value();
  Rgb16 rgb = decode_rgb16(std::as_bytes(std::span(png.data(), png.size())), "maps");
  EXPECT_EQ(rgb.bits, tag.bits);
  EXPECT_EQ(rgb.width, tag.size[0]);
  EXPECT_EQ(rgb.height, tag.size[1]);
  return ChannelField(rgb.width, rgb.height, std::move(rgb.values), {tag.channels, tag.uv_transform, tag.wrap});
}

TEST(QuantityMaps, ReadAgainTheyAreWithinHalfAStep) {
  const auto tag = encode_quantity_maps(
      maps_of(1, {{Quantity::damping, along_u(wave)},
                  {Quantity::dynamic_friction, along_u([](double u) { return 0.2 * wave(u + 0.3); })}}));
  ASSERT_TRUE(tag);
  EXPECT_EQ(tag->bits, 8);
  EXPECT_EQ(tag->sha256.size(), 64U);
  const ChannelField field = field_of(*tag);
  for (int x = 0; x < 64; ++x) {
    const double u = (x + 0.5) / 64;
    ContactConstants there;
    field.apply({u, 0.5}, there);
    EXPECT_NEAR(there.damping, wave(u), 0.51 / 255);
    EXPECT_NEAR(there.dynamic_friction, 0.2 * wave(u + 0.3), 0.2 * 0.51 / 255);
  }
}

TEST(QuantityMaps, WhatIsTheSameEverywhereIsNoMap) {
  const auto constant = along_u([](double) { return 0.4; });
  EXPECT_FALSE(encode_quantity_maps(maps_of(1, {{Quantity::damping, constant}})));
  EXPECT_FALSE(encode_quantity_maps(maps_of(1, {})));
  const auto one =
      encode_quantity_maps(maps_of(1, {{Quantity::damping, constant}, {Quantity::dynamic_friction, along_u(wave)}}));
  ASSERT_TRUE(one);
  EXPECT_EQ(one->channels[0].value().quantity, Quantity::dynamic_friction);
  EXPECT_FALSE(one->channels[1]);
}

TEST(QuantityMaps, TexelsThatNoFingerTellsAreAveraged) {
  // 0.02 mm a texel: 0.08 mm would still be halved, but the height of 4 is 1 then.
  const auto fine = encode_quantity_maps(maps_of(0.02, {{Quantity::dynamic_friction, along_u(wave)}}));
  EXPECT_EQ(fine.value().size, (std::array<int, 2>{16, 1}));
  EXPECT_EQ(encode_quantity_maps(maps_of(0.2, {{Quantity::dynamic_friction, along_u(wave)}})).value().size,
            (std::array<int, 2>{64, 4}));
}

/// Texels of 0.01 by 0.05 mm become such of 0.02 by 0.1 mm, the mean of two columns and two rows each.
TEST(QuantityMaps, TexelsThatAreNotSquareAreAveragedOnce) {
  const auto value = [](int x, int y) { return 1 + 0.1 * x + 0.05 * y * y; };
  QuantityMap map{Quantity::dynamic_friction, {}};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) map.values.push_back(static_cast<float>(value(x, y)));
  const auto once = encode_quantity_maps({16, 8, 0.01, 0.05, true, {map}});
  ASSERT_EQ(once.value().size, (std::array<int, 2>{8, 4}));
  const ChannelField field = field_of(*once);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      ContactConstants there;
      field.apply({(x + 0.5) / 8, (y + 0.5) / 4}, there);
      const double mean = 0.25 * (value(2 * x, 2 * y) + value(2 * x + 1, 2 * y) + value(2 * x, 2 * y + 1) +
                                  value(2 * x + 1, 2 * y + 1));
      EXPECT_NEAR(there.dynamic_friction, mean, 0.51 * 4 / 255) << x << ' ' << y;
    }
  EXPECT_EQ(encode_quantity_maps({16, 8, 0.01, 0.2, true, {map}}).value().size, (std::array<int, 2>{16, 8}));
}

/// A step from 1 to 3 becomes a ramp of ln 3 / 0.5 mm; what is gentler stays.
TEST(QuantityMaps, StiffnessIsNoSteeperThanTheHandMayGain) {
  const auto step = [](double u) { return u > 0.25 && u < 0.75 ? 3.0 : 1.0; };
  const auto steepest = [](const MapsTag& tag) {
    const ChannelField field = field_of(tag);
    double most = 0;
    for (double u = 0; u < 1; u += 1.0 / 640) {
      ContactConstants there;
      const Vec2 gradient = field.apply({u, 0.5}, there);
      most = std::max(most, std::abs(gradient.x) / 64 / 0.25 / there.stiffness);  // Per mm.
    }
    return most;
  };
  const auto sharp = encode_quantity_maps(maps_of(0.25, {{Quantity::stiffness, along_u(step)}}));
  EXPECT_LT(steepest(sharp.value()), 1.15 * k_steepest_stiffness_per_mm);  // Differences instead of logarithms, 8 bits.
  EXPECT_GT(sharp->channels[0].value().scale, 1.9);
  const auto gentle = encode_quantity_maps(maps_of(0.25, {{Quantity::stiffness, along_u(wave)}}));
  ContactConstants there;
  field_of(gentle.value()).apply({(10 + 0.5) / 64, 0.5}, there);
  EXPECT_NEAR(there.stiffness, wave((10 + 0.5) / 64), 0.51 / 255);
}

TEST(QuantityMaps, BecomeQuantitiesByTheConstants) {
  auto maps = encode_quantity_maps(
      maps_of(1, {{Quantity::stiffness, along_u([](double u) { return 1 + 0.2 * std::sin(2 * std::numbers::pi * u); })},
                  {Quantity::damping, along_u(wave)}}));
  MaterialTag constants;
  constants.stiffness = 600;
  constants.damping = 0;
  EXPECT_EQ(scale_by_constants(maps, constants), (std::vector<Quantity>{Quantity::damping}));
  ASSERT_TRUE(maps);
  EXPECT_FALSE(maps->channels[1]);
  EXPECT_NEAR(maps->channels[0].value().least(), 480, 1);
  EXPECT_NEAR(maps->channels[0]->most(), 720, 1);
  constants.stiffness = 0;
  EXPECT_EQ(scale_by_constants(maps, constants).size(), 1U);
  EXPECT_FALSE(maps);
}

TEST(QuantityMaps, RefusesWhatIsNone) {
  EXPECT_THROW(encode_quantity_maps({0, 4, 1, 1, false, {}}), InvalidInput);
  EXPECT_THROW(encode_quantity_maps(maps_of(1, {{Quantity::damping, {1, 2}}})), InvalidInput);
  EXPECT_THROW(encode_quantity_maps(maps_of(1, {{Quantity::damping, along_u([](double) { return -1; })}})),
               InvalidInput);
  EXPECT_THROW(encode_quantity_maps(maps_of(1, std::vector<QuantityMap>(4, {Quantity::damping, along_u(wave)}))),
               InvalidInput);
}

}  // namespace
}  // namespace papilla
