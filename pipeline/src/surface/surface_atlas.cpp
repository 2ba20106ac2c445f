// SPDX-License-Identifier: MIT
#include "surface/surface_atlas.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/param/pack.hpp"
#include "surface/surface_texels.hpp"

namespace papilla {
namespace {

constexpr double k_most_side = 8192, k_most_texels = 1 << 26;
constexpr double k_coarser = 0.85, k_coarsest = 1e-3;  // Steps of the resolution, and where they end.

/// A corner of an instance with its coordinates; for flat pieces also the direction its triangle looks in.
using Corner = std::array<std::uint64_t, 4>;

Corner corner_of(const SurfaceTriangle& t, std::size_t k, bool flat) {
  Corner corner{t.instance, static_cast<std::uint64_t>(t.uv_index[k]) << 32 | t.position_index[k], 0, 0};
  if (!flat) return corner;
  const Vec3 n = normalized(cross(t.position[1] - t.position[0], t.position[2] - t.position[0]));
  const auto step = [](double v) { return static_cast<std::uint64_t>(std::lround(1e3 * v) + 2000); };
  corner[2] = step(n.x), corner[3] = step(n.y) << 32 | step(n.z);
  return corner;
}

using Triangles = std::vector<std::uint32_t>;

/// The pieces that hang together at corners with the same place and coordinates.
/// @param flat  and that look in the same direction.
std::vector<Triangles> connected(std::span<const SurfaceTriangle> surface, const Triangles& triangles, bool flat) {
  UnionFind sets(triangles.size());
  std::map<Corner, std::uint32_t> first;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      sets.unite(first.try_emplace(corner_of(surface[triangles[i]], k, flat), i).first->second, i);
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> number = sets.labels(count);
  std::vector<Triangles> pieces(count);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) pieces[number[i]].push_back(triangles[i]);
  return pieces;
}

struct Window {
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  void add(const SurfaceTriangle& t) {
    for (const Vec2& p : t.uv) {
      low[0] = std::min(low[0], p.x), low[1] = std::min(low[1], p.y);
      high[0] = std::max(high[0], p.x), high[1] = std::max(high[1], p.y);
    }
  }
  /// About those of texels_of().
  double texels(double scale) const { return (high[0] - low[0]) * scale * (high[1] - low[1]) * scale; }
};

SurfaceTexels texels_of(const Window& window, double scale) {
  const auto left = static_cast<int>(std::floor(window.low[0] * scale)) - k_gutter,
             top = static_cast<int>(std::floor(window.low[1] * scale)) - k_gutter;
  const auto right = static_cast<int>(std::ceil(window.high[0] * scale)) + k_gutter,
             bottom = static_cast<int>(std::ceil(window.high[1] * scale)) + k_gutter;
  return {left, top, right - left, bottom - top, false};
}

std::int32_t stepped(double value, double step) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value / step, -2e9, 2e9)));
}

/// What a recipe sees of a texel.
void read_texel(const AtlasTile& tile, const SurfaceReading& reading, std::size_t at, std::vector<std::int32_t>& out) {
  const SurfaceTexels& t = tile.texels;
  out.assign(1, t.covered[at]);
  if (!t.covered[at]) return;
  for (const auto& d : reading.directions) {
    double product = 0;
    for (std::size_t k = 0; k < 3; ++k) product += d[k] * static_cast<double>(t.normals[3 * at + k]);
    out.push_back(stepped(product, 1.0 / 2048));
  }
  for (std::size_t k = 0; k < 3 && reading.position; ++k)
    out.push_back(stepped(static_cast<double>(t.positions[3 * at + k]), 1e-4));
  if (!tile.sky.empty()) out.push_back(stepped(static_cast<double>(tile.sky[at]), 1.0 / 256));
}

/// Whether the texel is known as exactly as the one before it.
bool same_as_before(const AtlasTile& tile, const SurfaceReading& reading, std::size_t at) {
  const SurfaceTexels& t = tile.texels;
  if (at == 0 || t.covered[at] != t.covered[at - 1]) return false;
  const auto equal = [at](const std::vector<float>& v) {
    return v[3 * at] == v[3 * at - 3] && v[3 * at + 1] == v[3 * at - 2] && v[3 * at + 2] == v[3 * at - 1];
  };
  return equal(t.normals) && (!reading.position || equal(t.positions)) &&
         (tile.sky.empty() || tile.sky[at] == tile.sky[at - 1]);
}

