// SPDX-License-Identifier: MIT
#include "papilla/haptic/height_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/haptic/roughness_field.hpp"

namespace papilla {
namespace {

std::vector<std::uint16_t> noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(width * height));
  for (auto& v : samples) v = static_cast<std::uint16_t>(20000 + random() % 20000);
  return samples;
}

HeightFieldOptions options(Interpolation interpolation) {
  HeightFieldOptions o;
  o.scale_m = 2e-4;
  o.offset_m = -1e-4;
  o.interpolation = interpolation;
  return o;
}

class Gradient : public ::testing::TestWithParam<Interpolation> {};

TEST_P(Gradient, EqualsFiniteDifferences) {
  HeightFieldOptions o = options(GetParam());
  o.uv_transform = {{0.13, -0.4}, 0.7, {1.7, 0.6}};
  o.wrap = {Wrap::repeat, Wrap::mirror};
  const HeightField field(17, 11, noise(17, 11, 3), o);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uv(-3, 3);
  const double e = 1e-7;
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec2 at{uv(random), uv(random)};
    const HeightSample s = field.sample(at);
    if (s.height_m <= field.min_m() || s.height_m >= field.max_m()) continue;
    const double du = (field.sample({at.x + e, at.y}).height_m - field.sample({at.x - e, at.y}).height_m) / (2 * e);
    const double dv = (field.sample({at.x, at.y + e}).height_m - field.sample({at.x, at.y - e}).height_m) / (2 * e);
    // A difference across the kink between two cells is not the slope of either.
    if (GetParam() == Interpolation::bilinear &&
        (std::abs(du - s.gradient_m.x) > 1e-6 || std::abs(dv - s.gradient_m.y) > 1e-6))
      continue;
    ++compared;
    EXPECT_NEAR(s.gradient_m.x, du, 1e-6);
    EXPECT_NEAR(s.gradient_m.y, dv, 1e-6);
  }
  EXPECT_GT(compared, 450);
}

TEST_P(Gradient, IsNowhereSteeperThanItIsSaidToBe) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const HeightField field(12, 16, noise(12, 16, seed), options(GetParam()));
    const Vec2 most = field.steepest_m();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uv(0, 1);
    Vec2 found;
    for (int i = 0; i < 20000; ++i) {
      const Vec2 slope = field.sample({uv(random), uv(random)}).gradient_m;
      found = {std::max(found.x, std::abs(slope.x) / 12), std::max(found.y, std::abs(slope.y) / 16)};
    }
    EXPECT_LE(found.x, most.x);
    EXPECT_LE(found.y, most.y);
    EXPECT_GT(found.x, 0.4 * most.x);
    EXPECT_GT(found.y, 0.4 * most.y);
  }
}

INSTANTIATE_TEST_SUITE_P(HeightField, Gradient, ::testing::Values(Interpolation::bilinear, Interpolation::bicubic));

TEST(HeightField, TexelCentresHaveTheSamplesHeight) {
  const auto samples = noise(7, 5, 1);
  for (const Interpolation interpolation : {Interpolation::bilinear, Interpolation::bicubic}) {
    const HeightField field(7, 5, samples, options(interpolation));
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x)
        EXPECT_NEAR(field.sample({(x + 0.5) / 7, (y + 0.5) / 5}).height_m,
                    -1e-4 + 2e-4 * samples[static_cast<std::size_t>(7 * y + x)] / 65535, 1e-15);
  }
}

TEST(HeightField, BicubicFollowsASineOf16SamplesWithinHalfAPercent) {
  std::vector<std::uint16_t> samples(64);
  for (int i = 0; i < 64; ++i)
    samples[static_cast<std::size_t>(i)] =
        static_cast<std::uint16_t>(std::lround(32767.5 + 32767 * std::sin(2 * std::numbers::pi * (i + 0.5) / 16)));
  const HeightField field(64, 1, samples, options(Interpolation::bicubic));
  for (double u = 0; u < 1; u += 1e-3)
    EXPECT_NEAR(field.sample({u, 0.5}).height_m, 1e-4 * std::sin(2 * std::numbers::pi * 4 * u), 5e-7);
}

