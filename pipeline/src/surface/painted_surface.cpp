// SPDX-License-Identifier: MIT
#include "surface/painted_surface.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "papilla/core/srgb.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla {
namespace {

constexpr unsigned bit(Channel c) { return 1U << static_cast<unsigned>(c); }
constexpr unsigned k_maps = bit(Channel::color) | bit(Channel::diffuse) | bit(Channel::alpha) | bit(Channel::bump) |
                            bit(Channel::reflection) | bit(Channel::roughness) | bit(Channel::friction) |
                            bit(Channel::stiffness) | bit(Channel::damping);

unsigned char byte_of(double value) {
  return static_cast<unsigned char>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

/// A colour that is stored, as bright as `diffuse` says; a metal has no diffuse part.
double with_diffuse(double stored, double diffuse, double metallic) {
  const double share = metallic + (1 - metallic) * std::clamp(diffuse, 0.0, 1.0);
  return share == 1 ? stored : srgb_from_linear(share * linear_from_srgb(stored));
}

/// The covered texels of a window as points.
struct WindowPoints {
  std::vector<double> x, y;
  std::vector<float> normals, positions, sky, flow, colours, heights, alphas, metallic, roughness;
  std::vector<std::uint32_t> place;

  WindowPoints(const PaintJob& job, const SurfaceTexels& texels, const std::vector<float>& sky_of_window,
               double scale) {
    for (std::size_t at = 0; at < texels.count(); ++at)
      if (texels.covered[at]) place.push_back(static_cast<std::uint32_t>(at));
    const std::size_t count = place.size();
    x.resize(count), y.resize(count);
    if (!job.reading.directions.empty()) normals.resize(3 * count);
    if (job.reading.position) positions.resize(3 * count);
    if (!sky_of_window.empty()) sky.resize(count);
    if (job.stains) flow.resize(count);
    if (job.own) colours.resize(3 * count), alphas.resize(count), metallic.resize(count), roughness.resize(count);
    if (job.own && job.own->has_relief()) heights.resize(count);
    oneapi::tbb::parallel_for(std::size_t{0}, (count + k_chunk - 1) / k_chunk, [&](std::size_t chunk) {
      for (std::size_t k = chunk * k_chunk; k < std::min(count, (chunk + 1) * k_chunk); ++k)
        fill(job, texels, sky_of_window, scale, k);
    });
  }

  TexturePoints points() const {
    return {x, y, normals, positions, sky, colours, heights, {}, alphas, metallic, roughness, flow};
  }

 private:
  static constexpr std::size_t k_chunk = 4096;

  void fill(const PaintJob& job, const SurfaceTexels& texels, const std::vector<float>& sky_of_window, double scale,
            std::size_t k) {
    const std::size_t at = place[k], width = static_cast<std::size_t>(texels.width);
    x[k] = (texels.left + static_cast<double>(at % width) + 0.5) / scale;
    y[k] = (texels.top + static_cast<double>(at / width) + 0.5) / scale;
    const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
      if (!to.empty())
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(3 * at), 3,
                    to.begin() + static_cast<std::ptrdiff_t>(3 * k));
    };
    copy(texels.normals, normals), copy(texels.positions, positions);
    if (!sky.empty()) sky[k] = sky_of_window[at];
    if (job.stains) flow[k] = static_cast<float>(flow_at(*job.stains, texels, at));
    if (!job.own) return;
    const std::array<float, 4> colour = job.own->colour_at(x[k], y[k]);
    std::copy_n(colour.begin(), 3, colours.begin() + static_cast<std::ptrdiff_t>(3 * k));
    alphas[k] = colour[3];
    const auto [rough, metal] = job.own->shine_at(x[k], y[k]);
    roughness[k] = rough, metallic[k] = metal;
    if (!heights.empty()) heights[k] = job.own->height_at(x[k], y[k]) / static_cast<float>(job.depth_mm);
  }
};

/// Stores the channels of point k as texel `at`, which `charts` charts show.
void store(const TextureValues& values, std::size_t k, std::size_t at, double charts, SurfacePicture& out,
           SurfaceRanges& ranges) {
  const auto value = [&](Channel c) { return static_cast<double>(values[c][k]); };
  const double metallic = std::clamp(value(Channel::reflection), 0.0, 1.0), alpha = value(Channel::alpha);
  for (std::size_t c = 0; c < 3; ++c)
    out.rgba[4 * at + c] = byte_of(
        with_diffuse(static_cast<double>(values[Channel::color][3 * k + c]), value(Channel::diffuse), metallic));
  out.rgba[4 * at + 3] = byte_of(alpha);
  out.shine[2 * at] = byte_of(value(Channel::roughness)), out.shine[2 * at + 1] = byte_of(metallic);
  out.bump[at] = values[Channel::bump][k], out.friction[at] = values[Channel::friction][k];
  out.stiffness[at] = values[Channel::stiffness][k], out.damping[at] = values[Channel::damping][k];
  ranges.friction.add(value(Channel::friction), charts), ranges.stiffness.add(value(Channel::stiffness), charts);
  ranges.damping.add(value(Channel::damping), charts), ranges.roughness.add(value(Channel::roughness), charts);
  ranges.metallic.add(metallic, charts), ranges.alpha.add(alpha, charts);
}

