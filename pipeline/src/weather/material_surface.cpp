// SPDX-License-Identifier: MIT
#include "weather/material_surface.hpp"

#include <algorithm>

#include "weather/sky_texels.hpp"

namespace papilla {
namespace {

/// Where the recipe reads nothing of the surface, or no texel is shown by two places: one repeat, or nothing.
std::optional<SurfaceTexels> one_repeat(std::span<const SurfaceTriangle> surface, const SurfaceReading& reading,
                                        int size) {
  SurfaceTexels texels(0, 0, size, size, true);
  for (const SurfaceTriangle& t : surface)
    if (draw(texels, t, size, reading) > 0) return std::nullopt;
  grow(texels, k_gutter);
  // What no surface shows is painted, too, and looks upwards.
  for (std::size_t at = 0; at < texels.count(); ++at)
    if (!texels.covered[at]) texels.covered[at] = 1, texels.normals[3 * at + 1] = 1;
  return texels;
}

}  // namespace

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

MaterialSurface lay_out(const Scene& scene, std::span<const Instance> all, std::uint32_t material, int size,
                        const SurfaceReading& reading, const std::function<const SkyView&()>& sky) {
  MaterialSurface surface;
  const Material& own = scene.materials[material];
  surface.triangles = surface_of(scene, all, material, own_place(own));
  surface.mm_per_repeat = mm_per_repeat(surface.triangles);
  if (!(surface.mm_per_repeat > 0)) return surface;
  surface.own.emplace(scene, own, surface.mm_per_repeat);
  surface.repeat = one_repeat(surface.triangles, reading, size);
  if (!surface.repeat)
    surface.atlas = cut_surface(surface.triangles, size, reading, reading.sky ? &sky() : nullptr);
  else if (reading.sky)
    surface.sky = sky_texels(*surface.repeat, sky());
  return surface;
}

}  // namespace papilla
