// SPDX-License-Identifier: MIT
#include "papilla/texture/photograph_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/test_relief.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// Nothing but the light: linear, not rounded, never clipped.
PhotographOptions bare(Vec3 light) {
  PhotographOptions options;
  options.light = light;
  options.ambient = 0;
  options.cast_shadows = false;
  options.srgb = false;
  options.bits = 32;
  options.clipped = 0;
  options.mean_grey = 0.1;
  return options;
}

HeightMap level(int width, int height) {
  return test::make_relief(width, height, 0.1, [](int, int) { return 0.5; });
}

double mean_of(const GreyImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
}

double deviation_of(const GreyImage& image) {
  const double mean = mean_of(image);
  double squares = 0;
  for (const float value : image.pixels)
    squares += (static_cast<double>(value) - mean) * (static_cast<double>(value) - mean);
  return std::sqrt(squares / static_cast<double>(image.pixels.size()));
}

TEST(Photograph, WithoutLensAndShadowsIsLamberts) {
  const HeightMap relief = test_relief("pebbles");
  const Vec3 light{-0.3, 0.8, 0.9};
  const GreyImage expected = render_lambert(relief, light), found = photograph(relief, bare(light)).picture;
  const double scale = mean_of(found) / mean_of(expected);
  EXPECT_NEAR(mean_of(found), 0.1, 1e-6);
  for (std::size_t i = 0; i < found.pixels.size(); ++i)
    ASSERT_NEAR(found.pixels[i], scale * static_cast<double>(expected.pixels[i]), 1e-6) << i;
  EXPECT_DOUBLE_EQ(found.pitch_mm, relief.pitch_mm_x);
}

TEST(Photograph, AWallShadesTheGroundAsFarAsTheLightIsLow) {
  for (const double azimuth_deg : {0.0, 37.0, 180.0, 300.0}) {
    const double azimuth = azimuth_deg * k_radians_per_degree, elevation = 30 * k_radians_per_degree;
    const Vec2 to_light{std::cos(azimuth), std::sin(azimuth)};
    // A wall of 2 mm across the light, whose far side is level ground.
    HeightMap relief = test::make_relief(160, 120, 0.1, [&](int x, int y) {
      const double along = dot(Vec2{(x - 80) * 0.1, (y - 60) * 0.1}, to_light);
      return along > 0 && along < 1 ? 2.0 : 0.0;
    });
    relief.periodic = false;
    PhotographOptions options =
        bare({std::cos(elevation) * to_light.x, std::cos(elevation) * to_light.y, std::sin(elevation)});
    options.cast_shadows = true;
    const GreyImage picture = photograph(relief, options).picture;
    const double length_mm = 2 / std::tan(elevation);
    for (int i = 2; i < 50; ++i) {
      const double along_mm = 0.1 * i;
      const int x = static_cast<int>(std::lround(80 - 10 * along_mm * to_light.x)),
                y = static_cast<int>(std::lround(60 - 10 * along_mm * to_light.y));
      if (std::abs(along_mm - length_mm) < 0.15) continue;
      EXPECT_EQ(picture.at(x, y) > 0, along_mm > length_mm) << azimuth_deg << " " << along_mm;
    }
  }
}

TEST(Photograph, PeriodicReliefsShadeAroundTheBorders) {
  HeightMap relief = test::make_relief(40, 30, 1, [](int x, int) { return x == 0 ? 5.0 : 0.0; });
  PhotographOptions options = bare({1, 0, 1});
  options.cast_shadows = true;
  const GreyImage around = photograph(relief, options).picture;
  EXPECT_EQ(around.at(37, 10), 0);  // Three samples beyond the border stands a wall five high.
  EXPECT_GT(around.at(33, 10), 0);
  relief.periodic = false;
  EXPECT_GT(photograph(relief, options).picture.at(37, 10), 0);
}

