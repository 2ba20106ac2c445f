// SPDX-License-Identifier: MIT
#include "papilla/texture/lattice_agreement.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

Lattice lattice(Vec2 a, Vec2 b) {
  Lattice result;
  result.found = true;
  result.vectors_px = {a, b};
  return result;
}

TEST(LatticeAgreement, BasesOfOneLatticeAgree) {
  const Lattice square = lattice({10, 0}, {0, 12});
  EXPECT_TRUE(is_same_lattice(square, lattice({10, 12}, {-10, 0})));
  EXPECT_TRUE(is_same_lattice(square, lattice({10.3, 0.2}, {-0.2, 11.8})));
}

TEST(LatticeAgreement, OthersDoNot) {
  const Lattice square = lattice({10, 0}, {0, 12});
  EXPECT_FALSE(is_same_lattice(square, lattice({20, 0}, {0, 12})));
  EXPECT_FALSE(is_same_lattice(square, lattice({5, 0}, {0, 12})));
  EXPECT_FALSE(is_same_lattice(square, lattice({12, 0}, {0, 12})));
  EXPECT_FALSE(is_same_lattice(square, Lattice{}));
  EXPECT_FALSE(is_same_lattice(Lattice{}, Lattice{}));
}

TEST(LatticeAgreement, HalfOfThePiecesAreEnough) {
  const Lattice middle = lattice({10, 0}, {0, 12});
  LatticeAgreement agreement;
  agreement.add(middle, middle);
  agreement.add(middle, Lattice{});
  EXPECT_TRUE(agreement.holds());
  agreement.add(middle, lattice({7, 0}, {0, 7}));
  EXPECT_FALSE(agreement.holds());
  EXPECT_EQ(agreement.same, 1);
  EXPECT_EQ(agreement.none, 1);
  EXPECT_EQ(agreement.other, 1);
}

TEST(LatticeAgreement, NoLatticeAgreesWithNone) {
  LatticeAgreement agreement;
  agreement.add(Lattice{}, Lattice{});
  agreement.add(Lattice{}, lattice({7, 0}, {0, 7}));
  EXPECT_EQ(agreement.same, 1);
  EXPECT_EQ(agreement.other, 1);
}

}  // namespace
}  // namespace papilla
