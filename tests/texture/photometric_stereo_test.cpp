// SPDX-License-Identifier: MIT
#include "papilla/texture/photometric_stereo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/photograph_model.hpp"
#include "papilla/texture/registration.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/test_relief.hpp"
#include "random.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

struct Scene {
  HeightMap truth;
  std::vector<GreyImage> photographs;  ///< Linear.
  std::vector<Vec3> lights;
};

/// Lights of the elevations asked for, azimuths spread around.
std::vector<Vec3> ring_of_lights(std::size_t count, std::uint64_t seed) {
  texture_detail::Random random(seed);
  const double first = 2 * std::numbers::pi * random.uniform();
  std::vector<Vec3> lights;
  for (std::size_t k = 0; k < count; ++k) {
    const double turn =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.6 * (random.uniform() - 0.5)) / static_cast<double>(count);
    const double elevation = (25 + 30 * random.uniform()) * k_radians_per_degree;
    lights.push_back({std::cos(first + turn) * std::cos(elevation), std::sin(first + turn) * std::cos(elevation),
                      std::sin(elevation)});
  }
  return lights;
}

/// Photographs of the second condition.
Scene photographed(std::string_view name, std::uint64_t seed) {
  TestReliefOptions relief;
  relief.seed = seed;
  Scene scene{test_relief(name, relief), {}, ring_of_lights(4, seed)};
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    PhotographOptions options = photograph_options(PhotographCondition::spotted, 100 * seed + k, seed);
    options.light = scene.lights[k];
    scene.photographs.push_back(photograph(scene.truth, options).picture);
    for (float& value : scene.photographs.back().pixels)
      value = static_cast<float>(linear_from_srgb(static_cast<double>(value)));
  }
  return scene;
}

/// Nothing but shading, in float.
Scene shaded(double height_px) {
  Scene scene{
      test::make_relief(96, 72, 1,
                        [&](int x, int y) { return height_px * std::sin(0.21 * x + 0.1 * y) * std::cos(0.17 * y); }),
      {},
      {{0.6, 0.1, 0.8}, {-0.5, 0.4, 0.8}, {-0.1, -0.7, 0.7}, {0.3, 0.6, 0.7}}};
  scene.truth.periodic = false;
  for (const Vec3 light : scene.lights) scene.photographs.push_back(render_lambert(scene.truth, light));
  return scene;
}

double share_of(const std::vector<double>& found, const Scene& scene) {
  return relief_error(found, scene.truth).correlation;
}

TEST(PhotometricStereo, FindsShadedReliefInSize) {
  const Scene scene = shaded(1.5);
  const PhotometricStereoResult found = photometric_stereo(scene.photographs, {scene.lights, {}});
  EXPECT_GT(share_of(found.height_px, scene), 0.99);
  const ReliefError error = relief_error(found.height_px, scene.truth);
  EXPECT_NEAR(error.mean, error.scaled_mean, 0.02) << "the size of the heights is known, not their shape alone";
  EXPECT_EQ(found.stop, StopReason::direct);
  EXPECT_FALSE(found.two_sided);
  EXPECT_GT(std::accumulate(found.confidence.begin(), found.confidence.end(), 0.0),
            0.9 * static_cast<double>(found.confidence.size()));
}

TEST(PhotometricStereo, AlbedoDoesNotMatter) {
  Scene scene = shaded(1.5);
  for (GreyImage& photograph : scene.photographs)
    for (int y = 0; y < photograph.height; ++y)
      for (int x = 0; x < photograph.width; ++x) photograph.at(x, y) *= (x / 8 + y / 8) % 2 == 0 ? 0.3F : 0.9F;
  EXPECT_GT(share_of(photometric_stereo(scene.photographs, {scene.lights, {}}).height_px, scene), 0.98);
}

TEST(PhotometricStereo, UnknownLightsAreFoundUpToTheirSide) {
  const Scene scene = shaded(1.5);
  const PhotometricStereoResult found = photometric_stereo(scene.photographs);
  EXPECT_TRUE(found.lights_estimated);
  EXPECT_GT(std::abs(share_of(found.height_px, scene)), 0.97);
  EXPECT_FALSE(found.trace.empty());
  double side = 0;
  for (std::size_t k = 0; k < 4; ++k)
    side += found.lights[k].x * scene.lights[k].x + found.lights[k].y * scene.lights[k].y;
  EXPECT_EQ(side > 0, share_of(found.height_px, scene) > 0) << "inverted light, inverted relief";
}