/// Evaluates the recipe at the covered texels of a window.
/// @param tiles  the window goes on round its borders. @param sky  of the window; empty when it is not read.
/// @param scale  texels a repeat. @param charts  how often the window is shown, for the means.
SurfacePicture paint(const PaintJob& job, bool tiles, const SurfaceTexels& texels, const std::vector<float>& sky,
                     double scale, double charts, SurfaceRanges& ranges) {
  const ProceduralTexture& texture = tiles ? job.tiling : job.texture;
  const WindowPoints window(job, texels, sky, scale);
  TexturePoints points = window.points();
  if (texture.depends_on_neighbours()) points.raster = {texels.width, texels.height, tiles, window.place};
  const TextureValues values = evaluate_texture(texture, points, k_maps, 1 / scale);
  SurfacePicture out(texels.width, texels.height, static_cast<float>(job.friction));
  for (std::size_t k = 0; k < window.place.size(); ++k) store(values, k, window.place[k], charts, out, ranges);
  return out;
}

template <class T>
std::size_t hash_of(const std::vector<T>& values) {
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

std::size_t hash_of(const SurfacePicture& tile) {
  std::size_t sum = 31 * hash_of(tile.rgba) + hash_of(tile.shine);
  for (const std::vector<float>* values : {&tile.bump, &tile.friction, &tile.stiffness, &tile.damping})
    sum = 31 * sum + hash_of(*values);
  return sum;
}

/// Tiles with the same bytes are one, wherever they are shown: found by a hash, and compared.
/// @returns the number of each tile among `distinct`.
std::vector<std::uint32_t> find_distinct(std::vector<SurfacePicture> painted, bool share_equal,
                                         std::vector<SurfacePicture>& distinct) {
  std::vector<std::uint32_t> number;
  std::unordered_multimap<std::size_t, std::uint32_t> known;
  for (SurfacePicture& p : painted) {
    const std::size_t hash = share_equal ? hash_of(p) : 0;
    const auto [first, last] = known.equal_range(hash);
    const auto same = std::find_if(first, last, [&](const auto& entry) { return distinct[entry.second] == p; });
    number.push_back(same != last ? same->second : static_cast<std::uint32_t>(distinct.size()));
    if (same != last) continue;
    if (share_equal) known.emplace(hash, number.back());
    distinct.push_back(std::move(p));
  }
  return number;
}

/// Copies a tile into the picture.
void copy_tile(const SurfacePicture& tile, std::pair<int, int> corner, SurfacePicture& picture) {
  for (int row = 0; row < tile.height; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(row) * tile.width;
    const auto to = static_cast<std::ptrdiff_t>(corner.second + row) * picture.width + corner.first;
    for (const auto channel :
         {&SurfacePicture::bump, &SurfacePicture::friction, &SurfacePicture::stiffness, &SurfacePicture::damping})
      std::copy_n((tile.*channel).begin() + from, tile.width, (picture.*channel).begin() + to);
    std::copy_n(tile.rgba.begin() + 4 * from, 4 * tile.width, picture.rgba.begin() + 4 * to);
    std::copy_n(tile.shine.begin() + 2 * from, 2 * tile.width, picture.shine.begin() + 2 * to);
  }
}

/// The coordinates of an atlas. @param number  of the place of each tile.
std::vector<NewUv> uv_of(const MaterialSurface& shown, const TilePlaces& places,
                         const std::vector<std::uint32_t>& number) {
  const SurfaceAtlas& atlas = shown.atlas;
  std::vector<NewUv> uv;
  for (std::size_t t = 0; t < shown.triangles.size(); ++t) {
    const SurfaceTriangle& triangle = shown.triangles[t];
    const AtlasChart& chart = atlas.charts[atlas.chart_of[t]];
    const auto [x, y] = places.corner[number[chart.tile]];
    NewUv fresh{triangle.instance, triangle.triangle, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at = atlas.texels_per_repeat * triangle.uv[k];
      fresh.uv[k] = {(at.x - chart.left + x) / places.width, 1 - (at.y - chart.top + y) / places.height};
    }
    uv.push_back(fresh);
  }
  return uv;
}

void paint_atlas(const MaterialSurface& shown, const PaintJob& job, PaintedSurface& out) {
  const SurfaceAtlas& atlas = shown.atlas;
  std::vector<SurfacePicture> painted, distinct;
  for (const AtlasTile& tile : atlas.tiles) {
    painted.push_back(paint(job, false, tile.texels, tile.sky, atlas.texels_per_repeat,
                            static_cast<double>(tile.charts), out.ranges));
    job.progress(static_cast<double>(painted.size()) / static_cast<double>(atlas.tiles.size()));
  }
  const std::vector<std::uint32_t> number = find_distinct(std::move(painted), job.share_equal, distinct);
  std::vector<std::pair<int, int>> sizes;
  for (const SurfacePicture& p : distinct) sizes.emplace_back(p.width, p.height);
  const TilePlaces places = place_tiles(sizes);
  out.picture = SurfacePicture(places.width, places.height, static_cast<float>(job.friction));
  for (std::size_t k = 0; k < distinct.size(); ++k) copy_tile(distinct[k], places.corner[k], out.picture);
  out.uv = uv_of(shown, places, number);
  out.distinct_tiles = distinct.size();
}

}  // namespace