TEST(HeightField, WrapModes) {
  HeightFieldOptions o = options(Interpolation::bilinear);
  const std::vector<std::uint16_t> ramp = {0, 20000, 40000, 60000};
  const auto at = [&](Wrap wrap, double u) {
    o.wrap = {wrap, wrap};
    return HeightField(4, 1, ramp, o).sample({u, 0.5}).height_m;
  };
  EXPECT_NEAR(at(Wrap::repeat, 1.125), at(Wrap::repeat, 0.125), 1e-15);
  EXPECT_NEAR(at(Wrap::repeat, -5.875), at(Wrap::repeat, 0.125), 1e-15);
  EXPECT_NEAR(at(Wrap::clamp, 1.6), at(Wrap::clamp, 0.875), 1e-15);
  EXPECT_NEAR(at(Wrap::mirror, 1.125), at(Wrap::mirror, 0.875), 1e-15);
  EXPECT_NEAR(at(Wrap::mirror, -0.125), at(Wrap::mirror, 0.125), 1e-15);
  o.wrap = {Wrap::repeat, Wrap::clamp};
  const HeightField down(1, 4, ramp, o);
  EXPECT_NEAR(down.sample({0.5, 1.6}).height_m, down.sample({0.5, 0.875}).height_m, 1e-15);
  o.wrap = {Wrap::clamp, Wrap::repeat};
  const HeightField round(1, 4, ramp, o);
  EXPECT_NEAR(round.sample({0.5, 1.6}).height_m, round.sample({0.5, 0.6}).height_m, 1e-15);
}

/// Rows that end do not know of those at the other end: neither slopes, nor the ball, nor rounding.
TEST(HeightField, ShapesEndAtTheBorderOfRowsOnly) {
  constexpr int n = 12;
  std::vector<std::uint16_t> samples(n * n, 20000);
  for (int x = 0; x < n; ++x) samples[static_cast<std::size_t>((n - 1) * n + x)] = 40000;
  HeightFieldOptions o = options(Interpolation::bilinear);
  const auto first_row = [&](const HeightField& field) { return field.sample({0.5, 0.5 / n}).height_m; };
  const Vec2 side{1.2e-3, 1.2e-3};
  const double low = -1e-4 + 2e-4 * 20000 / 65535, high = -1e-4 + 2e-4 * 40000 / 65535;
  o.wrap = {Wrap::repeat, Wrap::clamp};
  const HeightField ends(n, n, samples, o);
  EXPECT_NEAR(first_row(ends.dilated(2e-4, side)), low, 1e-8);
  o.wrap = {Wrap::clamp, Wrap::repeat};
  const HeightField repeats(n, n, samples, o);
  EXPECT_NEAR(first_row(repeats.dilated(2e-4, side)), high + std::sqrt(3.0) * 1e-4 - 2e-4, 1e-8);
  // A groove one row wide at the border, rounded: its other bank is there only where rows repeat, below the parabola
  // whose apex lies two rows further, (3² − 2²) p²/2R above the ground.
  for (auto& v : samples) v = static_cast<std::uint16_t>(60000 - v);
  o.wrap = {Wrap::repeat, Wrap::clamp};
  const double top = -1e-4 + 2e-4 * 40000 / 65535;
  EXPECT_NEAR(first_row(HeightField(n, n, samples, o).rounded(1e-3, side)), top, 1e-8);
  o.wrap = {Wrap::clamp, Wrap::repeat};
  const double bottom = -1e-4 + 2e-4 * 20000 / 65535;
  EXPECT_NEAR(first_row(HeightField(n, n, samples, o).rounded(1e-3, side)), bottom + 5 * 1e-4 * 1e-4 / 2e-3, 1e-8);
}

/// The largest slope of a cubic over one step up is 5/4 · 2 of it, see extremes(); that of level ground is none.
TEST(HeightField, SteepestSlopeOfAStepBetweenRowsAndOfLevelGround) {
  std::vector<std::uint16_t> samples(6 * 8, 30000);
  HeightFieldOptions o = options(Interpolation::bicubic);
  o.scale_m = 65535e-6;
  EXPECT_EQ(HeightField(6, 8, samples, o).steepest_m().x, 0);
  EXPECT_EQ(HeightField(6, 8, samples, o).steepest_m().y, 0);
  for (std::size_t i = 24; i < 48; ++i) samples[i] = 31000;
  const HeightField step(6, 8, samples, o);
  EXPECT_EQ(step.steepest_m().x, 0);
  EXPECT_NEAR(step.steepest_m().y, 2.5 * 1000e-6, 1e-12);
}

TEST(HeightField, BlackOutwardTurnsTheReliefOver) {
  HeightFieldOptions white = options(Interpolation::bilinear), black = white;
  black.white_is_outward = false;
  const HeightField a(2, 1, {0, 65535}, white), b(2, 1, {65535, 0}, black);
  for (double u = 0; u < 1; u += 0.05) EXPECT_NEAR(a.sample({u, 0}).height_m, b.sample({u, 0}).height_m, 1e-15);
}

