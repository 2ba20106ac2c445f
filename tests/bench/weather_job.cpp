// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/weather_job.hpp"

#include <array>
#include <cmath>
#include <set>

#include "bench/bench_json.hpp"
#include "papilla/pipeline/weather_scene.hpp"

namespace papilla::bench {
namespace {

/// Turns about the vertical axis, tilts about x, and moves.
struct Placed {
  double turn, tilt, x;
};

/// Adds a box of six rectangles; `slant` lifts one edge of its top.
void add_box(TriangleMesh& mesh, const Placed& at, double slant) {
  const auto corner = [&](int i) {
    Vec3 p{i & 1 ? 300.0 : -300.0, i & 2 ? 300.0 : -300.0, i & 4 ? 600.0 : 0.0};
    if ((i & 5) == 5) p.z += slant;
    p = {p.x, std::cos(at.tilt) * p.y - std::sin(at.tilt) * p.z, std::sin(at.tilt) * p.y + std::cos(at.tilt) * p.z};
    return Vec3{std::cos(at.turn) * p.x - std::sin(at.turn) * p.y + at.x,
                std::sin(at.turn) * p.x + std::cos(at.turn) * p.y, p.z};
  };
  constexpr std::array<std::array<int, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}};
  for (const auto& side : sides) {
    const auto p = static_cast<Index>(mesh.positions.size());
    for (const int i : side) mesh.positions.push_back(corner(i));
    mesh.uv.values.insert(mesh.uv.values.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    for (const Triangle& t : {Triangle{p, p + 1, p + 2}, Triangle{p, p + 2, p + 3}}) {
      mesh.triangles.push_back(t);
      mesh.uv.indices.push_back(t);
    }
  }
}

int unlike_normals(const TriangleMesh& mesh) {
  std::set<std::array<long, 3>> normals;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 n = normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    normals.insert({std::lround(1e6 * n.x), std::lround(1e6 * n.y), std::lround(1e6 * n.z)});
  }
  return static_cast<int>(normals.size());
}

Scene two_materials() {
  Part c, b;
  for (int i = 0; i < 7; ++i) add_box(c.mesh, {0.2 * i, 0, 1000.0 * i}, i == 0 ? 80 : 0);
  add_box(c.mesh, {0.1, 0.5, 7000}, 0);
  add_box(b.mesh, {0, 0, 9000}, 0);
  c.name = "c", b.name = "b";
  c.materials = {0}, b.materials = {1};
  Scene scene = single_part_scene(std::move(c), "made");
  scene.parts.push_back(std::move(b));
  Node node;
  node.part = 1;
  scene.nodes.push_back(node), scene.roots.push_back(1);
  scene.materials.resize(2);
  scene.materials[0].name = "c", scene.materials[0].base_color = {0.2, 0.2, 0.25, 1};
  scene.materials[1].name = "b", scene.materials[1].base_color = {0.4, 0.2, 0.1, 1};
  return scene;
}

}  // namespace

WeatherJob run_weather_job(int size, bool sky) {
  const Scene scene = two_materials();
  WeatherConfig config;
  config.size = size;
  const std::string snow = sky ? "snow|scale=.3|fixtime=true|time=.84"
                               : "snow|scale=.3|fixtime=true|time=.84|alphafunction=smoothstep(.9-time,1.1-time,main)"
                                 "*clampunit(normaldot*4-.6)";
  config.layers = {{"rust_in|scale=.3|fixtime=true|time=.84", {"*"}}, {snow, {"*"}}};
  const double before = process_cpu_seconds();
  const WeatherResult result = weather_scene(scene, config, 1);
  WeatherJob job;
  job.cpu_seconds = process_cpu_seconds() - before;
  for (const Part& part : scene.parts) {
    job.faces += static_cast<int>(part.mesh.triangles.size());
    job.normals += unlike_normals(part.mesh);
  }
  job.maps = 2 * job.normals + static_cast<int>(scene.materials.size());
  for (const auto& material : result.materials) {
    job.charts += static_cast<int>(material.atlas.value().charts);
    job.tiles += static_cast<int>(material.atlas.value().tiles);
  }
  return job;
}

}  // namespace papilla::bench