SurfacePicture::SurfacePicture(int width_px, int height_px, float friction_between)
    : width(width_px),
      height(height_px),
      rgba(4 * texels(), 128),
      shine(2 * texels(), 0),
      bump(texels(), 0.5F),
      friction(texels(), friction_between),
      stiffness(texels(), 1),
      damping(texels(), 1) {
  for (std::size_t i = 0; i < texels(); ++i) rgba[4 * i + 3] = 255, shine[2 * i] = 255;
}

void ChannelRange::add(double value, double times) {
  sum += times * value, weight += times;
  low = std::min(low, value), high = std::max(high, value);
}

PaintedSurface paint_surface(const MaterialSurface& shown, const PaintJob& job) {
  PaintedSurface out;
  out.repeats = shown.repeat.has_value();
  out.texels_per_repeat = shown.repeat ? shown.repeat->width : shown.atlas.texels_per_repeat;
  if (shown.repeat)
    out.picture = paint(job, shown.leaves_the_repeat(), *shown.repeat, shown.sky, out.texels_per_repeat, 1, out.ranges);
  else
    paint_atlas(shown, job, out);
  return out;
}

std::vector<NewUv> uv_of_own_tiles(const MaterialSurface& shown) {
  if (!shown.repeat) {
    std::vector<std::pair<int, int>> sizes;
    for (const AtlasTile& tile : shown.atlas.tiles) sizes.emplace_back(tile.texels.width, tile.texels.height);
    std::vector<std::uint32_t> number(sizes.size());
    std::iota(number.begin(), number.end(), 0U);
    return uv_of(shown, place_tiles(sizes), number);
  }
  std::vector<NewUv> uv;
  for (const SurfaceTriangle& t : shown.triangles) {
    NewUv fresh{t.instance, t.triangle, t.uv};
    for (Vec2& at : fresh.uv) at.y = 1 - at.y;
    uv.push_back(fresh);
  }
  return uv;
}

unsigned painted_channels() noexcept { return k_maps; }

PaintedSurface painted_repeat(const RenderedTexture& rendered) {
  PaintedSurface out;
  out.repeats = true, out.texels_per_repeat = rendered.width;
  out.picture = SurfacePicture(rendered.width, rendered.height, 0);
  for (std::size_t i = 0; i < out.picture.texels(); ++i) store(rendered.values, i, i, 1, out.picture, out.ranges);
  return out;
}

Shine shine_of(const PaintedSurface& surface, std::optional<double> roughness, std::optional<double> metallic) {
  const SurfaceRanges& ranges = surface.ranges;
  if (!roughness && ranges.roughness.is_constant()) roughness = ranges.roughness.mean();
  if (!metallic && ranges.metallic.is_constant()) metallic = ranges.metallic.mean();
  Shine shine{{}, roughness.value_or(1), metallic.value_or(1)};
  if (roughness && metallic) return shine;
  const SurfacePicture& picture = surface.picture;
  ColorImage& image = shine.picture.emplace(
      ColorImage{picture.width, picture.height, Values<unsigned char>(3 * picture.texels(), 255)});
  for (std::size_t i = 0; i < picture.texels(); ++i) {
    if (!roughness) image.pixels[3 * i + 1] = picture.shine[2 * i];
    if (!metallic) image.pixels[3 * i + 2] = picture.shine[2 * i + 1];
  }
  return shine;
}

ColorImage color_of(const SurfacePicture& picture) {
  ColorImage image{picture.width, picture.height, Values<unsigned char>(3 * picture.texels())};
  for (std::size_t i = 0; i < picture.texels(); ++i)
    std::copy_n(picture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 3,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return image;
}

std::vector<unsigned char> with_alpha(const ColorImage& image) {
  std::vector<unsigned char> rgba(image.pixels.size() / 3 * 4, 255);
  for (std::size_t i = 0; 3 * i < image.pixels.size(); ++i)
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
  return rgba;
}

std::vector<std::byte> encode_color(const PaintedSurface& surface) {
  const SurfacePicture& picture = surface.picture;
  if (surface.ranges.alpha.is_constant()) return encode_png(color_of(picture));
  return encode_png(RgbaImage{picture.width, picture.height, {picture.rgba.begin(), picture.rgba.end()}});
}

SurfaceReading reading_of(const ProceduralTexture& texture) {
  return {texture.dirt_directions(), texture.depends_on_position() || texture.depends_on_flow(),
          texture.depends_on_sky()};
}

}  // namespace papilla
