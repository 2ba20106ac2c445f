// SPDX-License-Identifier: MIT
#include "papilla/meshing/triangle_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

TEST(TriangleBudget, AllPartsHoldTheSmallestCommonToleranceThatMeetsIt) {
  const TriangleMesh a = test::uv_sphere(10, 45, 45), b = test::uv_sphere(20, 45, 45),
                     plane = test::plane(30, 20, 30, 20);
  const std::vector<BudgetPart> parts{{&a, 1, 1}, {&b, 1, 3}, {&plane, 1, 1}};
  const BudgetResult r = simplify_to_budget(parts, 2400);
  EXPECT_TRUE(r.reached);
  EXPECT_LE(r.triangles, 2400U);
  EXPECT_GE(r.triangles, 2000U);
  EXPECT_EQ(r.triangles,
            r.parts[0].mesh.triangles.size() + 3 * r.parts[1].mesh.triangles.size() + r.parts[2].mesh.triangles.size());
  EXPECT_EQ(r.parts[2].mesh.triangles.size(), 2U) << "flat faces cost nothing, so they go first";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(surface_deviation(*parts[i].mesh, r.parts[i].mesh).value(), r.tolerance_mm);
    EXPECT_GT(r.parts[i].deviation.value(), 0.5 * r.tolerance_mm) << "no part is much better than the others";
  }
  // A tolerance a third smaller needs more than the budget.
  SimplifyOptions smaller;
  smaller.tolerance_mm = r.tolerance_mm / 1.5;
  EXPECT_GT(simplify(a, smaller).mesh.triangles.size() + 3 * simplify(b, smaller).mesh.triangles.size() + 2, 2400U);
  ASSERT_GE(r.trace.size(), 2U);
  EXPECT_GT(r.trace.front().error, 1);
}

TEST(TriangleBudget, ImportanceDividesTheTolerance) {
  const TriangleMesh a = test::uv_sphere(10, 40, 40), b = a;
  const std::vector<BudgetPart> parts{{&a, 10, 1}, {&b, 1, 1}};
  const BudgetResult r = simplify_to_budget(parts, 1500);
  EXPECT_TRUE(r.reached);
  EXPECT_GT(r.parts[0].mesh.triangles.size(), 2 * r.parts[1].mesh.triangles.size());
  EXPECT_LE(r.parts[0].deviation.bound(), r.tolerance_mm / 10);
  EXPECT_LE(r.parts[1].deviation.bound(), r.tolerance_mm);
}

TEST(TriangleBudget, LeavesAloneWhatFitsAndSaysWhatCannot) {
  const TriangleMesh cube = test::cube(10);
  const std::vector<BudgetPart> parts{{&cube}};
  const BudgetResult fits = simplify_to_budget(parts, 12);
  EXPECT_TRUE(fits.reached);
  EXPECT_EQ(fits.parts[0].mesh.triangles.size(), 12U);
  EXPECT_EQ(fits.tolerance_mm, 0);
  const BudgetResult cannot = simplify_to_budget(parts, 5);
  EXPECT_FALSE(cannot.reached);
  EXPECT_EQ(cannot.triangles, 12U);
}

TEST(TriangleBudget, OutOfReachItEndsWhereMoreDeviationSavesNothing) {
  // The border stays, so 2 · 120 - 2 triangles must; the ripples of 0.05 mm are gone long before 100 mm are used up.
  TriangleMesh sheet = test::plane(100, 100, 60, 60);
  for (Vec3& p : sheet.positions) p.z = 0.05 * std::sin(p.x) * std::sin(1.3 * p.y);
  SimplifyOptions options;
  options.lock_border = true;
  const BudgetResult r = simplify_to_budget(std::vector<BudgetPart>{{&sheet}}, 10, options);
  EXPECT_FALSE(r.reached);
  EXPECT_GE(r.triangles, 238U);
  EXPECT_LE(r.triangles, 260U);
  EXPECT_GT(r.tolerance_mm, 0.01);
  EXPECT_LT(r.tolerance_mm, 0.5);
  EXPECT_LE(r.parts[0].deviation.bound(), r.tolerance_mm);
}

TEST(TriangleBudget, PartsThatAreNotDrawnCountForNothing) {
  const TriangleMesh a = test::uv_sphere(10, 40, 40);
  const std::vector<BudgetPart> parts{{&a, 1, 0}};
  EXPECT_EQ(simplify_to_budget(parts, 1).triangles, 0U);
  EXPECT_TRUE(simplify_to_budget({}, 1).reached);
}

TEST(TriangleBudget, RefusesBadInput) {
  const TriangleMesh cube = test::cube(10);
  EXPECT_THROW(simplify_to_budget(std::vector<BudgetPart>{{nullptr}}, 5), InvalidInput);
  EXPECT_THROW(simplify_to_budget(std::vector<BudgetPart>{{&cube, 0}}, 5), InvalidInput);
  EXPECT_THROW(simplify_to_budget(std::vector<BudgetPart>{{&cube}}, 0), InvalidInput);
}

TEST(TriangleBudget, EndsAtTheDeadlineWithWhatIsMeasured) {
  const TriangleMesh a = test::uv_sphere(10, 45, 60), b = test::uv_sphere(20, 45, 60);
  const std::vector<BudgetPart> parts{{&a, 1, 1}, {&b, 1, 3}};
  for (const double seconds : {-1.0, 0.1, 0.3, 0.6, 1.2}) {
    SCOPED_TRACE(seconds);
    SimplifyOptions options;
    options.deadline = Deadline(seconds);
    const BudgetResult r = simplify_to_budget(parts, 2400, options);
    EXPECT_EQ(r.reached, r.triangles <= 2400);
    for (std::size_t i = 0; i < parts.size(); ++i)
      EXPECT_LE(surface_deviation(*parts[i].mesh, r.parts[i].mesh).value(), r.parts[i].deviation.bound() + 1e-9);
    if (seconds > 0) continue;
    EXPECT_FALSE(r.reached);
    EXPECT_EQ(r.stop, StopReason::time_limit);
    EXPECT_EQ(r.parts[0].stop, StopReason::time_limit);
    EXPECT_EQ(r.triangles, a.triangles.size() + 3 * b.triangles.size());
  }
}

TEST(TriangleBudget, ProgressGoesOnWithinOneTrialAndCancels) {
  const TriangleMesh a = test::uv_sphere(10, 45, 60);
  const std::vector<BudgetPart> parts{{&a}};
  std::vector<double> told;
  SimplifyOptions options;
  options.progress = [&](const Progress& done) { return told.push_back(done.fraction), true; };
  simplify_to_budget(parts, 1000, options);
  EXPECT_GT(told.size(), 40U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  options.progress = [](const Progress&) { return false; };
  EXPECT_THROW(simplify_to_budget(parts, 1000, options), Cancelled);
}

}  // namespace
}  // namespace papilla
