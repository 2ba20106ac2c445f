// SPDX-License-Identifier: MIT
#include "papilla/haptic/channel_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/haptic/channel_average.hpp"

namespace papilla {
namespace {

constexpr MapChannel k_stiffness{Quantity::stiffness, 600, 200}, k_friction{Quantity::dynamic_friction, 0.5, 0.1},
    k_damping{Quantity::damping, -2, 3};

ChannelFieldOptions three_channels() { return {{k_stiffness, k_friction, k_damping}, {}, {}}; }

/// Random texels.
std::vector<ChannelField::Texel> noise(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> value(0, 65535);
  std::vector<ChannelField::Texel> texels(static_cast<std::size_t>(count));
  for (auto& texel : texels)
    for (auto& v : texel) v = static_cast<std::uint16_t>(value(random));
  return texels;
}

ContactConstants at(const ChannelField& field, Vec2 uv, ContactConstants constants = {}) {
  field.apply(uv, constants);
  return constants;
}

TEST(ChannelField, IsTheTexelAtItsCentre) {
  const auto texels = noise(5 * 3, 1);
  const ChannelField field(5, 3, texels, three_channels());
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) {
      const ContactConstants found = at(field, {(x + 0.5) / 5, (y + 0.5) / 3});
      const auto& texel = texels[static_cast<std::size_t>(5 * y + x)];
      EXPECT_NEAR(found.stiffness, 200 + 600 * texel[0] / 65535.0, 1e-9);
      EXPECT_NEAR(found.dynamic_friction, 0.1 + 0.5 * texel[1] / 65535.0, 1e-12);
      EXPECT_NEAR(found.damping, 3 - 2 * texel[2] / 65535.0, 1e-12);
    }
}

std::vector<ChannelField::Texel> as_felt(const std::vector<ChannelField::Texel>& texels, int width, double radius_m,
                                         Vec2 metres_per_uv) {
  return average_texels(texels, width, static_cast<int>(texels.size()) / width, {}, {Wrap::repeat, Wrap::repeat},
                        radius_m, metres_per_uv);
}

TEST(AverageTexels, ABallFeelsMeans) {
  // A square wave of 16 texels of 0.1 mm, black from texel 0 and white from 8 on: a ball of 0.3 mm feels ramps of
  // seven.
  constexpr int k_size = 16;
  std::vector<ChannelField::Texel> texels(k_size * 2);
  for (int i = 0; i < 2 * k_size; ++i)
    if (i % k_size >= 8) texels[static_cast<std::size_t>(i)] = {63000, 7000, 21};
  const auto ball = as_felt(texels, k_size, 3e-4, {1.6e-3, 1.0});
  for (int x = 0; x < k_size; ++x) {
    int white = 0;
    for (int i = -3; i <= 3; ++i) white += (x + i + k_size) % k_size >= 8;
    for (const int y : {0, 1}) {
      const auto& texel = ball[static_cast<std::size_t>(y * k_size + x)];
      EXPECT_EQ(texel[0], 9000 * white) << x;
      EXPECT_EQ(texel[1], 1000 * white) << x;
      EXPECT_EQ(texel[2], 3 * white) << x;
    }
  }
  EXPECT_EQ(as_felt(texels, k_size, 0, {1.6e-3, 1.0}), texels) << "a point";
  EXPECT_EQ(as_felt(texels, k_size, 3e-4, {}), texels) << "of no known size";
  // Wider than the map: 8 or 9 of 17 texels are white, once round.
  for (const auto& texel : as_felt(texels, k_size, 1, {1.6e-3, 0})) {
    EXPECT_GE(texel[0], 63000 * 8 / 17);
    EXPECT_LE(texel[0], 63000 * 9 / 17 + 1);
  }
  EXPECT_EQ(as_felt(texels, k_size, -1, {1.6e-3, 1.0}), texels);
  EXPECT_EQ(as_felt(texels, k_size, std::numeric_limits<double>::quiet_NaN(), {1.6e-3, 1.0}), texels);
}

TEST(AverageTexels, EveryAxisHasItsOwnSizeAndBorder) {
  // 16 rows of 0.1 mm, which end at both borders; two columns of half a metre, which repeat.
  std::vector<ChannelField::Texel> texels(2 * 16);
  for (std::size_t i = 16; i < 32; ++i) texels[i] = {63000, 7000, 21};
  const auto ball = average_texels(texels, 2, 16, {}, {Wrap::repeat, Wrap::clamp}, 3e-4, {1.0, 1.6e-3});
  for (int y = 0; y < 16; ++y) {
    int white = 0;
    for (int i = -3; i <= 3; ++i) white += std::clamp(y + i, 0, 15) >= 8;
    for (const int x : {0, 1}) EXPECT_EQ(ball[static_cast<std::size_t>(2 * y + x)][0], 9000 * white) << y;
  }
}

TEST(AverageTexels, KeepTheMeanAndBoundTheSlope) {
  const auto texels = noise(8 * 8, 7), ball = as_felt(texels, 8, 2.0 / 8, {1, 1});
  double before = 0, after = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) before += texels[i][0], after += ball[i][0];
  EXPECT_NEAR(after / 64, before / 64, 0.5);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_LE(std::abs(ball[static_cast<std::size_t>(8 * y + (x + 1) % 8)][1] -
                         ball[static_cast<std::size_t>(8 * y + x)][1]),
                65535 / 5 + 2);
}

