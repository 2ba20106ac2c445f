// SPDX-License-Identifier: MIT
#include "slit_fronts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "drawn_seams.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// An oblong sheet of 24 x 10 cells, 1 wide and 0.8 high, from (0, 0) on. What its maps are is given.
class StretchedSheet : public testing::Test {
 protected:
  static constexpr double k_high = 0.8;

  StretchedSheet() : mesh_(test::plane(24, 10 * k_high, 24, 10)), costs_(3 * mesh_.triangles.size(), 1) {
    const Vec3 corner = mesh_.positions[0];
    for (Vec3& p : mesh_.positions) p = p - corner;
  }

  /// @param map of a place of the sheet and the middle of its triangle.
  SeamState state(const std::vector<std::uint8_t>& seam, const std::function<Vec2(Vec3, Vec3)>& map) const {
    Flattening flat;
    flat.charts = charts_between(seams_, seam);
    const TriangleMesh open = cut_open(mesh_, flat.charts);
    flat.uv.indices = open.triangles;
    flat.uv.values.resize(open.positions.size());
    for (const Triangle& t : open.triangles) {
      const Vec3 middle = (1.0 / 3) * (open.positions[t[0]] + open.positions[t[1]] + open.positions[t[2]]);
      for (const Index v : t) flat.uv.values[v] = map(open.positions[v], middle);
    }
    return measured(seams_, {std::move(flat), {}}, {});
  }

  std::vector<SlitFront> fronts(const SeamState& of) const { return slit_fronts(seams_, OutgoingEdges(seams_), of); }

  TriangleMesh mesh_;
  std::vector<double> costs_;
  SeamMesh seams_{mesh_, costs_};
};

TEST_F(StretchedSheet, ATipRunsOnStraightWhereItsSlitOpens) {
  // A slit from the left at half height, 8 long, open by 0.03 r: of the three edges behind the tip, r = 3.
  const double middle = 5 * k_high;
  for (const bool from_right : {false, true}) {
    std::vector<std::uint8_t> seam = test::border_seams(seams_);
    test::draw_seam(seams_, seam, {from_right ? 24.0 : 0.0, middle, 0}, {from_right ? 16.0 : 8.0, middle, 0});
    const auto opened = [&](Vec3 p, Vec3 inside) {
      const double r = from_right ? p.x - 16 : 8 - p.x;
      const bool is_on_slit = std::abs(p.y - middle) < 1e-9 && r > 0;
      return Vec2{p.x, p.y + (is_on_slit ? (inside.y > middle ? 0.015 : -0.015) * r : 0)};
    };
    const std::vector<SlitFront> all = fronts(state(seam, opened));
    ASSERT_FALSE(all.empty());
    const SlitFront& tip = all.front();
    EXPECT_FALSE(tip.is_new);
    ASSERT_EQ(tip.way.size(), 4u);  // half of its length
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 to = mesh_.positions[seams_.to(tip.way[i])];
      EXPECT_NEAR(to.y, middle, 1e-9);
      EXPECT_NEAR(to.x, from_right ? 15.0 - static_cast<double>(i) : 9.0 + static_cast<double>(i), 1e-9);
      EXPECT_NEAR(tip.released[i], std::numbers::pi * 0.09 * 0.09 / (4 * 3) * static_cast<double>(i + 1), 1e-9);
    }
  }
}

TEST_F(StretchedSheet, ATipTurnsWhereTheSidesOfItsSlitSlide) {
  // Without opening the hoop tension is greatest 70.5 degrees away, on the side where the sheet is drawn towards the
  // slit: the edges straight up and down are 90 degrees away, those along the diagonals 39.
  const double middle = 5 * k_high;
  for (const bool from_right : {false, true})
    for (const double slide : {0.02, -0.02}) {
      const double tip = from_right ? 16 : 8;
      std::vector<std::uint8_t> seam = test::border_seams(seams_);
      test::draw_seam(seams_, seam, {from_right ? 24.0 : 0.0, middle, 0}, {tip, middle, 0});
      const auto slid = [&](Vec3 p, Vec3 inside) {  // the upper side towards the tip, the lower one away from it
        const bool is_on_slit = std::abs(p.y - middle) < 1e-9 && (from_right ? p.x > tip : p.x < tip);
        return Vec2{p.x + (is_on_slit ? (inside.y > middle ? slide : -slide) * (tip - p.x) : 0), p.y};
      };
      const SlitFront front = fronts(state(seam, slid)).front();
      const Vec3 to = mesh_.positions[seams_.to(front.way.front())];
      EXPECT_NEAR(to.x, tip, 1e-9) << slide;
      EXPECT_NEAR(to.y, middle + (slide > 0 ? -k_high : k_high), 1e-9) << slide;
    }
}

TEST_F(StretchedSheet, NewSlitsRunAcrossTheTension) {
  // Stretched along x, up from the lower and down from the upper border; along y, from the left and the right.
  const double strain = 0.5 * (1 - 1 / 1.21), most = 0.5 * std::sqrt(24 * 10 * k_high);
  for (const bool along_y : {false, true}) {
    const auto stretched = [&](Vec3 p, Vec3) { return Vec2{(along_y ? 1 : 1.1) * p.x, (along_y ? 1.1 : 1) * p.y}; };
    const std::vector<SlitFront> all = fronts(state(test::border_seams(seams_), stretched));
    ASSERT_EQ(all.size(), 8u);
    for (const SlitFront& front : all) {
      EXPECT_TRUE(front.is_new);
      const Vec3 start = mesh_.positions[front.start(seams_)];
      double length = 0;
      for (std::size_t i = 0; i < front.way.size(); ++i) {
        const Vec3 from = mesh_.positions[seams_.from(front.way[i])], to = mesh_.positions[seams_.to(front.way[i])];
        EXPECT_NEAR(along_y ? to.y : to.x, along_y ? from.y : from.x, 1e-9);
        length += norm(to - from);
        EXPECT_NEAR(front.released[i], 8 * std::numbers::pi * std::pow(strain * length, 2), 1e-9);
      }
      EXPECT_LT(length, most + 1);
      EXPECT_TRUE(along_y ? start.x == 0 || std::abs(start.x - 24) < 1e-9
                          : start.y == 0 || std::abs(start.y - 10 * k_high) < 1e-9);
    }
  }
}

TEST_F(StretchedSheet, NewSlitsEndWhereTheTensionDoes) {
  // Stretched up to 3.2 high: it is most per length to cut as far as that.
  const auto stretched = [&](Vec3 p, Vec3) { return Vec2{p.x * (p.y < 3.3 ? 1.1 : 1.0), p.y}; };
  int from_below = 0;
  for (const SlitFront& front : fronts(state(test::border_seams(seams_), stretched))) {
    const Vec3 start = mesh_.positions[front.start(seams_)], end = mesh_.positions[seams_.to(front.way.back())];
    if (start.y != 0 || std::abs(start.x - 12) > 2) continue;  // beyond, the map is askew
    ++from_below;
    EXPECT_NEAR(end.y, 3.2, 1.01 * k_high);
  }
  EXPECT_GE(from_below, 1);
}

TEST_F(StretchedSheet, WhatIsPressedTogetherIsNotSlit) {
  EXPECT_TRUE(fronts(state(test::border_seams(seams_), [](Vec3 p, Vec3) {
                return Vec2{0.9 * p.x, 0.9 * p.y};
              })).empty());
}

}  // namespace
}  // namespace papilla
