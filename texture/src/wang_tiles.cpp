// SPDX-License-Identifier: MIT
#include "papilla/texture/wang_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "papilla/core/error.hpp"

// GCC takes the iterators' boost::optional for read before it is set.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#pragma GCC diagnostic pop

namespace papilla {
namespace {

using Planes = std::vector<std::span<const float>>;

std::uint32_t mixed(std::uint32_t a, std::uint32_t b, std::uint32_t seed) noexcept {
  std::uint32_t h = a * 0x9E3779B1U + b * 0x85EBCA77U + seed * 0xC2B2AE3DU;
  h ^= h >> 15, h *= 0x2C1B3C6DU;
  h ^= h >> 12, h *= 0x297A2D39U;
  return h ^ h >> 15;
}

/// A square of texels, all planes one after the other.
struct Patch {
  int width = 0, height = 0;
  std::vector<std::vector<float>> planes;
  Patch(int w, int h, std::size_t count)
      : width(w),
        height(h),
        planes(count, std::vector<float>(static_cast<std::size_t>(w) * static_cast<std::size_t>(h))) {}
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  void take(int x, int y, const Patch& from, int fx, int fy) {
    for (std::size_t p = 0; p < planes.size(); ++p) planes[p][at(x, y)] = from.planes[p][from.at(fx, fy)];
  }
};

/// What the differences of the compared planes are measured in.
struct Scales {
  std::vector<float> inverse;  ///< Of the compared planes.
  double neighbours = 0;       ///< Mean difference of texels side by side.

  float difference(const Patch& a, std::size_t at_a, const Patch& b, std::size_t at_b) const {
    float sum = 0;
    for (std::size_t p = 0; p < inverse.size(); ++p) {
      const float d = (a.planes[p][at_a] - b.planes[p][at_b]) * inverse[p];
      sum += d * d;
    }
    return std::sqrt(sum);
  }
};

Scales scales_of(const Patch& picture, std::size_t compared) {
  Scales scales;
  for (std::size_t p = 0; p < compared; ++p) {
    double sum = 0, squares = 0;
    for (const float v : picture.planes[p])
      sum += static_cast<double>(v), squares += static_cast<double>(v) * static_cast<double>(v);
    const double count = static_cast<double>(picture.planes[p].size());
    const double deviation = std::sqrt(std::max(0.0, squares / count - sum / count * sum / count));
    scales.inverse.push_back(deviation > 0 ? static_cast<float>(1 / deviation) : 0);
  }
  std::size_t pairs = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 1; x < picture.width; ++x, ++pairs)
      scales.neighbours +=
          static_cast<double>(scales.difference(picture, picture.at(x, y), picture, picture.at(x - 1, y)));
  scales.neighbours /= static_cast<double>(pairs);
  return scales;
}

/// Which of two patches a texel of a cut has.
enum class Owner : unsigned char { free, first, second };

/// Sums along the cuts.
struct CutCost {
  double sum = 0;
  std::size_t edges = 0;
};

/// A line between two rows or columns of texels that no cut may run along; where there is none, past the patch.
struct Joint {
  int column = 1 << 30, row = 1 << 30;  ///< The first ones behind the line.
};

/// Chooses the owner of every free texel so that the sum of |a - b| at both ends of every pair of neighbours with
/// unlike owners is least. Neighbours across a joint have the same owner.
/// @param first, second  two patches of the size of `owners`.
void cut(const Patch& first, const Patch& second, const Scales& scales, std::vector<Owner>& owners, CutCost& cost,
         const Joint& joint = {}) {
  using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
  using Network = boost::adjacency_list<
      boost::vecS, boost::vecS, boost::directedS,
      boost::property<
          boost::vertex_index_t, long,
          boost::property<boost::vertex_color_t, boost::default_color_type,
                          boost::property<boost::vertex_distance_t, long,
                                          boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>>,
      boost::property<boost::edge_capacity_t, long,
                      boost::property<boost::edge_residual_capacity_t, long,
                                      boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;
  constexpr double k_unit = 4096;  // Whole numbers, so that the order of additions does not matter.
  constexpr long k_tied = 1L << 40;
  const int w = first.width, h = first.height;
  const std::size_t texels = owners.size(), source = texels, sink = texels + 1;
  Network network(texels + 2);
  const auto capacity = boost::get(boost::edge_capacity, network);
  const auto reverse = boost::get(boost::edge_reverse, network);
  const auto connect = [&](std::size_t a, std::size_t b, long there, long back) {
    const auto out = boost::add_edge(a, b, network).first, in = boost::add_edge(b, a, network).first;
    capacity[out] = there, capacity[in] = back;
    reverse[out] = in, reverse[in] = out;
  };
  std::vector<float> unlike(texels);
  for (std::size_t i = 0; i < texels; ++i) unlike[i] = scales.difference(first, i, second, i);
  const auto weight = [&](std::size_t a, std::size_t b) {
    return 1 + std::lround(k_unit * static_cast<double>(unlike[a] + unlike[b]));
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const std::size_t i = first.at(x, y);
      const auto link = [&](std::size_t other, bool is_tied) {
        const long both = is_tied ? k_tied : weight(i, other);
        connect(i, other, both, both);
      };
      if (x + 1 < w) link(i + 1, x + 1 == joint.column);
      if (y + 1 < h) link(i + static_cast<std::size_t>(w), y + 1 == joint.row);
      if (owners[i] == Owner::first) connect(source, i, k_tied, 0);
      if (owners[i] == Owner::second) connect(i, sink, k_tied, 0);
    }
  boost::boykov_kolmogorov_max_flow(network, source, sink);
  const auto colour = boost::get(boost::vertex_color, network);
  const auto reached = colour[source];
  for (std::size_t i = 0; i < texels; ++i) owners[i] = colour[i] == reached ? Owner::first : Owner::second;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const std::size_t i = first.at(x, y);
      const auto count = [&](std::size_t other) {
        if (owners[i] == owners[other]) return;
        cost.sum += static_cast<double>(unlike[i] + unlike[other]) / 2;
        ++cost.edges;
      };
      if (x + 1 < w) count(i + 1);
      if (y + 1 < h) count(i + static_cast<std::size_t>(w));
    }
}