TEST(Photograph, HighlightsAreWhereTheFacetMirrorsTheLight) {
  // Facets at every slope of a parabola; the halfway vector of light at 40 degrees is tilted by 25 degrees.
  HeightMap relief =
      test::make_relief(401, 64, 0.1, [](int x, int) { return -0.5 * 0.05 * (x - 200) * 0.1 * (x - 200) * 0.1; });
  relief.periodic = false;
  const double elevation = 40 * k_radians_per_degree;
  PhotographOptions matt = bare({std::cos(elevation), 0, std::sin(elevation)});
  PhotographOptions glossy = matt;
  glossy.specular = {0.7, 50};
  const GreyImage without = photograph(relief, matt).picture, with = photograph(relief, glossy).picture;
  const int far = 60;  // A facet far from the highlight undoes the exposures.
  const double ratio = static_cast<double>(without.at(far, 30)) / static_cast<double>(with.at(far, 30));
  int brightest = 0;
  double most = 0;
  for (int x = 1; x < 400; ++x) {
    const double gloss = ratio * static_cast<double>(with.at(x, 30)) - static_cast<double>(without.at(x, 30));
    if (gloss > most) most = gloss, brightest = x;
  }
  const double tilt = std::atan(0.05 * (brightest - 200) * 0.1) * k_degrees_per_radian;
  EXPECT_NEAR(tilt, 25, 0.3);
}

TEST(Photograph, BlursByAGaussian) {
  // A level surface that is lit on one side of a shadow's border only: the border becomes an error function.
  HeightMap relief = test::make_relief(128, 64, 0.1, [](int x, int) { return x < 20 ? 4.0 : 0.0; });
  relief.periodic = false;
  PhotographOptions options = bare({-1, 0, 1});
  options.cast_shadows = true;
  const GreyImage sharp = photograph(relief, options).picture;
  options.blur_px = 1.3;
  const GreyImage soft = photograph(relief, options).picture;
  int border = 40;
  while (sharp.at(border, 30) == 0) ++border;
  for (int x = border - 6; x < border + 6; ++x) {
    const double expected = 0.5 * std::erfc(-(x + 0.5 - border) / (1.3 * std::sqrt(2.0)));
    EXPECT_NEAR(soft.at(x, 30) / static_cast<double>(soft.at(100, 30)), expected, 0.02) << x;
  }
}

TEST(Photograph, OfALevelSurfaceIsTheExposureThroughTheCurve) {
  PhotographOptions options = bare({0.4, -0.2, 1});
  options.mean_grey = 0.2;
  options.srgb = true;
  EXPECT_NEAR(mean_of(photograph(level(80, 64), options).picture), srgb_from_linear(0.2), 1e-6);
  options.bits = 8;
  for (const float value : photograph(level(80, 64), options).picture.pixels)
    EXPECT_NEAR(255 * static_cast<double>(value), std::round(255 * srgb_from_linear(0.2)), 1e-4);
}

TEST(Photograph, NoiseVignetteAndUnevenLightHaveTheirSize) {
  PhotographOptions options = bare({0.4, -0.2, 1});
  options.noise = 0.02;
  EXPECT_NEAR(deviation_of(photograph(level(300, 200), options).picture), 0.02, 5e-4);
  options.noise = 0;
  options.vignette = 0.1;
  const GreyImage vignette = photograph(level(301, 201), options).picture;
  EXPECT_NEAR(vignette.at(0, 0) / static_cast<double>(vignette.at(150, 100)), 0.9, 1e-3);
  EXPECT_NEAR(vignette.at(0, 100) / static_cast<double>(vignette.at(150, 100)), 0.95, 1e-3);
  options.vignette = 0;
  options.uneven_light = 0.15;
  std::set<double> ratios;
  for (options.seed = 1; options.seed <= 5; ++options.seed) {
    const GreyImage uneven = photograph(level(200, 150), options).picture;
    const auto [low, high] = std::minmax_element(uneven.pixels.begin(), uneven.pixels.end());
    EXPECT_NEAR(*low / static_cast<double>(*high), 0.85 / 1.15, 0.01);
    ratios.insert(uneven.at(0, 0) / static_cast<double>(uneven.at(199, 0)));
  }
  EXPECT_EQ(ratios.size(), 5U);  // Another direction for every seed.
}

