// SPDX-License-Identifier: MIT
#include "surface/surface_texels.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <algorithm>
#include <cmath>

#include "papilla/core/units.hpp"
#include "papilla/io/vertex_normals.hpp"
#include "placed_meshes.hpp"

namespace papilla {
namespace {

constexpr double k_alike = 1e-3;

/// Directions turn with the points; shear and unlike scales are not undone.
Vec3 turned(const Transform& t, Vec3 n) { return transform_point(t, n) - transform_point(t, {0, 0, 0}); }

struct Known {
  std::array<float, 3> normal, position;
};

Known known_at(const SurfaceTriangle& t, const std::array<double, 3>& share) {
  Vec3 n{0, 0, 0}, p{0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) n = n + share[k] * t.normal[k], p = p + share[k] * t.position[k];
  n = normalized(n);
  return {{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)},
          {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}};
}

bool look_alike(const SurfaceTexels& texels, std::size_t at, const Known& known, const SurfaceReading& reading) {
  for (const auto& direction : reading.directions) {
    double difference = 0;
    for (std::size_t k = 0; k < 3; ++k)
      difference += direction[k] * static_cast<double>(texels.normals[3 * at + k] - known.normal[k]);
    if (std::abs(difference) > k_alike) return false;
  }
  for (std::size_t k = 0; k < 3 && (reading.position || reading.sky); ++k)
    if (std::abs(texels.positions[3 * at + k] - known.position[k]) > static_cast<float>(k_alike)) return false;
  return true;
}

void copy_texel(SurfaceTexels& texels, std::size_t from, std::size_t to) {
  for (std::size_t k = 0; k < 3; ++k) {
    texels.normals[3 * to + k] = texels.normals[3 * from + k];
    texels.positions[3 * to + k] = texels.positions[3 * from + k];
  }
  texels.covered[to] = 1;
}

/// Shares of the corners along a row of texels, linear in x.
struct Shares {
  std::array<double, 3> first, step;  ///< At x = 0.5, and per texel.
  std::array<double, 3> at(int x) const {
    return {first[0] + step[0] * x, first[1] + step[1] * x, first[2] + step[2] * x};
  }
  /// The part of [left, right] that may have no share below 0, a texel wider on either side.
  std::pair<int, int> inside(int left, int right) const {
    double low = left, high = right;
    for (std::size_t k = 0; k < 3; ++k) {
      if (step[k] > 0) low = std::max(low, -first[k] / step[k] - 1);
      if (step[k] < 0) high = std::min(high, -first[k] / step[k] + 1);
    }
    return low <= high ? std::pair{static_cast<int>(low), static_cast<int>(high)} : std::pair{0, -1};
  }
};

Shares shares_of(const std::array<Vec2, 3>& p, double area, int y) {
  const Vec2 q{0.5, y + 0.5}, u = p[1] - p[0], v = p[2] - p[0];
  const double b = cross(q - p[0], v) / area, c = cross(u, q - p[0]) / area, db = v.y / area, dc = -u.y / area;
  return {{1 - b - c, b, c}, {-db - dc, db, dc}};
}

}  // namespace

SurfaceTexels::SurfaceTexels(int left_, int top_, int width_, int height_, bool repeats_)
    : left(left_),
      top(top_),
      width(width_),
      height(height_),
      repeats(repeats_),
      covered(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0),
      normals(3 * covered.size(), 0),
      positions(3 * covered.size(), 0) {}