TEST(PhotometricStereo, PhotographsOfTheModel) {
  for (const std::string_view name : {"weave", "pebbles", "fractal"}) {
    const Scene scene = photographed(name, 71);
    EXPECT_GT(share_of(photometric_stereo(scene.photographs, {scene.lights, {}}).height_px, scene), 0.97) << name;
    EXPECT_GT(std::abs(share_of(photometric_stereo(scene.photographs).height_px, scene)), 0.7) << name;
  }
}

/// A relief that repeats under lights that are uneven by ±15 %, exposed anew for every photograph.
TEST(PhotometricStereo, UnevenLightIsNotTakenForABowl) {
  Scene scene{test_relief("quads", {.width = 150, .height = 110, .seed = 5}), {}, ring_of_lights(4, 9)};
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    PhotographOptions options;
    options.light = scene.lights[k];
    options.ambient = 0.2;
    options.uneven_light = 0.15;
    options.seed = 50 + k;
    options.srgb = false, options.bits = 32;
    scene.photographs.push_back(photograph(scene.truth, options).picture);
  }
  const PhotometricStereoResult four = photometric_stereo(scene.photographs, {scene.lights, {}});
  EXPECT_GT(share_of(four.height_px, scene), 0.99);
  EXPECT_NEAR(four.ambient, 0.2 / 0.8, 0.03);
  const ReliefError error = relief_error(four.height_px, scene.truth);
  EXPECT_NEAR(error.mean, error.scaled_mean, 0.01) << "the depth is right";
  scene.photographs.pop_back(), scene.lights.pop_back();
  const PhotometricStereoResult three = photometric_stereo(scene.photographs, {scene.lights, {}});
  EXPECT_GT(share_of(three.height_px, scene), 0.85);
  EXPECT_EQ(three.ambient, 0) << "three photographs can't tell";
}

TEST(PhotometricStereo, IsFiniteOnLevelGroundAndNoise) {
  const GreyImage flat = test::make_image(40, 30, [](int, int) { return 0.5; });
  const std::vector<Vec3> lights = ring_of_lights(3, 1);
  for (const double height : photometric_stereo({flat, flat, flat}, {lights, {}}).height_px)
    ASSERT_NEAR(height, 0, 1e-6);
  std::vector<GreyImage> noise;
  for (unsigned seed = 1; seed <= 4; ++seed) noise.push_back(test::noise_image(40, 30, seed));
  for (const PhotometricStereoResult& found : {photometric_stereo(noise), photometric_stereo({flat, flat, flat})})
    for (const double height : found.height_px) ASSERT_TRUE(std::isfinite(height));
}

TEST(PhotometricStereo, RefusesWhatItCannotSolve) {
  const Scene scene = shaded(1);
  const auto refused = [&](std::vector<GreyImage> photographs, std::vector<Vec3> lights, const char* reason) {
    try {
      photometric_stereo(photographs, {std::move(lights), {}});
      FAIL() << reason;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refused({scene.photographs[0], scene.photographs[1]}, {}, "at least 3");
  refused(scene.photographs, {scene.lights[0]}, "1 lights for 4");
  refused(scene.photographs, {{1, 0, 1}, {-1, 0, 1}, {0.5, 0, 1}, {0, 0, 1}}, "one plane");
  refused(scene.photographs, {{1, 0, 1}, {-1, 0, 1}, {0.5, 0, 1}, {0, 1, -1}}, "from the front");
  std::vector<GreyImage> other = scene.photographs;
  other[2] = test::make_image(50, 50, [](int, int) { return 0.5; });
  refused(other, scene.lights, "[2] is 50 x 50");
  other = scene.photographs;
  other[1].pixels[5] = std::numeric_limits<float>::quiet_NaN();
  refused(other, scene.lights, "finite");
}

}  // namespace
}  // namespace papilla