/// The closed form of four corners.
TEST(ChannelField, IsBilinearBetweenTexels) {
  const auto texels = noise(4 * 4, 2);
  const ChannelField field(4, 4, texels, three_channels());
  for (const Vec2 f : {Vec2{0.25, 0.5}, Vec2{0.9, 0.1}, Vec2{0.5, 0.5}}) {
    const auto v = [&](int x, int y) { return 200 + 600 * texels[static_cast<std::size_t>(4 * y + x)][0] / 65535.0; };
    const double expected =
        (1 - f.x) * (1 - f.y) * v(1, 2) + f.x * (1 - f.y) * v(2, 2) + (1 - f.x) * f.y * v(1, 3) + f.x * f.y * v(2, 3);
    EXPECT_NEAR(at(field, {(1.5 + f.x) / 4, (2.5 + f.y) / 4}).stiffness, expected, 1e-9);
  }
}

TEST(ChannelField, WrapsAsItsOptionsSay) {
  std::vector<ChannelField::Texel> texels;
  for (const int v : {0, 20000, 40000, 60000}) texels.push_back({static_cast<std::uint16_t>(v), 0, 0});
  const auto value = [&](Wrap wrap, double u) {
    const ChannelField field(4, 1, texels, {{MapChannel{Quantity::stiffness, 65535, 0}}, {}, {wrap, wrap}});
    return at(field, {u, 0.5}).stiffness;
  };
  EXPECT_NEAR(value(Wrap::repeat, 1), 30000, 1e-6);  // Between the last and the first.
  EXPECT_NEAR(value(Wrap::clamp, 1), 60000, 1e-6);
  EXPECT_NEAR(value(Wrap::mirror, 1.125), 60000, 1e-6);
  EXPECT_NEAR(value(Wrap::mirror, 1.375), 40000, 1e-6);
  EXPECT_NEAR(value(Wrap::repeat, -7.875), value(Wrap::repeat, 0.125), 1e-6);
  const auto down = [&](std::array<Wrap, 2> wrap) {
    const ChannelField field(1, 4, texels, {{MapChannel{Quantity::stiffness, 65535, 0}}, {}, wrap});
    return at(field, {0.5, 1}).stiffness;
  };
  EXPECT_NEAR(down({Wrap::clamp, Wrap::repeat}), 30000, 1e-6);
  EXPECT_NEAR(down({Wrap::repeat, Wrap::clamp}), 60000, 1e-6);
}

TEST(ChannelField, GradientIsThatOfFiniteDifferences) {
  ChannelFieldOptions options = three_channels();
  options.uv_transform = {{0.3, -0.2}, 0.7, {2, 3}};
  const ChannelField field(16, 8, noise(16 * 8, 3), options);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> coordinate(-2, 2);
  constexpr double k_step = 1e-7;
  int near_a_line = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec2 uv{coordinate(random), coordinate(random)};
    ContactConstants constants;
    const Vec2 gradient = field.apply(uv, constants);
    const Vec2 measured{
        (at(field, uv + Vec2{k_step, 0}).stiffness - at(field, uv - Vec2{k_step, 0}).stiffness) / (2 * k_step),
        (at(field, uv + Vec2{0, k_step}).stiffness - at(field, uv - Vec2{0, k_step}).stiffness) / (2 * k_step)};
    near_a_line += norm(gradient - measured) > 1e-3 * (1 + norm(gradient));
  }
  EXPECT_LE(near_a_line, 2);  // Between texels it jumps.
}