class TileMaker {
 public:
  TileMaker(Patch picture, std::size_t compared, const WangOptions& options)
      : picture_(std::move(picture)),
        scales_(scales_of(picture_, compared)),
        options_(options),
        side_(options.side),
        half_(options.side / 2),
        reach_(std::max(4, options.side / 6)) {}

  WangTileSet make() {
    const Patch corner = window(2 * reach_, 2 * reach_);
    for (int colour = 0; colour < 2; ++colour) {
      across_.push_back(about_edge(corner, {{{-reach_, half_ - reach_}, {side_ - reach_, half_ - reach_}}}, false));
      down_.push_back(about_edge(corner, {{{half_ - reach_, -reach_}, {half_ - reach_, side_ - reach_}}}, true));
    }
    WangTileSet set;
    set.side = side_;
    set.planes.assign(picture_.planes.size(),
                      std::vector<float>(static_cast<std::size_t>(k_wang_tiles) * static_cast<std::size_t>(side_) *
                                         static_cast<std::size_t>(side_)));
    for (int index = 0; index < k_wang_tiles; ++index) {
      Patch tile = of_edges(wang_tile(index));
      fill_inside(tile);
      for (std::size_t p = 0; p < set.planes.size(); ++p)
        for (int y = 0; y < side_; ++y)
          std::copy_n(tile.planes[p].begin() + static_cast<std::ptrdiff_t>(tile.at(0, y)), side_,
                      set.planes[p].begin() + std::ptrdiff_t{index / 4 * side_ + y} * 4 * side_ + index % 4 * side_);
    }
    set.seam_cost = cost_.edges > 0 && scales_.neighbours > 0
                        ? cost_.sum / static_cast<double>(cost_.edges) / scales_.neighbours
                        : 0;
    return set;
  }

