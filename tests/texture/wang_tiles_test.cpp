// SPDX-License-Identifier: MIT
#include "papilla/texture/wang_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr int k_picture = 320, k_side = 80;

/// A random surface with waves of a few to thirty texels, and a second plane that follows it.
std::vector<std::vector<float>> grain() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 160; ++k) {
    const double angle = 6.283 * unit(random), length = 6 * std::pow(5, unit(random));
    waves.push_back({6.283 / length * std::cos(angle), 6.283 / length * std::sin(angle), 6.283 * unit(random)});
  }
  std::vector<std::vector<float>> planes(2);
  for (int y = 0; y < k_picture; ++y)
    for (int x = 0; x < k_picture; ++x) {
      double sum = 0;
      for (const Wave& wave : waves) sum += std::cos(wave.x * x + wave.y * y + wave.phase);
      planes[0].push_back(static_cast<float>(sum / 9));
      planes[1].push_back(2 * planes[0].back() + 1);
    }
  return planes;
}

WangTileSet tiles_of(const std::vector<std::vector<float>>& planes) {
  WangOptions options;
  options.side = k_side;
  return make_wang_tiles({planes[0], planes[1]}, 1, k_picture, k_picture, options);
}

float texel(const WangTileSet& set, std::size_t plane, int tile, int x, int y) {
  return set.planes[plane][static_cast<std::size_t>(tile / 4 * k_side + y) * 4 * k_side +
                           static_cast<std::size_t>(tile % 4 * k_side + x)];
}

TEST(WangTiles, LieBesideEachOtherByTheColoursOfTheirEdges) {
  std::array<int, k_wang_tiles> counts{};
  for (int y = -40; y < 40; ++y)
    for (int x = -40; x < 40; ++x) {
      const WangTile here = wang_tile(wang_tile_at(x, y, 3));
      ++counts[static_cast<std::size_t>(wang_tile_at(x, y, 3))];
      EXPECT_EQ(here.east, wang_tile(wang_tile_at(x + 1, y, 3)).west);
      EXPECT_EQ(here.south, wang_tile(wang_tile_at(x, y + 1, 3)).north);
    }
  for (const int count : counts) EXPECT_NEAR(count, 800, 120);  // 4 sigma
  // For every north and west colour two tiles, one for each south colour.
  std::set<std::array<int, 3>> chosen;
  for (int t = 0; t < k_wang_tiles; ++t) chosen.insert({wang_tile(t).north, wang_tile(t).west, wang_tile(t).south});
  EXPECT_EQ(chosen.size(), 8U);
}

TEST(WangTiles, HaveTheSameTexelsAlongEdgesOfOneColour) {
  const WangTileSet set = tiles_of(grain());
  for (int a = 0; a < k_wang_tiles; ++a)
    for (int b = 0; b < k_wang_tiles; ++b)
      for (std::size_t plane = 0; plane < 2; ++plane)
        for (int i = 0; i < k_side; ++i) {
          const WangTile s = wang_tile(a), t = wang_tile(b);
          if (s.north == t.north) EXPECT_EQ(texel(set, plane, a, i, 0), texel(set, plane, b, i, 0));
          if (s.south == t.south) EXPECT_EQ(texel(set, plane, a, i, k_side - 1), texel(set, plane, b, i, k_side - 1));
          if (s.west == t.west) EXPECT_EQ(texel(set, plane, a, 0, i), texel(set, plane, b, 0, i));
          if (s.east == t.east) EXPECT_EQ(texel(set, plane, a, k_side - 1, i), texel(set, plane, b, k_side - 1, i));
        }
}