// The example of KHR_texture_transform: the lower left quarter of the picture, rotated clockwise by a quarter turn.
TEST(HeightField, UvTransformIsTheExtensions) {
  HeightFieldOptions o = options(Interpolation::bilinear);
  o.uv_transform = {{0, 1}, std::numbers::pi / 2, {0.5, 0.5}};
  o.wrap = {Wrap::clamp, Wrap::clamp};
  const auto samples = noise(4, 6, 9);
  const HeightField turned(4, 6, samples, o);
  o.uv_transform = {};
  const HeightField plain(4, 6, samples, o);
  for (double u = 0; u <= 1; u += 0.25)
    for (double v = 0; v <= 1; v += 0.25)
      EXPECT_NEAR(turned.sample({u, v}).height_m, plain.sample({0.5 * v, 1 - 0.5 * u}).height_m, 1e-12);
}

TEST(HeightField, OddTextureCoordinatesGiveFiniteHeights) {
  const HeightField field(8, 8, noise(8, 8, 2), options(Interpolation::bicubic));
  for (const double odd : {std::nan(""), 1e300, -1e300, std::numeric_limits<double>::infinity()}) {
    const HeightSample s = field.sample({odd, 0.5});
    EXPECT_GE(s.height_m, field.min_m());
    EXPECT_LE(s.height_m, field.max_m());
    EXPECT_TRUE(is_finite(s.gradient_m));
  }
}

TEST(HeightField, RefusesWrongSizes) {
  EXPECT_THROW(HeightField(2, 2, {1, 2, 3}, {}), InvalidInput);
  EXPECT_THROW(HeightField(0, 2, {}, {}), InvalidInput);
  HeightFieldOptions o;
  o.scale_m = std::nan("");
  EXPECT_THROW(HeightField(1, 1, {1}, o), InvalidInput);
}

TEST(HeightField, DilationOfASpikeIsTheBall) {
  const int n = 41;
  std::vector<std::uint16_t> samples(n * n, 0);
  samples[static_cast<std::size_t>(20 * n + 20)] = 65535;
  HeightFieldOptions o;
  o.scale_m = 3e-4;
  o.interpolation = Interpolation::bilinear;
  const double side = 2e-3, r = 1e-3;
  const HeightField wide = HeightField(n, n, samples, o).dilated(r, {side, side});
  for (int i = 0; i < n; ++i) {
    const double d = (i - 20) * side / n;
    const double expected = std::max(0.0, std::abs(d) <= r ? 3e-4 + std::sqrt(r * r - d * d) - r : 0.0);
    EXPECT_NEAR(wide.sample({(i + 0.5) / n, 20.5 / n}).height_m, expected, 3e-4 / 65535);
  }
}

/// The ball is round on the surface, however the map is turned and stretched there.
TEST(HeightField, DilationOfASpikeIsTheBallUnderATurnedTransform) {
  constexpr int w = 30, h = 50;
  constexpr double r = 1e-3;
  std::vector<std::uint16_t> samples(w * h, 0);
  samples[25 * w + 15] = 65535;
  for (const Vec2 metres : {Vec2{2.5e-3, 5e-3}, Vec2{6e-3, 1.5e-3}}) {
    HeightFieldOptions o;
    o.scale_m = 3e-4;
    o.interpolation = Interpolation::bilinear;
    const UvTransform t{{0.3, 0.1}, 0.6, {0.8, 1.3}};
    o.uv_transform = t;
    o.wrap = {Wrap::clamp, Wrap::clamp};
    const HeightField wide = HeightField(w, h, samples, o).dilated(r, metres);
    const auto metres_of = [&](int x, int y) {
      const double u = (x + 0.5) / w - t.offset.x, v = (y + 0.5) / h - t.offset.y;
      const double c = std::cos(t.rotation), s = std::sin(t.rotation);
      return Vec2{(c * u - s * v) / t.scale.x * metres.x, (s * u + c * v) / t.scale.y * metres.y};
    };
    int touched = 0;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const Vec2 place = metres_of(x, y);
        const double d = norm(place - metres_of(15, 25));
        const double expected = d <= r ? std::max(0.0, 3e-4 + std::sqrt(r * r - d * d) - r) : 0;
        touched += expected > 0;
        EXPECT_NEAR(wide.sample({place.x / metres.x, place.y / metres.y}).height_m, expected, 2 * 3e-4 / 65535)
            << metres.x << ' ' << x << ' ' << y;
      }
    EXPECT_GT(touched, 40);
    EXPECT_LT(touched, w * h);
  }
}