 private:
  /// A window of the picture at the next random place.
  Patch window(int width, int height) {
    const auto place = [&](int room) {
      return static_cast<int>(mixed(++drawn_, 7, options_.seed) % static_cast<std::uint32_t>(room + 1));
    };
    const int left = place(picture_.width - width), top = place(picture_.height - height);
    Patch out(width, height, picture_.planes.size());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) out.take(x, y, picture_, left + x, top + y);
    return out;
  }

  /// The window about an edge into which the patch of its two ends goes best.
  Patch about_edge(const Patch& corner, const std::array<std::array<int, 2>, 2>& ends, bool is_vertical) {
    std::optional<Patch> best;
    CutCost least;
    for (int k = 0; k < options_.windows; ++k) {
      Patch made = window(side_, side_);
      CutCost cost;
      for (const auto& [left, top] : ends) insert_corner(made, corner, left, top, is_vertical, cost);
      if (!best || cost.sum < least.sum) best = std::move(made), least = cost;
    }
    cost_.sum += least.sum, cost_.edges += least.edges;
    return std::move(*best);
  }

  /// Lays the patch of the corners over a window, its upper left at (left, top), along a least cut.
  void insert_corner(Patch& window, const Patch& corner, int left, int top, bool is_vertical, CutCost& cost) const {
    const int x0 = std::max(left, 0), y0 = std::max(top, 0), x1 = std::min(left + corner.width, side_),
              y1 = std::min(top + corner.height, side_);
    Patch inner(x1 - x0, y1 - y0, corner.planes.size()), outer = inner;
    std::vector<Owner> owners(inner.planes[0].size(), Owner::free);
    const double kept = std::max(2.0, reach_ / 8.0);
    for (int y = 0; y < inner.height; ++y)
      for (int x = 0; x < inner.width; ++x) {
        inner.take(x, y, corner, x0 - left + x, y0 - top + y);
        outer.take(x, y, window, x0 + x, y0 + y);
        const double r = std::hypot(x0 - left + x + 0.5 - reach_, y0 - top + y + 0.5 - reach_);
        if (r < kept) owners[inner.at(x, y)] = Owner::first;
        if (r > reach_ - 1) owners[inner.at(x, y)] = Owner::second;
      }
    Joint joint;  // The edge: texels on its two sides stay neighbours of one picture.
    (is_vertical ? joint.column : joint.row) = half_ - (is_vertical ? x0 : y0);
    cut(inner, outer, scales_, owners, cost, joint);
    for (int y = 0; y < inner.height; ++y)
      for (int x = 0; x < inner.width; ++x)
        if (owners[inner.at(x, y)] == Owner::first) window.take(x0 + x, y0 + y, inner, x, y);
  }

  /// The four windows of a tile's edges, joined from its corners to its middle.
  Patch of_edges(const WangTile& tile) {
    Patch out(side_, side_, picture_.planes.size());
    for (int quarter = 0; quarter < 4; ++quarter) {
      const bool right = quarter & 1, lower = quarter >> 1;
      const Patch& over = across_[static_cast<std::size_t>(lower ? tile.south : tile.north)];
      const Patch& beside = down_[static_cast<std::size_t>(right ? tile.east : tile.west)];
      // The quarter turned so that its corner is the upper left.
      const auto x_of = [&](int x) { return right ? side_ - 1 - x : x; };
      const auto y_of = [&](int y) { return lower ? side_ - 1 - y : y; };
      Patch first(half_, half_, out.planes.size()), second = first;
      std::vector<Owner> owners(first.planes[0].size(), Owner::free);
      for (int y = 0; y < half_; ++y)
        for (int x = 0; x < half_; ++x) {
          first.take(x, y, over, x_of(x), y_of(y) + (lower ? -half_ : half_));
          second.take(x, y, beside, x_of(x) + (right ? -half_ : half_), y_of(y));
          if (x == 0 || (y == half_ - 1))
            owners[first.at(x, y)] = Owner::second;
          else if (y == 0 || x == half_ - 1)
            owners[first.at(x, y)] = Owner::first;
        }
      cut(first, second, scales_, owners, cost_);
      for (int y = 0; y < half_; ++y)
        for (int x = 0; x < half_; ++x)
          out.take(x_of(x), y_of(y), owners[first.at(x, y)] == Owner::first ? first : second, x, y);
    }
    return out;
  }

  double band_difference(const Patch& a, const Patch& b) const {
    double sum = 0;
    for (int y = 1; y + 1 < side_; ++y)
      for (int x = 1; x + 1 < side_; ++x)
        if (std::min({x, y, side_ - 1 - x, side_ - 1 - y}) < band())
          sum += static_cast<double>(scales_.difference(a, a.at(x, y), b, b.at(x, y)));
    return sum;
  }
  int band() const { return std::max(3, side_ / 5); }

  /// Lays a window of its own over the inside of a tile.
  void fill_inside(Patch& tile) {
    Patch best = window(side_, side_);
    double least = band_difference(tile, best);
    for (int k = 1; k < options_.windows; ++k) {
      Patch other = window(side_, side_);
      if (const double difference = band_difference(tile, other); difference < least)
        least = difference, best = std::move(other);
    }
    std::vector<Owner> owners(tile.planes[0].size(), Owner::free);
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x) {
        const int depth = std::min({x, y, side_ - 1 - x, side_ - 1 - y});
        if (depth == 0) owners[tile.at(x, y)] = Owner::second;
        if (depth >= band()) owners[tile.at(x, y)] = Owner::first;
      }
    cut(best, tile, scales_, owners, cost_);
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x)
        if (owners[tile.at(x, y)] == Owner::first) tile.take(x, y, best, x, y);
  }

  Patch picture_;
  Scales scales_;
  WangOptions options_;
  int side_, half_, reach_;
  std::uint32_t drawn_ = 0;
  std::vector<Patch> across_, down_;  ///< About the horizontal and the vertical edges, by colour.
  CutCost cost_;
};

}  // namespace

