// SPDX-License-Identifier: MIT
#include "pipeline/felt_strokes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla::testing {

namespace fs = std::filesystem;

Materials demo_rules(const fs::path& data, const fs::path& folder) {
  fs::create_directories(folder / "grain");
  for (const std::string_view kind : grain_names())
    write_grey_image(folder / "grain" / (std::string(kind) + ".png"), synthesize_grain(grain_kind(kind)).picture, 8);
  fs::copy_file(data / "cockpit.materials.json", folder / "materials.json", fs::copy_options::overwrite_existing);
  return read_materials(folder / "materials.json");
}

Materials recipe_rules() {
  Materials rules;
  const RecipeLibrary library = RecipeLibrary::builtin();
  for (const auto& [name, recipe] : library.recipes()) {
    const bool felt = recipe.find("idtype=") != std::string::npos && recipe.find("idtype=ageing") == std::string::npos;
    if (!felt) continue;
    MaterialRule rule;
    rule.name = rule.recipe = name;
    rule.texture = "/nonexistent/" + name;
    rule.time = recipe.find("idtype=aged") != std::string::npos ? 0.5 : 0;
    rule.size_mm[0] = rule.size_mm[1] = 40;
    rules.materials.emplace(name, rule);
  }
  return rules;
}

FeltPlate felt_plate(const MaterialRule& rule, const DeviceCaps& device, const HapticSceneOptions& options) {
  constexpr double k_side_mm = 120;
  Part part;
  part.name = "plate";
  part.mesh.positions = {{0, 0, 0}, {k_side_mm, 0, 0}, {k_side_mm, k_side_mm, 0}, {0, k_side_mm, 0}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Scene scene = single_part_scene(std::move(part), "test");
  Materials rules;
  rules.materials = {{rule.name, rule}};
  AssignRule assign;
  assign.part = "*", assign.material = rule.name;
  rules.assign = {assign};
  BakeResult baked = bake_scene(std::move(scene), rules);
  HapticScene haptic = haptic_scene(baked.scene, ".", options);
  ContactSurface surface(haptic.mesh, haptic.materials, haptic.heights, haptic.probe_radius_m, haptic.channels);
  clamp_to_stable(surface, device.dynamics, 1e-3);
  return {std::move(baked), std::move(haptic), std::move(surface)};
}

StrokeForces stroke_forces(const ContactSurface& surface, const DeviceCaps& device, const Stroke& stroke,
                           double (*clock)()) {
  constexpr double k_period_s = 1e-3, k_least_n = 0.02, k_start_m = 0.025, k_above_m = 2e-3;
  constexpr int k_press_ticks = 250;
  const double period_s = k_period_s / stroke.substeps;
  const auto tick = std::make_unique<HapticTick>(surface, safety_limits(device.max_force_n), period_s);
  const double radius = surface.probe_radius_m();
  const Vec3 way{std::cos(stroke.angle), std::sin(stroke.angle), 0};
  const auto ticks = k_press_ticks + static_cast<int>(std::lround(stroke.way_m / stroke.speed_m_per_s / k_period_s));
  const auto probe_at = [&](double i) {
    const double pressed = std::min(1.0, i / k_press_ticks);
    const double gone = stroke.speed_m_per_s * k_period_s * std::max(0.0, i - k_press_ticks);
    return Vec3{k_start_m, k_start_m, radius + k_above_m - (k_above_m + stroke.depth_m) * pressed} + gone * way +
           stroke.shift;
  };
  StrokeForces result;
  int in_contact = 0;
  tick->reset(probe_at(0));
  for (int i = 0; i < ticks; ++i) {
    Vec3 probe, force;
    double sweeps = 0;
    const double start = clock ? clock() : 0;
    for (int k = 1; k <= stroke.substeps; ++k) {
      probe = probe_at(std::max(0.0, i - 1 + static_cast<double>(k) / stroke.substeps));
      force = (*tick)({probe});
      result.lost += tick->lost();
      sweeps += tick->proxy().sweeps;
    }
    if (clock) result.tick_s.push_back(clock() - start);
    result.sweeps.push_back(sweeps);
    const Vec3 behind = tick->proxy().proxy - probe;
    result.lag_m = std::max(result.lag_m, std::hypot(behind.x, behind.y));
    if (i > k_press_ticks && force.z > k_least_n)
      result.lateral_ratio = std::max(result.lateral_ratio, std::hypot(force.x, force.y) / force.z);
    in_contact = tick->proxy().in_contact ? in_contact + 1 : 0;
    if (in_contact > 2) result.largest_step_n = std::max(result.largest_step_n, norm(force - result.force_n.back()));
    result.force_n.push_back(force);
  }
  return result;
}

double relative_difference(const StrokeForces& a, const StrokeForces& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.force_n.size(); ++i) {
    const Vec3 d = a.force_n[i] - b.force_n[i];
    difference += dot(d, d);
    size += dot(a.force_n[i], a.force_n[i]);
  }
  return std::sqrt(difference / size);
}

Steadiness steadiness(const ContactSurface& surface, const DeviceCaps& device, Stroke stroke, int angles) {
  constexpr double k_micrometre = 1e-6, k_fan = 1.4;  // Radians: a right angle less the margin of the plate.
  Steadiness result;
  for (int i = 0; i < angles; ++i) {
    stroke.angle = k_fan * (i + 0.1) / angles;
    stroke.shift = {};
    const StrokeForces at = stroke_forces(surface, device, stroke);
    result.extremes.lag_m = std::max(result.extremes.lag_m, at.lag_m);
    result.extremes.lateral_ratio = std::max(result.extremes.lateral_ratio, at.lateral_ratio);
    result.extremes.largest_step_n = std::max(result.extremes.largest_step_n, at.largest_step_n);
    result.extremes.lost += at.lost;
    for (const Vec3 shift : {Vec3{k_micrometre, 0, 0}, Vec3{0, k_micrometre, 0}, Vec3{0, 0, k_micrometre}}) {
      stroke.shift = shift;
      const double difference = relative_difference(at, stroke_forces(surface, device, stroke));
      result.worst = std::max(result.worst, difference);
      result.mean += difference / (3 * angles);
    }
  }
  return result;
}

}  // namespace papilla::testing
