// SPDX-License-Identifier: MIT
#include "papilla/texture/even_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

const TransferCurve k_srgb = transfer_curve(Transfer::srgb, 8);

GreyImage read_all(const SampleRows& samples) {
  GreyImage image = test::make_image(samples.width(), samples.height(), [](int, int) { return 0; });
  for (int y = 0; y < image.height; ++y) samples.read(0, y, image.width, &image.at(0, y));
  return image;
}

TEST(EvenLight, DividesAQuadricOfTheLogarithmOut) {
  const GreyImage image = test::make_image(150, 90, [](int x, int y) {
    const double u = (2 * x + 1) / 150.0 - 1, v = (2 * y + 1) / 90.0 - 1;
    return srgb_from_linear(0.3 * std::exp(0.2 * u - 0.1 * v - 0.15 * u * u + 0.05 * u * v - 0.1 * v * v));
  });
  const SamplesInMemory samples(image.pixels, 150, 90);
  const LightField field = light_field(samples, k_srgb);
  EXPECT_NEAR(field.quadric[0], std::log(0.3), 1e-3);
  EXPECT_NEAR(field.quadric[1], 0.2, 1e-3);
  EXPECT_NEAR(field.quadric[5], -0.1, 1e-3);
  EXPECT_GT(field.unevenness, 0.4);
  for (const float value : read_all(EvenedSamples(samples, k_srgb, field)).pixels) ASSERT_NEAR(value, 1, 1e-3);
}

TEST(EvenLight, DecodesSrgbWithinAMillionth) {
  const GreyImage image = test::make_image(1000, 1, [](int x, int) { return x / 999.0; });
  const SamplesInMemory samples(image.pixels, 1000, 1);
  const GreyImage decoded = read_all(EvenedSamples(samples, k_srgb, {}));
  for (int x = 0; x < 1000; ++x) ASSERT_NEAR(decoded.at(x, 0), linear_from_srgb(x / 999.0), 1e-6) << x;
  EXPECT_EQ(read_all(EvenedSamples(samples, {}, {})).pixels, image.pixels);
}

TEST(EvenLight, PartsOfARowAreThoseOfTheRow) {
  const GreyImage image = test::noise_image(70, 40, 2);
  const SamplesInMemory samples(image.pixels, 70, 40);
  const EvenedSamples evened(samples, k_srgb, light_field(samples, k_srgb));
  const GreyImage whole = read_all(evened);
  std::vector<float> part(20);
  evened.read(33, 17, 20, part.data());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(part[static_cast<std::size_t>(i)], whole.at(33 + i, 17));
}

TEST(EvenLight, BlackFlatAndTinyPicturesStayFinite) {
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{1, 9}, std::pair{7, 2}, std::pair{40, 30}})
    for (const double grey : {0.0, 0.4}) {
      const GreyImage image = test::make_image(w, h, [=](int, int) { return grey; });
      const SamplesInMemory samples(image.pixels, w, h);
      for (const float value : read_all(EvenedSamples(samples, k_srgb, light_field(samples, k_srgb))).pixels)
        EXPECT_NEAR(value, grey > 0 ? 1 : 0, 1e-5);
    }
}

TEST(EvenLight, EightBitsAreDecodedUnlessToldOtherwise) {
  const auto source = [](Transfer transfer, int bits) { return transfer_curve(transfer, bits).source; };
  EXPECT_EQ(source(Transfer::automatic, 8), CurveSource::srgb);
  EXPECT_EQ(source(Transfer::automatic, 16), CurveSource::linear);
  EXPECT_EQ(source(Transfer::automatic, 32), CurveSource::linear);
  EXPECT_EQ(source(Transfer::srgb, 16), CurveSource::srgb);
  EXPECT_EQ(source(Transfer::linear, 8), CurveSource::linear);
}

TEST(EvenLight, TheCurveOfAProfileIsTakenUnlessToldOtherwise) {
  const std::vector<float> square{0, 0.0625F, 0.25F, 0.5625F, 1};
  EXPECT_EQ(transfer_curve(Transfer::automatic, 8, square).source, CurveSource::profile);
  EXPECT_EQ(transfer_curve(Transfer::automatic, 16, square).linear, square);
  EXPECT_EQ(transfer_curve(Transfer::srgb, 16, square).source, CurveSource::srgb);
  EXPECT_EQ(transfer_curve(Transfer::linear, 8, square).source, CurveSource::linear);
  const GreyImage image = test::make_image(9, 1, [](int x, int) { return x / 8.0; });
  const SamplesInMemory samples(image.pixels, 9, 1);
  const GreyImage decoded = read_all(EvenedSamples(samples, transfer_curve(Transfer::automatic, 8, square), {}));
  for (int x = 0; x < 9; x += 2) EXPECT_FLOAT_EQ(decoded.at(x, 0), static_cast<float>(x * x) / 64) << x;
  EXPECT_FLOAT_EQ(decoded.at(7, 0), (0.5625F + 1) / 2);  // Straight between the steps.
}

TEST(EvenLight, TransfersHaveTheirNames) {
  for (const Transfer t : {Transfer::automatic, Transfer::srgb, Transfer::linear}) EXPECT_EQ(transfer(to_string(t)), t);
  EXPECT_THROW(transfer("gamma"), InvalidInput);
}

}  // namespace
}  // namespace papilla