TEST(HeightField, DilationOfAPlaneIsThePlaneAndNeverLowers) {
  const HeightField flat = HeightField(5, 5, std::vector<std::uint16_t>(25, 700), options(Interpolation::bilinear))
                               .dilated(1e-3, {0.01, 0.01});
  EXPECT_NEAR(flat.sample({0.3, 0.3}).height_m, -1e-4 + 2e-4 * 700 / 65535, 1e-12);
  const HeightField rough(16, 16, noise(16, 16, 4), options(Interpolation::bilinear));
  const HeightField wide = rough.dilated(5e-4, {0.005, 0.005});
  for (double u = 0; u < 1; u += 0.05) EXPECT_GE(wide.sample({u, u}).height_m, rough.sample({u, u}).height_m - 1e-8);
}

/// Parabolas of a sharper and of a blunter peak than asked for, beside a groove.
TEST(HeightField, RoundedPeaksHaveTheRadiusAndValleysStay) {
  constexpr int n = 256;
  constexpr double side = 8e-3, pitch = side / n, range = 4e-4, radius = 1e-3;
  const auto relief = [&](double x) {
    const auto peak = [&](double at, double r) { return range - (x - at) * (x - at) / (2 * r); };
    return std::clamp(std::max(peak(2e-3, 2e-4), peak(6e-3, 4e-3)), 0.0, range);
  };
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * relief((x + 0.5) * pitch) / range)));
  HeightFieldOptions o;
  o.scale_m = range;
  o.interpolation = Interpolation::bilinear;
  const HeightField sharp(n, n, samples, o), round = sharp.rounded(radius, {side, side});
  const auto at = [&](const HeightField& field, int x, int y) {
    return field.sample({(x + 0.5) / n, (y + 0.5) / n}).height_m;
  };
  const double step = range / 65535;
  for (int y = 0; y < n; y += 37)
    for (int x = 1; x + 1 < n; ++x) {
      EXPECT_LE(at(round, x, y), at(sharp, x, y) + step);
      const double bend = (at(round, x - 1, y) - 2 * at(round, x, y) + at(round, x + 1, y)) / (pitch * pitch);
      EXPECT_GE(bend, -1 / radius - 4 * step / (pitch * pitch)) << x;
      // The blunt peak and the level ground are as they were.
      if (x > 90) EXPECT_NEAR(at(round, x, y), at(sharp, x, y), step) << x;
    }
  // A parabola of the radius that hangs between the flanks of the sharp peak: it touches the corner at the foot.
  const double foot = std::sqrt(2 * 2e-4 * range);
  EXPECT_NEAR(at(round, 64, 9), foot * foot / (2 * radius), 2e-5);
}

/// Ridges along rows, of a map whose rows lie four times as close as its columns.
TEST(HeightField, RidgesAcrossAreRoundedWithThePitchOfRows) {
  constexpr int w = 16, h = 64;
  constexpr double pitch = 5e-5, radius = 1e-3;
  std::vector<std::uint16_t> samples(w * h, 0);
  for (int x = 0; x < w; ++x) samples[static_cast<std::size_t>(32 * w + x)] = 65535;
  HeightFieldOptions o;
  o.scale_m = 1e-5;
  o.interpolation = Interpolation::bilinear;
  const HeightField round = HeightField(w, h, samples, o).rounded(radius, {w * 4 * pitch, h * pitch});
  // A parabola of that radius over the ground beside the ridge, two rows apart.
  EXPECT_NEAR(round.sample({0.5, 32.5 / h}).height_m, pitch * pitch / (2 * radius), 1e-9);
}

/// Second derivatives between the samples, where Catmull and Rom's cubics overshoot beside the grooves that rounding
/// leaves.
TEST(HeightField, RoundedPeaksAreRoundBetweenTheSamples) {
  constexpr int n = 64;
  constexpr double side = 4e-3, radius = 1e-3, step = side / n / 16;
  const HeightField sharp(n, n, noise(n, n, 5), options(Interpolation::bicubic));
  const HeightField round = sharp.rounded(radius, {side, side});
  const auto sharpest = [&](const HeightField& field, Vec2 way) {
    double least = 0;
    for (double y = 0.3 * step; y < side; y += 0.031 * side)
      for (double x = 0; x < side; x += step) {
        const auto at = [&](double t) {
          return field.sample({(x + t * step * way.x) / side, (y + t * step * way.y) / side}).height_m;
        };
        least = std::min(least, (at(-1) - 2 * at(0) + at(1)) / (step * step));
      }
    return least;
  };
  for (const Vec2 way : {Vec2{1, 0}, Vec2{0, 1}}) EXPECT_GT(sharpest(round, way), -1.02 / radius);
  EXPECT_LT(sharpest(sharp, {1, 0}), -10 / radius);
}

