// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace papilla {

/// A tile by the colours, 0 or 1, of its edges.
struct WangTile {
  int north = 0, west = 0, south = 0, east = 0;
};

/// Tiles of the set: for every north and west colour two, with every south colour once.
inline constexpr int k_wang_tiles = 8;
/// Tile n + 2 w + 4 s has the north colour n, west w, south s, and east n ^ w ^ s.
constexpr WangTile wang_tile(int index) noexcept {
  const int n = index & 1, w = index >> 1 & 1, s = index >> 2 & 1;
  return {n, w, s, n ^ w ^ s};
}

/// The tile at column x and row y of an endless plane: an edge has the colour v(a) ^ v(b) of the hashes of its ends,
/// so that every tile is known without its neighbours, neighbours share the colour of their edge, and all tilings that
/// the set allows are equally likely. Cost: four hashes.
int wang_tile_at(std::int32_t x, std::int32_t y, std::uint32_t seed) noexcept;

struct WangOptions {
  int side = 128;    ///< Texels a side of a tile. @pre even, at least 16, at most half of the picture's sides.
  int windows = 12;  ///< Places that are tried for every edge and inside; the one that fits best is taken.
  std::uint32_t seed = 1;
};

/// A picture of 4 x 2 tiles, tile t at column t % 4, row t / 4, for every plane.
struct WangTileSet {
  int side = 0;
  std::vector<std::vector<float>> planes;  ///< 4 side x 2 side each, row by row.
  double seam_cost = 0;  ///< Mean difference a texel along the cuts, over that of neighbours in the picture.
};

/// Makes Wang tiles of a picture [Cohen, Shade, Hiller, Deussen 2003: Wang Tiles for Image and Texture Generation].
///
/// Every edge colour has a window of the picture about that edge; all four share one patch about the edges' ends, put
/// into them along a least cut, so that nothing jumps where four tiles meet. A tile is the four windows of its edges,
/// each in its quarter, joined along least cuts from the corners to the middle, and a window of its own laid over the
/// inside along a least closed cut [Kwatra et al. 2003: Graphcut Textures; Boykov, Kolmogorov 2004]. The cuts see the
/// first `compared` planes, each over its standard deviation, and hold for all planes: height moves with its colour.
///
/// Guarantees: texels along an edge are the same bits in all tiles with its colour, and across it they are neighbours
/// in the picture. Two places of the plane a whole number of tiles
/// apart show the same texel with a probability of 1/8 inside and 1/2 at the edges, so that nothing has a period, but
/// correlation at such shifts is 0.2 to 0.4 (of eight tiles at least 1/8, of one tile 1). Needs a picture without large
/// features of its own, at least twice a tile wide; a picture that tiles need not. Cost: some minimum cuts of side^2
/// nodes, about 2 s at a side of 128. Deterministic by the seed.
/// @param planes  of width x height texels each, all finite. @pre 1 <= compared <= planes.size().
/// @throws InvalidInput when a precondition is broken.
WangTileSet make_wang_tiles(const std::vector<std::span<const float>>& planes, std::size_t compared, int width,
                            int height, const WangOptions& options = {});

/// Columns x rows tiles of one plane of the set, laid by wang_tile_at().
std::vector<float> lay_wang_tiles(const WangTileSet& tiles, std::size_t plane, int columns, int rows,
                                  std::uint32_t seed);

}  // namespace papilla