/// Hash of all that a recipe sees of a tile; runs of equal texels count as one, so that flat faces are read quickly.
std::string look_of(const AtlasTile& tile, const SurfaceReading& reading) {
  const SurfaceTexels& t = tile.texels;
  std::vector<std::int32_t> all{t.left, t.top, t.width, t.height}, texel, last;
  std::int32_t run = 0;
  for (std::size_t at = 0; at < t.count(); ++at, ++run) {
    if (same_as_before(tile, reading, at)) continue;
    read_texel(tile, reading, at, texel);
    if (texel == last) continue;
    all.push_back(run);
    all.insert(all.end(), texel.begin(), texel.end());
    last.swap(texel);
    run = 0;
  }
  return sha256_hex(std::as_bytes(std::span(all)));
}

/// One try at a resolution; nothing when the tiles are too many texels.
class Cutter {
 public:
  Cutter(std::span<const SurfaceTriangle> surface, const SurfaceReading& reading, const SkyView* sky, double scale,
         double most_texels)
      : surface_(surface), reading_(reading), sky_(sky), most_texels_(most_texels) {
    atlas_.texels_per_repeat = scale;
    atlas_.chart_of.resize(surface.size());
  }

  std::optional<SurfaceAtlas> cut(const std::vector<Triangles>& charts) {
    for (const Triangles& chart : charts) {
      if (texels_ > most_texels_) return std::nullopt;
      if (add(chart)) continue;
      for (const Triangles& piece : connected(surface_, chart, true)) {
        if (add(piece)) continue;
        for (const std::uint32_t triangle : piece) add({triangle});
      }
    }
    if (texels_ > most_texels_) return std::nullopt;
    return std::move(atlas_);
  }

 private:
  /// @returns whether the chart lies flat: no texel belongs to two unlike places of it.
  bool add(const Triangles& triangles) {
    if (texels_ > most_texels_) return true;
    Window window;
    for (const std::uint32_t t : triangles) window.add(surface_[t]);
    if (window.texels(atlas_.texels_per_repeat) > most_texels_) {  // Known before memory is taken for them.
      texels_ += window.texels(atlas_.texels_per_repeat);
      return true;
    }
    AtlasTile tile{texels_of(window, atlas_.texels_per_repeat), {}, 1};
    for (const std::uint32_t t : triangles)
      if (draw(tile.texels, surface_[t], atlas_.texels_per_repeat, reading_) > 0 && triangles.size() > 1) return false;
    grow(tile.texels, k_gutter);
    if (sky_) tile.sky = sky_texels(tile.texels, *sky_);
    const auto number = static_cast<std::uint32_t>(atlas_.tiles.size());
    const auto [it, is_new] = known_.try_emplace(look_of(tile, reading_), number);
    for (const std::uint32_t t : triangles) atlas_.chart_of[t] = static_cast<std::uint32_t>(atlas_.charts.size());
    atlas_.charts.push_back({tile.texels.left, tile.texels.top, it->second});
    if (is_new) {
      texels_ += static_cast<double>(tile.texels.count());
      atlas_.tiles.push_back(std::move(tile));
    } else {
      ++atlas_.tiles[it->second].charts;
    }
    return true;
  }

  std::span<const SurfaceTriangle> surface_;
  const SurfaceReading& reading_;
  const SkyView* sky_;
  double most_texels_;
  SurfaceAtlas atlas_;
  std::map<std::string, std::uint32_t> known_;
  double texels_ = 0;
};

/// Where the recipe reads nothing of the surface, or no texel is shown by two places: one repeat, or nothing.
std::optional<SurfaceTexels> one_repeat(std::span<const SurfaceTriangle> surface, const SurfaceReading& reading,
                                        int size) {
  SurfaceTexels texels(0, 0, size, size, true);
  const bool reads_nothing = reading.directions.empty() && !reading.position && !reading.sky;
  double drawn = 0;  // Texels, since it was last asked whether any is left.
  for (const SurfaceTriangle& t : surface) {
    if (draw(texels, t, size, reading) > 0) return std::nullopt;
    if (!reads_nothing) continue;
    drawn += std::abs(cross(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0])) / 2 * size * size;
    if (drawn < static_cast<double>(texels.count())) continue;
    if (std::find(texels.covered.begin(), texels.covered.end(), 0) == texels.covered.end()) break;
    drawn = 0;
  }
  grow(texels, k_gutter);
  // What no surface shows is painted, too, and looks upwards.
  for (std::size_t at = 0; at < texels.count(); ++at)
    if (!texels.covered[at]) texels.covered[at] = 1, texels.normals[3 * at + 1] = 1;
  return texels;
}

/// Whether coordinates go on as channel 1 when an atlas takes channel 0.
bool keeps_coordinates(const Scene& scene, std::span<const Instance> all, std::span<const SurfaceTriangle> surface,
                       const TextureReference& place) {
  return place.tex_coord == 1 || std::all_of(surface.begin(), surface.end(), [&](const SurfaceTriangle& t) {
           return scene.parts[all[t.instance].part].mesh.uv1.empty();
         });
}

}  // namespace