TEST(ChannelField, FollowsTheTransform) {
  const auto texels = noise(8 * 5, 5);
  ChannelFieldOptions turned = three_channels();
  turned.uv_transform = {{0.1, 0.2}, 0, {3, 5}};
  const ChannelField plain(8, 5, texels, three_channels()), moved(8, 5, texels, turned);
  EXPECT_NEAR(at(moved, {0.3, 0.7}).stiffness, at(plain, {0.1 + 0.9, 0.2 + 3.5}).stiffness, 1e-9);
}

/// One friction on the map: the other one keeps its ratio to it.
TEST(ChannelField, FrictionWithoutMapFollowsInTheRatioOfTheConstants) {
  ContactConstants constants;
  constants.static_friction = 0.6;
  constants.dynamic_friction = 0.4;
  const std::vector<ChannelField::Texel> white{{65535, 65535, 65535}};
  const ChannelField dynamic(1, 1, white, {{MapChannel{Quantity::dynamic_friction, 0.2, 0}}, {}, {}});
  EXPECT_DOUBLE_EQ(at(dynamic, {}, constants).dynamic_friction, 0.2);
  EXPECT_NEAR(at(dynamic, {}, constants).static_friction, 0.3, 1e-15);
  const ChannelField fixed(1, 1, white, {{MapChannel{Quantity::static_friction, 0.3, 0}}, {}, {}});
  EXPECT_NEAR(at(fixed, {}, constants).dynamic_friction, 0.2, 1e-15);
  EXPECT_DOUBLE_EQ(at(fixed, {}, constants).static_friction, 0.3);
  // From nothing there is no ratio: both are the map's.
  EXPECT_DOUBLE_EQ(at(dynamic, {}).static_friction, 0.2);
  // Two maps that disagree: dynamic is at most static.
  const ChannelField both(
      1, 1, white,
      {{MapChannel{Quantity::static_friction, 0.1, 0}, MapChannel{Quantity::dynamic_friction, 0.5, 0}}, {}, {}});
  EXPECT_DOUBLE_EQ(at(both, {}, constants).dynamic_friction, 0.1);
}

TEST(ChannelField, KnowsItsLargestValues) {
  const ChannelField field(3, 1, {{0, 0, 100}, {30000, 0, 0}, {10000, 0, 65535}}, three_channels());
  EXPECT_NEAR(field.most(Quantity::stiffness).value(), 200 + 600 * 30000 / 65535.0, 1e-9);
  EXPECT_NEAR(field.most(Quantity::damping).value(), 3, 1e-12);
  EXPECT_FALSE(field.most(Quantity::static_friction).has_value());
}

TEST(ChannelField, IsFiniteEverywhere) {
  const ChannelField field(4, 4, noise(16, 6), three_channels());
  for (const double u :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, -1e18}) {
    const ContactConstants found = at(field, {u, -u});
    EXPECT_TRUE(found.stiffness >= 200 && found.stiffness <= 800) << u;
  }
}

TEST(ChannelField, RefusesWhatIsNone) {
  const std::vector<ChannelField::Texel> four(4);
  EXPECT_THROW(ChannelField(0, 4, {}, three_channels()), InvalidInput);
  EXPECT_THROW(ChannelField(3, 2, four, three_channels()), InvalidInput);
  EXPECT_THROW(ChannelField(2, 2, four, {{MapChannel{Quantity::damping, -2, 1}}, {}, {}}), InvalidInput);
  EXPECT_THROW(ChannelField(2, 2, four, {{k_friction, k_friction}, {}, {}}), InvalidInput);
  ChannelFieldOptions odd = three_channels();
  odd.uv_transform.scale.x = std::numeric_limits<double>::infinity();
  EXPECT_THROW(ChannelField(2, 2, four, odd), InvalidInput);
}

TEST(Quantity, NamesAreReadAgain) {
  for (const Quantity known : k_quantities) EXPECT_EQ(quantity(name_of(known)), known);
  EXPECT_FALSE(quantity("friction").has_value());
}

}  // namespace
}  // namespace papilla