TEST(WangTiles, MeetAsNeighboursInThePictureDo) {
  const auto planes = grain();
  const auto at = [&](int x, int y) { return planes[0][static_cast<std::size_t>(y * k_picture + x)]; };
  std::set<std::pair<float, float>> across, down;  // Texels of the picture side by side, and one below the other.
  std::vector<float> steps;
  for (int y = 0; y < k_picture; ++y)
    for (int x = 1; x < k_picture; ++x) {
      across.emplace(at(x - 1, y), at(x, y)), down.emplace(at(y, x - 1), at(y, x));
      steps.push_back(std::abs(at(x, y) - at(x - 1, y)));
    }
  std::sort(steps.begin(), steps.end());
  const float common = steps[steps.size() * 99 / 100];
  const WangTileSet set = tiles_of(planes);
  int beyond = 0, pairs = 0;
  for (int a = 0; a < k_wang_tiles; ++a)
    for (int b = 0; b < k_wang_tiles; ++b)
      for (int i = 0; i < k_side; ++i) {
        const auto meet = [&](const std::set<std::pair<float, float>>& known, float first, float second) {
          EXPECT_TRUE(known.contains({first, second})) << a << " and " << b << " at " << i;
          beyond += std::abs(first - second) > common, ++pairs;
        };
        if (wang_tile(a).east == wang_tile(b).west)
          meet(across, texel(set, 0, a, k_side - 1, i), texel(set, 0, b, 0, i));
        if (wang_tile(a).south == wang_tile(b).north)
          meet(down, texel(set, 0, a, i, k_side - 1), texel(set, 0, b, i, 0));
      }
  EXPECT_EQ(pairs, 2 * 32 * k_side);
  EXPECT_LE(beyond, 0.03 * pairs);  // One in a hundred of the picture's; four edges are a small sample of it.
  EXPECT_LT(set.seam_cost, 2);
}

TEST(WangTiles, KeepThePlanesTogether) {
  const WangTileSet set = tiles_of(grain());
  for (std::size_t i = 0; i < set.planes[0].size(); ++i) ASSERT_EQ(set.planes[1][i], 2 * set.planes[0][i] + 1);
}

double correlation(const std::vector<float>& plane, int side, int dx, int dy) {
  double ab = 0, a = 0, b = 0, aa = 0, bb = 0, n = 0;
  for (int y = 0; y + dy < side; ++y)
    for (int x = 0; x + dx < side; ++x, ++n) {
      const auto p = static_cast<double>(plane[static_cast<std::size_t>(y * side + x)]);
      const auto q = static_cast<double>(plane[static_cast<std::size_t>((y + dy) * side + x + dx)]);
      ab += p * q, a += p, b += q, aa += p * p, bb += q * q;
    }
  return (ab / n - a / n * b / n) / std::sqrt((aa / n - a / n * a / n) * (bb / n - b / n * b / n));
}

TEST(WangTiles, LayAPlaneWithoutAPeriod) {
  const WangTileSet set = tiles_of(grain());
  constexpr int k_columns = 20, k_plane = k_columns * k_side;
  const std::vector<float> plane = lay_wang_tiles(set, 0, k_columns, k_columns, 9);
  // Eight tiles have 1/8 inside and 1/2 at their edges, less than what their edges alone would have; a repeated one 1.
  constexpr double k_most = 0.45;
  double most = 0;
  for (int k = 0; k <= 3; ++k)
    for (int l = 0; l <= 3; ++l)
      if (k + l > 0) most = std::max(most, correlation(plane, k_plane, k * k_side, l * k_side));
  EXPECT_LT(most, k_most);
  std::vector<float> repeated;
  for (int y = 0; y < k_plane; ++y)
    for (int x = 0; x < k_plane; ++x) repeated.push_back(texel(set, 0, 0, x % k_side, y % k_side));
  EXPECT_GT(correlation(repeated, k_plane, k_side, 0), 0.999);
}

TEST(WangTiles, RefusesWhatIsNoPictureOfTiles) {
  const auto planes = grain();
  WangOptions options;
  options.side = 170;
  EXPECT_THROW(make_wang_tiles({planes[0]}, 1, k_picture, k_picture, options), InvalidInput);
  options.side = 33;
  EXPECT_THROW(make_wang_tiles({planes[0]}, 1, k_picture, k_picture, options), InvalidInput);
  options.side = 32;
  EXPECT_THROW(make_wang_tiles({planes[0]}, 2, k_picture, k_picture, options), InvalidInput);
  EXPECT_THROW(make_wang_tiles({planes[0]}, 1, k_picture, k_picture - 1, options), InvalidInput);
  auto broken = planes;
  broken[0][5] = NAN;
  EXPECT_THROW(make_wang_tiles({broken[0]}, 1, k_picture, k_picture, options), InvalidInput);
}

}  // namespace
}  // namespace papilla
