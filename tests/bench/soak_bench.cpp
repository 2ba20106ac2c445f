// SPDX-License-Identifier: MIT
// Four simulated hours of contact: random hands on the sample cockpit and on twenty other meshes.
#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <mutex>
#include <numbers>

#include "bench/bench_json.hpp"
#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/roughness_field.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/io/scene_file.hpp"
#include "pipeline/felt_strokes.hpp"
#include "soak_hand.hpp"
#include "support/formula_meshes.hpp"
#include "support/solid_meshes.hpp"

namespace {

using namespace papilla;
namespace fs = std::filesystem;

constexpr double k_cockpit_s = 7200, k_mesh_s = 360, k_quick_s = 3;
constexpr double k_largest_m = 0.3;  // A mesh is scaled to fit into a hand's reach.

/// What hands can meet: triangles with their materials.
struct Held {
  std::string name;
  std::function<ContactSurface()> make;
};

/// Two coordinates of each triangle, by its largest normal component, in repeats of 40 mm.
void project_uv(ContactMesh& mesh) {
  constexpr double k_repeat_m = 0.04;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]], n = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    for (const std::uint32_t v : t) {
      const Vec3 p = (1 / k_repeat_m) * mesh.positions[v];
      mesh.corner_uv.push_back(x >= y && x >= z ? Vec2{p.y, p.z} : y >= z ? Vec2{p.z, p.x} : Vec2{p.x, p.y});
    }
  }
}

/// A smooth, hard material, or a rough one with friction: every second mesh has a relief.
ContactSurface held_surface(ContactMesh mesh, std::size_t number) {
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double scale = k_largest_m / norm(high - low);
  for (Vec3& p : mesh.positions) p = scale * (p - low);
  mesh.corner_uv.clear();
  mesh.corner_normals.clear();
  mesh.material.clear();
  ContactMaterial material;
  material.stiffness = 500 + 250 * static_cast<double>(number % 7);
  material.damping = 0.2 * static_cast<double>(number % 3);
  material.static_friction = 0.15 * static_cast<double>(number % 6);
  material.dynamic_friction = 0.8 * material.static_friction;
  if (number % 5 == 4) material.friction = FrictionModel::bristle;
  std::vector<HeightField> heights;
  if (number % 2 == 1) {
    project_uv(mesh);
    const Vec2 repeat{0.04, 0.04};
    heights.push_back(roughness_field({2.3, 4e-5, {4e-4, 1e-2}}, repeat, number)
                          .rounded(k_felt_depth_m - k_default_probe_radius_m, repeat)
                          .dilated(k_default_probe_radius_m, repeat));
    material.height = 0;
  }
  return {mesh, {material}, std::move(heights), k_default_probe_radius_m};
}

ContactMesh contact_mesh(const TriangleMesh& mesh) {
  ContactMesh result;
  result.positions.assign(mesh.positions.begin(), mesh.positions.end());
  for (const Triangle& t : mesh.triangles) result.triangles.push_back({t[0], t[1], t[2]});
  return result;
}

/// Spheres, sheets, tubes, slivers, sharp edges, thin walls, roughness.
std::vector<std::pair<std::string, std::function<ContactMesh()>>> generated_meshes() {
  using test::grid_mesh;
  const auto spiky = [](Vec3 d) { return 100 + 12 * std::sin(9 * d.x) * std::sin(8 * d.y) * std::sin(7 * d.z); };
  return {
      {"sphere", [] { return testing::sphere(60, 0.1); }},
      {"rough relief", [] { return testing::height_grid(150, 150, 0.2, 0.2, testing::rough_relief); }},
      {"box",
       [] {
         return testing::box({0, 0, 0}, {0.1, 0.06, 0.03});
       }},
      {"thin plate",
       [] {
         return testing::box({0, 0, 0}, {0.2, 0.1, 0.002});
       }},
      {"slivers of 0.02 x 10 mm", [] { return testing::plate(5000, 10, 0.1, 0.1); }},
      {"dashboard", [] { return contact_mesh(test::dashboard_mesh(60, 40)); }},
      {"grab handle", [] { return contact_mesh(grid_mesh(60, 24, test::grab_handle)); }},
      {"helical ramp", [] { return contact_mesh(grid_mesh(120, 12, test::helical_ramp)); }},
      {"open cylinder", [] { return contact_mesh(grid_mesh(60, 30, test::open_cylinder)); }},
      {"hemisphere", [] { return contact_mesh(test::hemisphere_mesh(30, 60)); }},
      {"bumpy ball", [spiky] { return contact_mesh(test::sphere_mesh(60, 120, std::numbers::pi, spiky)); }},
      {"panel", [] { return contact_mesh(test::panel_mesh(50, 30)); }},
      {"capped cylinder", [] { return contact_mesh(test::capped_cylinder_mesh(80)); }},
      {"torus", [] { return contact_mesh(test::torus_mesh(80, 40)); }},
      {"coarse sphere", [] { return testing::sphere(8, 0.1); }},
      {"saddle",
       [] {
         return testing::height_grid(60, 60, 0.2, 0.2, [](double x, double y) { return 4 * (x - 0.1) * (y - 0.1); });
       }},
      {"steps",
       [] {
         return testing::height_grid(200, 4, 0.2, 0.2, [](double x, double) { return 2e-3 * std::floor(x / 0.02); });
       }},
      {"sharp ridge",
       [] {
         return testing::height_grid(80, 80, 0.2, 0.2,
                                     [](double x, double y) { return -std::abs(x - 0.1) + 0.2 * std::abs(y - 0.1); });
       }},
      {"crumpled sheet",
       [] {
         return contact_mesh(grid_mesh(
             80, 80,
             [](double s, double t) {
               return Vec3{200 * s, 200 * t, 5 * std::sin(25 * s + 3 * std::sin(19 * t))};
             },
             0.3));
       }},
      {"dense sphere", [] { return testing::sphere(300, 0.1); }},
  };
}