std::size_t SurfaceTexels::at(int x, int y) const {
  x -= left, y -= top;
  if (repeats) x = (x % width + width) % width, y = (y % height + height) % height;
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

std::vector<SurfaceTriangle> surface_of(const Scene& scene, std::span<const Instance> all, std::uint32_t material,
                                        const TextureReference* colour) {
  std::vector<SurfaceTriangle> surface;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Part& part = scene.parts[all[i].part];
    const TriangleMesh& mesh = part.mesh;
    const CornerAttribute<Vec2>& uv = colour && colour->tex_coord == 1 ? mesh.uv1 : mesh.uv;
    if (uv.empty() || std::find(part.materials.begin(), part.materials.end(), material) == part.materials.end())
      continue;
    const Transform world = multiply(to_y_up(scene.up), all[i].world);
    const CornerAttribute<Vec3> normals = mesh.normals.empty() ? vertex_normals(mesh) : mesh.normals;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t slot = mesh.material.empty() ? 0 : mesh.material[t];
      if (slot >= part.materials.size() || part.materials[slot] != material || !uv.has_value(t)) continue;
      SurfaceTriangle s;
      s.instance = i, s.triangle = t, s.uv_index = uv.indices[t], s.position_index = mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        Vec2 place = uv.values[s.uv_index[k]];
        if (colour && colour->transform) place = transform_uv(*colour->transform, place);
        s.uv[k] = {place.x, 1 - place.y};
        s.position[k] = k_metres_per_mm * transform_point(world, mesh.corner(t, static_cast<int>(k)));
        s.normal[k] = turned(world, normals.has_value(t) ? normals.values[normals.indices[t][k]] : Vec3{0, 0, 1});
      }
      surface.push_back(s);
    }
  }
  return surface;
}

double mm_per_repeat(std::span<const SurfaceTriangle> surface) {
  double area_m2 = 0, area_uv = 0;
  for (const SurfaceTriangle& t : surface) {
    area_m2 += norm(cross(t.position[1] - t.position[0], t.position[2] - t.position[0]));
    area_uv += std::abs(cross(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]));
  }
  const double ratio = area_uv > 0 ? std::sqrt(area_m2 / area_uv) * k_mm_per_metre : 0;
  return std::isfinite(ratio) ? ratio : 0;
}

std::size_t draw(SurfaceTexels& texels, const SurfaceTriangle& triangle, double texels_per_repeat,
                 const SurfaceReading& reading) {
  std::array<Vec2, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = texels_per_repeat * triangle.uv[k];
  const double area = cross(p[1] - p[0], p[2] - p[0]);
  if (!(std::abs(area) > 1e-12) || !std::isfinite(area)) return 0;
  const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
  // A repeating window has met every texel after two of its widths.
  const auto first = [](double v) { return static_cast<int>(std::floor(std::clamp(v, -1e8, 1e8))); };
  const auto range = [&](double low, double high, int start, int size) {
    if (texels.repeats) return std::pair{first(low), std::min(first(high), first(low) + 2 * size)};
    return std::pair{std::max(first(low), start), std::min(first(high), start + size - 1)};
  };
  const auto [left, right] = range(x0, x1, texels.left, texels.width);
  const auto [top, bottom] = range(y0, y1, texels.top, texels.height);
  std::size_t unlike = 0;
  for (int y = top; y <= bottom; ++y) {
    const Shares row = shares_of(p, area, y);
    const auto [begin, end] = row.inside(left, right);
    for (int x = begin; x <= end; ++x) {
      const std::array<double, 3> share = row.at(x);
      const double least = std::min({share[0], share[1], share[2]});
      if (least < -1e-9) continue;
      const std::size_t at = texels.at(x, y);
      const bool taken = texels.covered[at] != 0;
      if (taken && least < 1e-6) continue;
      const Known known = known_at(triangle, share);
      if (taken) {
        unlike += !look_alike(texels, at, known, reading);
        continue;
      }
      texels.covered[at] = 1;
      std::copy_n(known.normal.begin(), 3, texels.normals.begin() + static_cast<std::ptrdiff_t>(3 * at));
      std::copy_n(known.position.begin(), 3, texels.positions.begin() + static_cast<std::ptrdiff_t>(3 * at));
    }
  }
  return unlike;
}

void grow(SurfaceTexels& texels, int rings) {
  constexpr std::array<std::array<int, 2>, 4> neighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<unsigned char> before = texels.covered;
    for (int y = 0; y < texels.height; ++y)
      for (int x = 0; x < texels.width; ++x) {
        const std::size_t at = texels.at(texels.left + x, texels.top + y);
        if (before[at]) continue;
        for (const auto& [dx, dy] : neighbours) {
          const bool inside = x + dx >= 0 && x + dx < texels.width && y + dy >= 0 && y + dy < texels.height;
          if (!inside && !texels.repeats) continue;
          const std::size_t from = texels.at(texels.left + x + dx, texels.top + y + dy);
          if (!before[from]) continue;
          copy_texel(texels, from, at);
          break;
        }
      }
  }
}

