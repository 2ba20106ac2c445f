// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/shown_levels.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/pipeline/simplify_scene.hpp"

namespace papilla {
namespace {

/// Of the diagonal.
constexpr std::array k_tolerances = {1.0 / 2000, 4.0 / 2000, 16.0 / 2000, 64.0 / 2000};

/// Position and uv of a vertex, which a level leaves as they are.
using Place = std::array<float, 5>;

Vec3 vec3_at(const std::vector<float>& list, std::size_t i) { return {list[3 * i], list[3 * i + 1], list[3 * i + 2]}; }
Vec2 vec2_at(const std::vector<float>& list, std::size_t i) { return {list[2 * i], list[2 * i + 1]}; }

Place place_of(Vec3 position, Vec2 uv) {
  return {static_cast<float>(position.x), static_cast<float>(position.y), static_cast<float>(position.z),
          static_cast<float>(uv.x), static_cast<float>(uv.y)};
}

TriangleMesh mesh_of(const ShownMesh& shown) {
  TriangleMesh mesh;
  const std::size_t vertices = shown.positions.size() / 3;
  for (std::size_t i = 0; i < vertices; ++i) {
    mesh.positions.push_back(vec3_at(shown.positions, i));
    mesh.normals.values.push_back(vec3_at(shown.normals, i));
    mesh.uv.values.push_back(vec2_at(shown.uv, i));
  }
  for (std::size_t c = 0; c + 2 < shown.indices.size(); c += 3)
    mesh.triangles.push_back({shown.indices[c], shown.indices[c + 1], shown.indices[c + 2]});
  mesh.normals.indices = mesh.uv.indices = mesh.triangles;
  return mesh;
}

/// Finds the vertices of a ShownMesh again.
class Vertices {
 public:
  explicit Vertices(const ShownMesh& shown) : shown_(shown) {
    const std::size_t vertices = shown.positions.size() / 3;
    for (std::size_t i = 0; i < vertices; ++i)
      by_place_.emplace_back(place_of(vec3_at(shown.positions, i), vec2_at(shown.uv, i)),
                             static_cast<std::uint32_t>(i));
    std::sort(by_place_.begin(), by_place_.end());
  }

  std::uint32_t nearest(const Place& place, Vec3 normal) const {
    const auto less = [](const auto& entry, const Place& wanted) { return entry.first < wanted; };
    auto entry = std::lower_bound(by_place_.begin(), by_place_.end(), place, less);
    std::uint32_t best = entry->second;
    for (; entry != by_place_.end() && entry->first == place; ++entry)
      if (dot(vec3_at(shown_.normals, entry->second), normal) > dot(vec3_at(shown_.normals, best), normal))
        best = entry->second;
    return best;
  }

 private:
  const ShownMesh& shown_;
  std::vector<std::pair<Place, std::uint32_t>> by_place_;
};

}  // namespace

std::vector<ShownLevel> shown_levels(const ShownMesh& shown, const StageCache* cache,
                                     const ProgressCallback& progress) {
  const std::vector<TriangleMesh> whole = {mesh_of(shown)};
  const double diagonal = bounds_of(whole[0]).diagonal();
  if (whole[0].triangles.empty() || !(diagonal > 0)) return {};
  LevelOptions options;
  for (const double tolerance : k_tolerances) options.tolerances_mm.push_back(tolerance * diagonal);
  SimplifyOptions simplify;
  simplify.progress = progress;
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].mesh = whole[0];
  add_levels(scene, whole, options, simplify, 0, cache);
  const Vertices vertices(shown);
  std::vector<ShownLevel> levels;
  for (const auto& [mesh, coverage] : scene.parts[0].levels) {
    ShownLevel level{coverage, {}};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        level.indices.push_back(
            vertices.nearest(place_of(mesh.positions[mesh.triangles[t][k]], mesh.uv.values[mesh.uv.indices[t][k]]),
                             mesh.normals.values[mesh.normals.indices[t][k]]));
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace papilla