SurfaceAtlas cut_surface(std::span<const SurfaceTriangle> surface, double texels_per_repeat, int most_side,
                         const SurfaceReading& reading, const SkyView* sky) {
  Triangles all(surface.size());
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<Triangles> charts = connected(surface, all, false);
  double longest = 0, farthest = 0;
  for (const Triangles& chart : charts) {
    Window window;
    for (const std::uint32_t t : chart) window.add(surface[t]);
    for (const int k : {0, 1}) {
      longest = std::max(longest, window.high[k] - window.low[k]);
      farthest = std::max({farthest, std::abs(window.low[k]), std::abs(window.high[k])});
    }
  }
  if (!(farthest < 1e9))
    throw InvalidInput("surface atlas: texture coordinates of " + std::to_string(farthest) + " repeats");
  const double finest = std::min({texels_per_repeat, (k_most_side - 2 * k_gutter - 2) / std::max(longest, 1e-300),
                                  1e9 / std::max(farthest, 1e-300)});
  // Coarser and coarser until the asked number of texels is enough, and then until any is.
  for (const double most_texels : {static_cast<double>(most_side) * most_side, k_most_texels})
    for (double scale = finest; scale > k_coarsest * finest; scale *= k_coarser)
      if (auto atlas = Cutter(surface, reading, sky, scale, most_texels).cut(charts)) return std::move(*atlas);
  throw InvalidInput("surface atlas: " + std::to_string(charts.size()) + " charts do not fit into a picture");
}

TilePlaces place_tiles(std::span<const std::pair<int, int>> sizes) {
  CornerAttribute<Vec2> boxes;
  ChartSet charts;
  charts.count = static_cast<std::uint32_t>(sizes.size());
  for (std::uint32_t i = 0; i < charts.count; ++i) {
    const double w = sizes[i].first, h = sizes[i].second;
    const auto first = static_cast<Index>(boxes.values.size());
    boxes.values.insert(boxes.values.end(), {{0, 0}, {w, 0}, {w, h}, {0, h}});
    boxes.indices.push_back({first, first + 1, first + 2});
    boxes.indices.push_back({first, first + 2, first + 3});
    charts.of_triangle.insert(charts.of_triangle.end(), {i, i});
  }
  AtlasOptions options;
  options.gutter_mm = 0;  // The tiles bring their own.
  const Atlas packed = pack_atlas(boxes, charts, options);
  TilePlaces places{
      static_cast<int>(std::lround(packed.size_mm.x)), static_cast<int>(std::lround(packed.size_mm.y)), {}};
  for (const Vec2& corner : packed.offset)
    places.corner.emplace_back(static_cast<int>(std::lround(corner.x)), static_cast<int>(std::lround(corner.y)));
  return places;
}

bool MaterialSurface::leaves_the_repeat() const {
  constexpr double k_slack = 1e-6;
  const auto inside = [](double v) { return v >= -k_slack && v <= 1 + k_slack; };
  return std::any_of(triangles.begin(), triangles.end(), [&](const SurfaceTriangle& t) {
    return std::any_of(t.uv.begin(), t.uv.end(), [&](const Vec2& uv) { return !inside(uv.x) || !inside(uv.y); });
  });
}

std::size_t MaterialSurface::texels() const {
  std::size_t sum = repeat ? repeat->count() : 0;
  for (const AtlasTile& tile : atlas.tiles) sum += tile.texels.count();
  return sum;
}

MaterialSurface lay_out(const Scene& scene, std::span<const Instance> all, std::uint32_t material,
                        const TextureReference* place, int size, int atlas_side, const SurfaceReading& reading,
                        const std::function<const SkyView&()>& sky) {
  MaterialSurface surface;
  surface.triangles = surface_of(scene, all, material, place);
  surface.mm_per_repeat = mm_per_repeat(surface.triangles);
  if (!(surface.mm_per_repeat > 0)) return surface;
  surface.repeat = one_repeat(surface.triangles, reading, size);
  if (!surface.repeat)
    surface.atlas = cut_surface(surface.triangles, size, atlas_side, reading, reading.sky ? &sky() : nullptr);
  else if (reading.sky)
    surface.sky = sky_texels(*surface.repeat, sky());
  return surface;
}

void add_own_surface(const Scene& scene, std::span<const Instance> all, std::uint32_t material, int size,
                     MaterialSurface& surface) {
  const Material& own = scene.materials[material];
  surface.own.emplace(scene, own, surface.mm_per_repeat);
  surface.keeps_relief = !surface.repeat && surface.atlas.texels_per_repeat < size && surface.own->has_relief() &&
                         keeps_coordinates(scene, all, surface.triangles, *own_place(own));
}

}  // namespace papilla