std::vector<Held> held_meshes() {
  std::vector<Held> held;
  for (const auto& [name, make] : generated_meshes()) {
    const std::size_t number = held.size();
    held.push_back({name, [make = make, number] { return held_surface(make(), number); }});
  }
  return held;
}

/// The sample cockpit, baked with the materials of the demo.
HapticScene cockpit() {
  const fs::path folder = fs::temp_directory_path() / fmt::format("papilla-soak-{}", ::getpid());
  const Materials rules = testing::demo_rules(PAPILLA_DATA, folder);
  const BakeResult baked = bake_scene(read_scene(fs::path(PAPILLA_DATA) / "cockpit.step"), rules);
  fs::remove_all(folder);
  return haptic_scene(baked.scene, ".");
}

struct Result {
  std::string name;
  std::size_t triangles = 0;
  bench::SoakRun run;
};

/// One device after the other, a hand each; the hands of all devices together last `seconds`.
Result soak_all(const std::string& name, const ContactSurface& as_made, double seconds, std::uint64_t seed,
                const std::function<ContactSurface()>& make) {
  const auto presets = device_presets();
  Result result{name, as_made.triangles(), {}};
  std::mutex sum;
  oneapi::tbb::parallel_for(std::size_t{0}, presets.size(), [&](std::size_t i) {
    ContactSurface surface = make();
    clamp_to_stable(surface, presets[i].caps().dynamics, 1e-3);
    clamp_amplitudes(surface, presets[i].caps().max_force_n);
    const bench::SoakRun run =
        bench::soak(surface, presets[i], seed * presets.size() + i, seconds / static_cast<double>(presets.size()));
    const std::lock_guard lock(sum);
    result.run.add(run);
  });
  const bench::SoakRun& run = result.run;
  fmt::print(stderr,
             "{}: {} ticks, {} in contact, {} lost, {} episodes, least kept {:.3g} J ({:.3g} of what was put in)\n",
             name, run.ticks, run.contact_ticks, run.lost, run.episodes, run.least_kept_j, run.least_kept_share);
  return result;
}

void add_results(bench::BenchReport& report, const std::vector<Result>& results) {
  bench::EvidenceTable table{
      "Surfaces",
      "A seventh of the time on each device. Force: the largest over the device's. Step: the largest change of the "
      "force "
      "in a tick while a contact goes on, over 2 % of the device's force or the change of the spring by the hand's own "
      "way. Energy: work of the hand on the device while in contact, and the least share of it that device and wall "
      "kept "
      "of an episode from one free flight to the next; below zero they would have fed the hand.",
      {"surface", "triangles", "ticks", "in contact", "lost", "force", "step", "put in [J]", "given back [J]",
       "episodes", "least kept [µJ]", "least kept share"},
      {}};
  bench::SoakRun all;
  for (const Result& r : results) {
    all.add(r.run);
    table.rows.push_back({r.name, std::to_string(r.triangles), std::to_string(r.run.ticks),
                          std::to_string(r.run.contact_ticks), std::to_string(r.run.lost),
                          fmt::format("{:.3f}", r.run.largest_share), fmt::format("{:.3f}", r.run.longest_step),
                          fmt::format("{:.3g}", r.run.put_in_j), fmt::format("{:.3g}", r.run.returned_j),
                          std::to_string(r.run.episodes), fmt::format("{:.3g}", 1e6 * r.run.least_kept_j),
                          fmt::format("{:.4f}", r.run.least_kept_share)});
  }
  const auto none = [&](const char* promise, std::uint64_t count, const std::string& detail) {
    report.target({promise, fmt::format("{} of {} ticks{}", count, all.ticks, detail), count == 0});
  };
  none("no contact lost", all.lost, fmt::format(", {} in contact", all.contact_ticks));
  none("no force or position that is not finite", all.not_finite, "");
  none("no force above the device's largest", all.too_strong, fmt::format(", largest share {:.6f}", all.largest_share));
  none("no step above 2 % of it a millisecond while a contact goes on, beyond the spring's own", all.too_steep,
       fmt::format(", largest {:.6f} of what is allowed", all.longest_step));
  none("no fault", all.faults, "");
  report.target({"passive: no episode gives back more than the hand put in (tolerance 1 µJ)",
                 fmt::format("{} of {} episodes; least kept {:.3g} µJ and {:.4f} of what was put in; {:.3g} J put in, "
                             "{:.3g} J given back while in contact",
                             all.active_episodes, all.episodes, 1e6 * all.least_kept_j, all.least_kept_share,
                             all.put_in_j, all.returned_j),
                 all.active_episodes == 0});
  report.table(std::move(table));
}

void body(bench::BenchReport& report) {
  const bool quick = report.options().quick;
  const std::vector<Held> held = held_meshes();
  std::vector<Result> results;
  {
    const HapticScene scene = cockpit();
    const auto make = [&] {
      return ContactSurface(scene.mesh, scene.materials, scene.heights, scene.probe_radius_m, scene.channels);
    };
    results.push_back(soak_all("cockpit, materials of the demo", make(), quick ? k_quick_s : k_cockpit_s, 1000, make));
  }
  for (std::size_t i = 0; i < held.size(); ++i)
    results.push_back(soak_all(held[i].name, held[i].make(), quick ? k_quick_s : k_mesh_s, i, held[i].make));
  report.measure();
  add_results(report, results);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("soak", "Four hours of contact", argc, argv, body); }
