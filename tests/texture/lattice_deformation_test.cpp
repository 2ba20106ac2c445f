// SPDX-License-Identifier: MIT
#include "papilla/texture/lattice_deformation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "texture/bent_pattern.hpp"

namespace papilla {
namespace {

using test::k_a, test::k_b, test::bend;

GreyImage picture(double amount) { return test::bent_pattern(amount); }

TEST(LatticeDeformation, FindsAKnownDisplacement) {
  const LatticeDeformation found = find_lattice_deformation(picture(1), {k_a, k_b});
  ASSERT_TRUE(found.significant);
  EXPECT_GT(found.explained_after, 0.97);
  EXPECT_GT(found.explained_after, found.explained_before + 0.05);
  EXPECT_LT(norm(found.vectors_px[0] - k_a), 0.15);
  EXPECT_LT(norm(found.vectors_px[1] - k_b), 0.15);
  // Known but for a shift of the whole lattice.
  Vec2 shift{};
  int count = 0;
  for (int y = 10; y < 140; y += 10)
    for (int x = 10; x < 200; x += 10, ++count)
      shift = shift + found.displacement.at({static_cast<double>(x), static_cast<double>(y)}) - bend(x, y);
  shift = (1.0 / count) * shift;
  double squares = 0;
  for (int y = 10; y < 140; y += 10)
    for (int x = 10; x < 200; x += 10) {
      const Vec2 rest = found.displacement.at({static_cast<double>(x), static_cast<double>(y)}) - bend(x, y) - shift;
      squares += dot(rest, rest);
    }
  EXPECT_LT(std::sqrt(squares / count), 0.35);
  EXPECT_GT(found.max_percent_of_cell, found.rms_percent_of_cell);
  EXPECT_FALSE(found.trace.empty());
}

TEST(LatticeDeformation, NoneInAnExactLattice) {
  const LatticeDeformation found = find_lattice_deformation(picture(0), {k_a, k_b});
  EXPECT_FALSE(found.significant);
  EXPECT_GT(found.explained_before, 0.97);
}

TEST(LatticeDeformation, StraighteningUndoesTheDisplacement) {
  const GreyImage bent = picture(1);
  const LatticeDeformation found = find_lattice_deformation(bent, {k_a, k_b});
  const GreyImage image = straightened(bent, found.displacement);
  ASSERT_EQ(image.width, bent.width);
  ASSERT_EQ(image.height, bent.height);
  // Regular now: one cell further it is the same.
  EXPECT_LT(test::irregularity(image), 0.5 * test::irregularity(bent));
}

TEST(LatticeDeformation, BentPlaceInvertsTheDisplacement) {
  const LatticeDeformation found = find_lattice_deformation(picture(1), {k_a, k_b});
  for (const Vec2 y : {Vec2{20, 30}, Vec2{150.5, 99.25}, Vec2{0, 149}}) {
    const Vec2 x = bent_place(found.displacement, y);
    EXPECT_LT(norm(x + found.displacement.at(x) - y), 0.01);
  }
}

TEST(LatticeDeformation, RefusesBadArguments) {
  const GreyImage image = picture(0);
  EXPECT_THROW(find_lattice_deformation(image, {Vec2{20, 0}, Vec2{40, 0}}), InvalidInput);
  EXPECT_THROW(find_lattice_deformation(image, {Vec2{1, 0}, Vec2{0, 20}}), InvalidInput);
  EXPECT_THROW(find_lattice_deformation(image, {k_a, Vec2{0, std::numeric_limits<double>::quiet_NaN()}}), InvalidInput);
  EXPECT_THROW(find_lattice_deformation(image, {k_a, k_b}, {.bend = 0}), InvalidInput);
  EXPECT_THROW(find_lattice_deformation(GreyImage{}, {k_a, k_b}), InvalidInput);
}

}  // namespace
}  // namespace papilla