TEST(Photograph, AlbedoVariesFreeOfTheHeightAndWithIt) {
  PhotographOptions options = bare({0, 0, 1});
  options.albedo_noise = 0.08;
  const GreyImage spots = photograph(level(300, 200), options).picture;
  EXPECT_NEAR(deviation_of(spots) / mean_of(spots), 0.08, 0.002);
  PhotographOptions other = options;  // Another picture of the same surface has the same spots.
  other.light = {1, 0, 1};
  other.seed = 99;
  EXPECT_EQ(photograph(level(300, 200), other).picture.pixels, spots.pixels);
  other.surface_seed = 2;
  EXPECT_NE(photograph(level(300, 200), other).picture.pixels, spots.pixels);

  PhotographOptions dark = bare({0, 0, 1});
  dark.valley_darkening = 0.15;
  HeightMap steps = test::make_relief(90, 64, 1, [](int x, int) { return x < 30 ? 0.0 : x < 60 ? 0.5 : 1.0; });
  const GreyImage tied = photograph(steps, dark).picture;
  EXPECT_NEAR(tied.at(15, 9) / static_cast<double>(tied.at(75, 9)), 0.85, 1e-6);
  EXPECT_NEAR(tied.at(45, 9) / static_cast<double>(tied.at(75, 9)), 0.925, 1e-6);
}

TEST(Photograph, AmbientLightFillsShadows) {
  HeightMap relief = test::make_relief(128, 64, 0.1, [](int x, int) { return x < 20 ? 4.0 : 0.0; });
  relief.periodic = false;
  PhotographOptions options = bare({-1, 0, 1});
  options.cast_shadows = true;
  options.ambient = 0.2;
  const Photograph shot = photograph(relief, options);
  const double lit = 0.2 + 0.8 * std::sqrt(0.5);
  EXPECT_NEAR(shot.picture.at(30, 30) / static_cast<double>(shot.picture.at(100, 30)), 0.2 / lit, 1e-6);
  EXPECT_NEAR(shot.shadows_fraction, 40.0 / 128, 0.02);
}

TEST(Photograph, ConditionsHaveLightFrom25To55DegreesAndDependOnTheSeed) {
  std::set<double> azimuths;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const PhotographOptions options = photograph_options(PhotographCondition::spotted, seed);
    EXPECT_NEAR(norm(options.light), 1, 1e-12);
    EXPECT_GE(options.light.z, std::sin(25 * k_radians_per_degree) - 1e-12);
    EXPECT_LE(options.light.z, std::sin(55 * k_radians_per_degree) + 1e-12);
    azimuths.insert(std::atan2(options.light.y, options.light.x));
  }
  EXPECT_EQ(azimuths.size(), 40U);
  const auto spot = [](std::uint64_t seed, std::uint64_t surface_seed) {
    return photograph_options(PhotographCondition::spotted, seed, surface_seed).albedo_spot_px;
  };
  EXPECT_EQ(spot(1, 7), spot(2, 7)) << "one surface, whoever takes the photograph";
  EXPECT_EQ(photograph_options(PhotographCondition::spotted, 2, 7).surface_seed, 7U);
  EXPECT_NE(spot(1, 7), spot(1, 8));
  const HeightMap relief = test_relief("leather");
  const PhotographOptions glossy = photograph_options(PhotographCondition::glossy, 3);
  EXPECT_EQ(photograph(relief, glossy).picture.pixels, photograph(relief, glossy).picture.pixels);
  for (const float value : photograph(relief, glossy).picture.pixels) {
    const double bytes = 255 * static_cast<double>(value);
    ASSERT_NEAR(bytes, std::round(bytes), 1e-4);
  }
}

TEST(Photograph, RefusesBadOptions) {
  const auto with = [](auto change) {
    PhotographOptions options;
    change(options);
    return photograph(level(64, 64), options);
  };
  EXPECT_THROW(with([](auto& o) { o.light = {0, 1, -1}; }), InvalidInput);
  EXPECT_THROW(with([](auto& o) { o.ambient = 1; }), InvalidInput);
  EXPECT_THROW(with([](auto& o) { o.noise = std::numeric_limits<double>::quiet_NaN(); }), InvalidInput);
  EXPECT_THROW(with([](auto& o) { o.specular.shininess = 0; }), InvalidInput);
  EXPECT_THROW(with([](auto& o) { o.bits = 12; }), InvalidInput);
  HeightMap oblong = level(64, 64);
  oblong.pitch_mm_y = 0.2;
  EXPECT_THROW(photograph(oblong), InvalidInput);
}

}  // namespace
}  // namespace papilla