int wang_tile_at(std::int32_t x, std::int32_t y, std::uint32_t seed) noexcept {
  const auto end = [&](int dx, int dy) {
    return static_cast<int>(mixed(static_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(dx),
                                  static_cast<std::uint32_t>(y) + static_cast<std::uint32_t>(dy), seed) >>
                            31);
  };
  const int a = end(0, 0), b = end(1, 0), c = end(0, 1), d = end(1, 1);
  return (a ^ b) + 2 * (a ^ c) + 4 * (c ^ d);
}

WangTileSet make_wang_tiles(const std::vector<std::span<const float>>& planes, std::size_t compared, int width,
                            int height, const WangOptions& options) {
  const auto fail = [](const std::string& reason) { throw InvalidInput("make_wang_tiles: " + reason); };
  if (planes.empty() || compared < 1 || compared > planes.size()) fail("there is no plane to compare");
  if (options.side < 16 || options.side % 2 != 0) fail("a tile's side must be even and at least 16 texels");
  if (options.side > std::min(width, height) / 2)
    fail("tiles of " + std::to_string(options.side) + " texels need a picture of at least twice that, not " +
         std::to_string(width) + " x " + std::to_string(height));
  if (options.windows < 1) fail("at least one window must be tried");
  Patch picture(width, height, planes.size());
  for (std::size_t p = 0; p < planes.size(); ++p) {
    if (planes[p].size() != picture.planes[p].size()) fail("plane " + std::to_string(p) + " has another size");
    if (!std::all_of(planes[p].begin(), planes[p].end(), [](float v) { return std::isfinite(v); }))
      fail("plane " + std::to_string(p) + " is not finite");
    std::copy(planes[p].begin(), planes[p].end(), picture.planes[p].begin());
  }
  return TileMaker(std::move(picture), compared, options).make();
}

std::vector<float> lay_wang_tiles(const WangTileSet& tiles, std::size_t plane, int columns, int rows,
                                  std::uint32_t seed) {
  const auto side = static_cast<std::ptrdiff_t>(tiles.side);
  std::vector<float> out(static_cast<std::size_t>(side * columns * side * rows));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int tile = wang_tile_at(column, row, seed);
      for (std::ptrdiff_t y = 0; y < side; ++y)
        std::copy_n(tiles.planes[plane].begin() + (tile / 4 * side + y) * 4 * side + tile % 4 * side, side,
                    out.begin() + (row * side + y) * side * columns + column * side);
    }
  return out;
}

}  // namespace papilla