/// A cubic B-spline repeats straight lines, and has the values 1/6, 2/3, 1/6 and the slopes ±1/2 of a single sample.
TEST(HeightField, BSplineValuesAndBounds) {
  constexpr int n = 16;
  std::vector<std::uint16_t> samples(n * n, 0);
  samples[5 * n + 7] = 36000;
  HeightFieldOptions o;
  o.scale_m = 65535e-9;
  o.interpolation = Interpolation::bspline;
  const HeightField one(n, n, samples, o);
  const auto at = [&](double x, double y) { return one.sample({(x + 0.5) / n, (y + 0.5) / n}); };
  EXPECT_NEAR(at(7, 5).height_m, 36e-6 * 4 / 9, 1e-15);
  EXPECT_NEAR(at(8, 5).height_m, 36e-6 / 9, 1e-15);
  EXPECT_NEAR(at(8, 6).height_m, 1e-6, 1e-15);
  EXPECT_NEAR(at(8, 5).gradient_m.x, -36e-6 * n / 3, 1e-12);
  EXPECT_NEAR(at(7, 5).gradient_m.x, 0, 1e-12);
  EXPECT_EQ(at(9, 5).height_m, 0);
  EXPECT_NEAR(one.steepest_m().x, 36e-6, 1e-15);
  EXPECT_NEAR(one.max_m(), 36e-6, 1e-15);
  for (int i = 0; i < n * n; ++i) samples[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(1000 * (i % n));
  const HeightField line(n, n, samples, o);
  for (double x = 1; x < 14; x += 0.17) EXPECT_NEAR(line.sample({(x + 0.5) / n, 0.4}).height_m, 1e-6 * x, 1e-14);
}

TEST(HeightField, RoundingIsIdempotentAndPeriodic) {
  const HeightField rough(64, 64, noise(64, 64, 4), options(Interpolation::bilinear));
  const HeightField once = rough.rounded(1e-3, {0.005, 0.005}), twice = once.rounded(1e-3, {0.005, 0.005});
  for (double u = 0.003; u < 1; u += 0.07)
    for (double v = 0.005; v < 1; v += 0.09) {
      EXPECT_NEAR(twice.sample({u, v}).height_m, once.sample({u, v}).height_m, 2e-4 / 65535 * 3);
      EXPECT_NEAR(once.sample({u + 1, v}).height_m, once.sample({u, v}).height_m, 1e-15);
      EXPECT_LE(once.sample({u, v}).height_m, rough.sample({u, v}).height_m + 2e-4 / 65535);
    }
  EXPECT_THROW(rough.rounded(-1, {1, 1}), InvalidInput);
  EXPECT_THROW(rough.rounded(1e-3, {0, 1}), InvalidInput);
}

/// A saw: three texels up, one down.
TEST(HeightField, ShareSteeperThanASlope) {
  std::vector<std::uint16_t> samples;
  for (int i = 0; i < 64 * 64; ++i) samples.push_back(static_cast<std::uint16_t>(i % 4 * 20000));
  HeightFieldOptions o;
  o.scale_m = 65535e-8;  // A step of 20000 is 0.2 mm.
  const HeightField saw(64, 64, samples, o);
  const Vec2 side{0.064, 0.064};  // A texel is 1 mm: slopes of 0.2 and 0.6.
  EXPECT_EQ(saw.share_steeper(0.7, side), 0);
  EXPECT_EQ(saw.share_steeper(0.6, side), 0);
  EXPECT_EQ(saw.share_steeper(0.5, side), 0.25);
  EXPECT_EQ(saw.share_steeper(0.1, side), 1);
  EXPECT_EQ(saw.share_steeper(0.5, {0.0064, 1}), 1);
  // The same saw down the columns of an oblong map, whose texels are 1 mm high and 4 mm wide.
  samples.clear();
  for (int i = 0; i < 16 * 64; ++i) samples.push_back(static_cast<std::uint16_t>(i / 16 % 4 * 20000));
  const HeightField down(16, 64, samples, o);
  EXPECT_EQ(down.share_steeper(0.7, side), 0);
  EXPECT_EQ(down.share_steeper(0.5, side), 0.25);
  EXPECT_EQ(down.share_steeper(0.1, side), 1);
}

}  // namespace
}  // namespace papilla
