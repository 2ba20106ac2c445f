// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/surfaces.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"

namespace papilla::app {
namespace {

/// A uv is taken as usable when at most this share of the surface's area has no, a degenerate or a mirrored image:
/// a few bad triangles are hidden by grain, more of them are not.
constexpr double k_bad_uv_share = 0.02;
/// Below this σ2/σ1 of the area-weighted mean Jacobian, grain would look smeared: the uv served another purpose.
constexpr double k_worst_mean_stretch = 0.2;

struct UvJudgement {
  UvState state = UvState::absent;
  double mm_per_unit = 0;
  std::string note;
};

UvJudgement judge_uv(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  const bool any =
      std::any_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) { return mesh.uv.has_value(t); });
  if (!any) return {UvState::absent, 0, "no uv"};
  double area_3d = 0, area_uv = 0, positive = 0, negative = 0, bad = 0, stretched = 0;
  for (const std::uint32_t t : triangles) {
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1) - a, c = mesh.corner(t, 2) - a;
    const double area = 0.5 * norm(cross(b, c));
    if (!(area > 0)) continue;
    area_3d += area;
    if (!mesh.uv.has_value(t)) {
      bad += area;
      continue;
    }
    const Triangle& corners = mesh.uv.indices[t];
    const Vec2 u = mesh.uv.values[corners[0]], v = mesh.uv.values[corners[1]] - u, w = mesh.uv.values[corners[2]] - u;
    const double doubled = cross(v, w);
    if (!std::isfinite(doubled) || doubled == 0) {
      bad += area;
      continue;
    }
    (doubled > 0 ? positive : negative) += area;
    area_uv += 0.5 * std::abs(doubled);
    // Singular values of the 3D -> uv map from its first fundamental form.
    const double length = norm(b);
    const double x = dot(b, c) / length, y = 2 * area / length;
    const Vec2 du = (1 / length) * v, dv = (1 / y) * (w - x * du);
    const double trace = dot(du, du) + dot(dv, dv), det = std::abs(cross(du, dv));
    const double root = std::sqrt(std::max(0.0, 0.25 * trace * trace - det * det));
    const double largest = 0.5 * trace + root;
    if (largest > 0 && det / largest < k_worst_mean_stretch) stretched += area;
  }
  if (!(area_3d > 0)) return {UvState::unusable, 0, "the surface has no area"};
  bad += std::min(positive, negative);
  if (area_uv <= 0) return {UvState::unusable, 0, "its uv has no area"};
  const double mm_per_unit = std::sqrt((area_3d - bad > 0 ? area_3d - bad : area_3d) / area_uv);
  if (bad > k_bad_uv_share * area_3d)
    return {UvState::unusable, mm_per_unit,
            fmt::format("{:.0f} % of its area has no, a degenerate or a mirrored uv", 100 * bad / area_3d)};
  if (stretched > 0.5 * area_3d)
    return {UvState::unusable, mm_per_unit,
            fmt::format("{:.0f} % of its area is stretched by more than 5:1 in its uv", 100 * stretched / area_3d)};
  return {UvState::usable, mm_per_unit, fmt::format("{:.4g} mm per unit of its uv", mm_per_unit)};
}

std::vector<Surface> split_by_slot(const Scene& scene) {
  std::vector<Surface> surfaces;
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    const Part& part = scene.parts[p];
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_slot;
    for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t)
      by_slot[part.mesh.material.empty() ? 0 : part.mesh.material[t]].push_back(t);
    for (auto& [slot, triangles] : by_slot) {
      Surface surface;
      surface.part = p;
      surface.slot = slot;
      surface.triangles = std::move(triangles);
      surface.label = part.name;
      if (by_slot.size() > 1)
        surface.label +=
            "/" + (slot < part.materials.size() ? scene.materials[part.materials[slot]].name : std::to_string(slot));
      surfaces.push_back(std::move(surface));
    }
  }
  return surfaces;
}

}  // namespace

