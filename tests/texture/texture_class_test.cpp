// SPDX-License-Identifier: MIT
#include "papilla/texture/texture_class.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "papilla/texture/symmetry.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

const PlanStep& step(const AnalysisPlan& plan, const std::string& name) {
  const auto found = std::find_if(plan.begin(), plan.end(), [&](const PlanStep& s) { return s.step == name; });
  if (found == plan.end()) throw std::out_of_range(name);
  return *found;
}

struct Classified {
  TextureClass texture_class;
  Suitability suitability;
  AnalysisPlan plan;
};

Classified classified(const GreyImage& image) {
  const SymmetryAnalysis analysis = analyze_symmetry(image);
  Classified result{classify(image, analysis.explained_variance()), measure_suitability(image, analysis.lattice), {}};
  result.plan = plan_analysis(result.texture_class, result.suitability);
  const TextureClass& c = result.texture_class;
  EXPECT_NEAR(c.disordered + c.weakly_ordered + c.strongly_ordered, 1, 1e-12);
  return result;
}

TEST(TextureClass, RegularGrainIsStronglyOrdered) {
  const Classified spheres = classified(synthesize_grain(GrainKind::spheres8, {192}).picture);
  EXPECT_EQ(spheres.texture_class.kind, TextureKind::strongly_ordered_symmetric);
  EXPECT_TRUE(spheres.suitability.symmetric);
  EXPECT_TRUE(spheres.suitability.homogeneous);
  EXPECT_TRUE(step(spheres.plan, "shape_from_shading").run);
  EXPECT_FALSE(step(spheres.plan, "fractal_dimension").run);
  for (const PlanStep& s : spheres.plan) EXPECT_FALSE(s.reason.empty()) << s.step;
}

TEST(TextureClass, FractalSurfaceIsDisordered) {
  const Classified rough = classified(to_grey_image(brownian_surface_exact({129, 0.4, 3}), 8));
  EXPECT_EQ(rough.texture_class.kind, TextureKind::disordered);
  EXPECT_FALSE(rough.suitability.symmetric);
  EXPECT_TRUE(step(rough.plan, "fractal_dimension").run);
  EXPECT_TRUE(step(rough.plan, "intensity_as_height").run);
  EXPECT_FALSE(step(rough.plan, "shape_from_shading").run);
}

TEST(TextureClass, BrushedPictureIsWeaklyOrdered) {
  const GreyImage noise = test::noise_image(128, 1, 3);
  const Classified brushed = classified(test::make_image(128, 128, [&](int x, int y) {
    return static_cast<double>(noise.at(x, 0)) + 0.02 * std::sin(x * 12.9898 + y * 78.233);
  }));
  EXPECT_EQ(brushed.texture_class.kind, TextureKind::weakly_ordered);
  EXPECT_TRUE(brushed.suitability.directional);
}

TEST(TextureClass, StripesAreOrderedWithoutSymmetry) {
  const GreyImage image =
      test::make_image(128, 128, [](int x, int y) { return 0.5 + 0.4 * std::sin(0.5 * x + 0.2 * y); });
  const SymmetryAnalysis analysis = analyze_symmetry(image);
  EXPECT_GT(analysis.lattice.stripes, 0.8);
  const TextureClass found = classify(image, analysis.explained_variance(), analysis.lattice.stripes);
  EXPECT_EQ(found.kind, TextureKind::strongly_ordered_nonsymmetric);
}

TEST(TextureClass, OrientationFieldFollowsTheStructure) {
  // Circles about the middle of the left border: along them the angle is that of the radius plus 90°.
  const GreyImage image =
      test::make_image(256, 256, [](int x, int y) { return 0.5 + 0.4 * std::sin(0.9 * std::hypot(x, y - 128)); });
  const OrientationField field = orientation_field(image);
  ASSERT_EQ(field.columns, 8);
  ASSERT_EQ(field.rows, 8);
  for (int row = 0; row < 8; ++row) {
    const double radius = std::atan2(row * 32 + 15.5 - 128, 7 * 32 + 15.5) * 180 / 3.141592653589793;
    EXPECT_LT(std::abs(std::remainder(field.angle_deg[static_cast<std::size_t>(8 * row + 7)] - radius - 90, 180)), 3);
  }
  EXPECT_GT(field.mean_coherence, 0.8);
  EXPECT_GT(field.spread, 0.2);
}

TEST(TextureClass, FlatPictureNeedsNothing) {
  const Classified flat = classified(test::make_image(40, 40, [](int, int) { return 0.5; }));
  EXPECT_TRUE(flat.suitability.flat);
  for (const PlanStep& s : flat.plan) EXPECT_FALSE(s.run) << s.step;
}

TEST(TextureClass, MonochromeMeansOneHue) {
  ColorImage image{16, 16, {}};
  for (int i = 0; i < 256; ++i)  // Shades of brown.
    for (const double channel : {0.6, 0.4, 0.2}) image.pixels.push_back(static_cast<unsigned char>(i * channel));
  EXPECT_TRUE(is_monochrome(image));
  for (std::size_t i = 0; i < image.pixels.size(); i += 5)
    image.pixels[i] = static_cast<unsigned char>(255 - image.pixels[i]);
  EXPECT_FALSE(is_monochrome(image));
  EXPECT_THROW(is_monochrome(ColorImage{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