namespace {

constexpr int k_block = 8;

/// The covered texel of a block that is nearest to its middle, or -1.
std::ptrdiff_t middle_of(const SurfaceTexels& texels, int column, int row) {
  std::ptrdiff_t best = -1;
  double least = 1e30;
  for (int y = row * k_block; y < std::min((row + 1) * k_block, texels.height); ++y)
    for (int x = column * k_block; x < std::min((column + 1) * k_block, texels.width); ++x) {
      const std::size_t at = texels.at(texels.left + x, texels.top + y);
      const double dx = x + 0.5 - (column + 0.5) * k_block, dy = y + 0.5 - (row + 0.5) * k_block;
      if (!texels.covered[at] || dx * dx + dy * dy >= least) continue;
      least = dx * dx + dy * dy;
      best = static_cast<std::ptrdiff_t>(at);
    }
  return best;
}

Vec3 vector_at(const std::vector<float>& values, std::ptrdiff_t at) {
  const auto k = static_cast<std::size_t>(3 * at);
  return {static_cast<double>(values[k]), static_cast<double>(values[k + 1]), static_cast<double>(values[k + 2])};
}

}  // namespace

SkyView sky_of(const Scene& scene, std::span<const Instance> all, int rays) {
  std::vector<PlacedMesh> parts = placed_meshes(scene, all, to_y_up(scene.up));
  for (PlacedMesh& part : parts) part.opaque = true;  // Glass keeps snow and dust off as well.
  SkyOptions options;
  options.rays = static_cast<std::uint32_t>(rays);
  return SkyView(parts, options);
}

StainField stains_of(const Scene& scene, std::span<const Instance> all) {
  std::vector<PlacedMesh> parts = placed_meshes(scene, all, to_y_up(scene.up));
  for (PlacedMesh& part : parts) part.opaque = true;
  return StainField(parts);
}

double flow_at(const StainField& stains, const SurfaceTexels& texels, std::size_t at) {
  return stains(k_mm_per_metre * vector_at(texels.positions, at), vector_at(texels.normals, at));
}

std::vector<float> sky_texels(const SurfaceTexels& texels, const SkyView& sky) {
  const int columns = (texels.width + k_block - 1) / k_block, rows = (texels.height + k_block - 1) / k_block;
  std::vector<float> blocks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), -1);
  const auto block = [&](int column, int row) -> float& {
    return blocks[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  };
  oneapi::tbb::parallel_for(0, rows, [&](int row) {
    for (int column = 0; column < columns; ++column)
      if (const std::ptrdiff_t at = middle_of(texels, column, row); at >= 0)
        block(column, row) =
            static_cast<float>(sky(k_mm_per_metre * vector_at(texels.positions, at), vector_at(texels.normals, at)));
  });
  std::vector<float> out(texels.count(), 0);
  oneapi::tbb::parallel_for(0, texels.height, [&](int y) {
    const double v = (y + 0.5) / k_block - 0.5;
    for (int x = 0; x < texels.width; ++x) {
      const std::size_t at = texels.at(texels.left + x, texels.top + y);
      if (!texels.covered[at]) continue;
      const double u = (x + 0.5) / k_block - 0.5;
      double sum = 0, weight = 0;
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const int column = static_cast<int>(std::floor(u)) + i, row = static_cast<int>(std::floor(v)) + j;
          if (column < 0 || row < 0 || column >= columns || row >= rows || block(column, row) < 0) continue;
          const double share = (1 - std::abs(u - column)) * (1 - std::abs(v - row));
          sum += share * static_cast<double>(block(column, row));
          weight += share;
        }
      out[at] = static_cast<float>(sum / weight);
    }
  });
  return out;
}

}  // namespace papilla