std::string hex_colour(const std::array<double, 4>& linear) {
  const auto byte = [](double c) { return static_cast<int>(std::lround(255 * srgb_from_linear(c))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(linear[0]), byte(linear[1]), byte(linear[2]));
}

std::array<double, 4> linear_colour(const std::string& hex) {
  if (hex.size() != 7 || hex[0] != '#') throw InvalidInput("linear_colour: '" + hex + "' is no colour such as #20a0ff");
  const auto channel = [&](std::size_t at) {
    return linear_from_srgb(std::stoi(hex.substr(at, 2), nullptr, 16) / 255.0);
  };
  return {channel(1), channel(3), channel(5), 1};
}

const MaterialRule* assigned_rule(const Scene& scene, const Part& part, std::size_t slot, const MaterialsFile& rules) {
  const Material* material = slot < part.materials.size() ? &scene.materials[part.materials[slot]] : nullptr;
  const AssignRule* assigned =
      match_rule(rules, part.name, material ? hex_colour(material->base_color) : "", material ? material->name : "");
  return assigned && !assigned->material.empty() ? &rules.materials.at(assigned->material) : nullptr;
}

std::vector<SharedPart> share_identical_parts(Scene& scene, const MaterialsFile& rules) {
  std::map<std::vector<const MaterialRule*>, std::uint64_t> numbers;
  return share_identical_parts(scene, [&](std::uint32_t number) {
    const Part& part = scene.parts[number];
    std::vector<const MaterialRule*> assigned;
    for (std::size_t slot = 0; slot < std::max<std::size_t>(part.materials.size(), 1); ++slot)
      assigned.push_back(assigned_rule(scene, part, slot, rules));
    return numbers.try_emplace(assigned, numbers.size()).first->second;
  });
}

std::vector<Surface> plan_surfaces(const Scene& scene, const MaterialsFile& rules,
                                   const std::vector<PartPerception>& perception) {
  std::vector<Surface> surfaces = split_by_slot(scene);
  const bool cad = scene.format == "STEP" || scene.format == "IGES" || scene.format == "BREP";
  for (Surface& surface : surfaces) {
    const Part& part = scene.parts[surface.part];
    surface.rule = assigned_rule(scene, part, surface.slot, rules);
    const UvJudgement uv = judge_uv(part.mesh, surface.triangles);
    surface.uv_mm_per_unit = uv.mm_per_unit;
    surface.uv_note = uv.note;
    const bool grain = surface.rule && !surface.rule->texture.empty();
    const bool feel = grain || (surface.rule && (surface.rule->stiffness || surface.rule->static_friction ||
                                                 surface.rule->dynamic_friction || surface.rule->damping));
    Given given{cad, uv.state};
    if (!perception.empty()) {
      given.left_out = perception[surface.part].left_out;
      given.is_only_seen = perception[surface.part].is_only_seen;
    }
    surface.is_left_out = !given.left_out.empty();
    surface.plan = make_plan({grain, feel}, given);
  }
  return surfaces;
}

nlohmann::ordered_json plan_json(const std::vector<Surface>& surfaces) {
  auto stages = nlohmann::ordered_json::array();
  for (const Surface& surface : surfaces)
    for (std::size_t i = 0; i < k_stage_count; ++i)
      stages.push_back({{"part", surface.label},
                        {"material", surface.rule ? nlohmann::ordered_json(surface.rule->name) : nullptr},
                        {"stage", k_stages[i].name},
                        {"run", surface.plan[i].run},
                        {"reason", surface.plan[i].reason}});
  return stages;
}

std::string plan_table(const std::vector<Surface>& surfaces) {
  std::size_t width = 4, material_width = 8;
  for (const Surface& surface : surfaces) {
    width = std::clamp(surface.label.size(), width, std::size_t{40});
    if (surface.rule) material_width = std::clamp(surface.rule->name.size(), material_width, std::size_t{24});
  }
  std::string out =
      fmt::format("{:<{}}  {:<{}}  {:>9}  stages\n", "part", width, "material", material_width, "triangles");
  for (const Surface& surface : surfaces) {
    std::string stages;
    std::map<std::string_view, std::string> skipped;
    for (std::size_t i = 0; i < k_stage_count; ++i) {
      if (surface.plan[i].run) {
        stages += (stages.empty() ? "" : " ") + std::string(k_stages[i].name);
        continue;
      }
      std::string& names = skipped[surface.plan[i].reason];
      names += (names.empty() ? "" : ", ") + std::string(k_stages[i].name);
    }
    out += fmt::format("{:<{}}  {:<{}}  {:>9}  {}\n", surface.label, width, surface.rule ? surface.rule->name : "-",
                       material_width, surface.triangles.size(), stages.empty() ? "nothing to do" : stages);
    for (const auto& [reason, names] : skipped)
      out += fmt::format("{:<{}}  without {}: {}\n", "", width, names, reason);
  }
  return out;
}

}  // namespace papilla::app
