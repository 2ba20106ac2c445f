// SPDX-License-Identifier: MIT
#include "papilla/haptic/stimulus.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace papilla {
namespace {

constexpr double k_reference_s = 1e-3;   // Time of the displacement w.
constexpr double k_least_pixels = 0.01;  // Shorter displacements have no defined direction.
constexpr double k_default_pixel_m = 1e-4;
constexpr int k_descent_steps = 12;

struct Named {
  ForceModel model;
  std::string_view name;
};
constexpr Named k_names[] = {
    {ForceModel::heightfield, "heightfield"},
    {ForceModel::orthogonal, "orthogonal"},
    {ForceModel::lateral, "lateral"},
    {ForceModel::lateral_isotropic, "lateral-isotropic"},
    {ForceModel::graph_orthogonal, "graph-orthogonal"},
    {ForceModel::graph_lateral, "graph-lateral"},
    {ForceModel::textured_normal, "textured-normal"},
};

/// A random walk of steps ±1, scaled to the 256 grey levels.
std::array<double, Stimulus::k_graph> brownian_graph() noexcept {
  std::array<double, Stimulus::k_graph> graph{};
  std::uint64_t random = 0x9E3779B97F4A7C15U;
  for (std::size_t i = 1; i < graph.size(); ++i) {
    random ^= random << 13;
    random ^= random >> 7;
    random ^= random << 17;
    graph[i] = graph[i - 1] + ((random >> 32 & 1U) != 0 ? 1.0 : -1.0);
  }
  const auto [low, high] = std::minmax_element(graph.begin(), graph.end());
  const double least = *low, scale = 256 / (*high - *low);
  for (double& value : graph) value = scale * (value - least);
  return graph;
}

}  // namespace

std::string_view name_of(ForceModel model) noexcept {
  for (const Named& named : k_names)
    if (named.model == model) return named.name;
  return {};
}

std::optional<ForceModel> force_model(std::string_view name) noexcept {
  for (const Named& named : k_names)
    if (named.name == name) return named.model;
  return std::nullopt;
}

Stimulus::Stimulus(const ContactSurface& surface) noexcept : surface_(&surface), graph_(brownian_graph()) {}

/// The graph, mirrored at its ends and linear between samples.
double Stimulus::graph_at(double distance_m, double pixel_m) const noexcept {
  constexpr double last = k_graph - 1;
  double at = std::fmod(std::abs(distance_m) / pixel_m, 2 * last);
  if (at > last) at = 2 * last - at;
  const auto i = static_cast<std::size_t>(std::min(at, last - 1));
  const double f = at - static_cast<double>(i);
  return (1 - f) * graph_[i] + f * graph_[i + 1];
}

/// Gauss-Newton descent of the distance over the surface, from the foot of the probe.
Vec3 Stimulus::textured_normal(const StimulusSample& here, Vec3 probe) const noexcept {
  const ContactMaterial& material = surface_->material(here.material);
  const double greys_per_m = here.height_m != 0 ? here.grey / here.height_m : 0;
  const auto top = [](const StimulusSample& s) { return s.point + s.height_m * s.normal; };
  if (dot(top(here) - probe, here.normal) <= 0) return {};
  StimulusSample best = here, now = here;
  double least = norm(top(here) - probe);
  for (int i = 0; i < k_descent_steps; ++i) {
    const Vec3 slope = greys_per_m != 0 ? (1 / greys_per_m) * now.slope : Vec3{};
    const Vec3 d = top(now) - probe;
    const Vec3 flat = d - dot(d, now.normal) * now.normal;
    const Vec3 step = -0.5 / (1 + dot(slope, slope)) * (flat + dot(d, now.normal) * slope);
    const auto next = surface_->stimulus(now.point + step, norm(step) + surface_->contact_radius_m());
    if (!next) break;
    now = *next;
    if (const double distance = norm(top(now) - probe); distance < least) {
      least = distance;
      best = now;
    }
  }
  return material.stiffness * (top(best) - probe);
}

Vec3 Stimulus::force(const ProxyState& state, Vec3 probe, Vec3 velocity, double period_s, Vec3 contact) noexcept {
  const double near = 2 * surface_->contact_radius_m() + norm(state.proxy - probe);
  const auto here = surface_->stimulus(state.proxy, near);
  if (!here) return contact;
  const ContactMaterial& material = surface_->material(here->material);
  if (material.model == ForceModel::textured_normal) return textured_normal(*here, probe);

  const Vec3 n = state.normal, along = velocity - dot(velocity, n) * n, way = k_reference_s * along;
  const double length = norm(way), sign = material.literal_sign ? 1 : -1, a = material.amplitude;
  const double pixel = here->pixel_m > 0 ? here->pixel_m : k_default_pixel_m;
  travelled_m_ += norm(along) * period_s;
  const auto before = [&] {
    const auto there = surface_->stimulus(state.proxy - way, near + length);
    return there ? there->grey : here->grey;
  };
  const auto graph_change = [&] {
    return graph_at(travelled_m_, pixel) - graph_at(std::max(0.0, travelled_m_ - length), pixel);
  };
  const Vec3 v = cross(here->normal, here->along_u);
  const bool moves = length > k_least_pixels * pixel;
  switch (material.model) {
    case ForceModel::orthogonal: return contact + a * (here->grey - before()) * n;
    case ForceModel::lateral: return contact + sign * a * pixel * here->slope;
    case ForceModel::lateral_isotropic: return contact + sign * a * (here->grey - before()) * (here->along_u + v);
    case ForceModel::graph_orthogonal: return contact + a * graph_change() * n;
    case ForceModel::graph_lateral:
      return moves ? contact + sign * a * graph_change() * pixel / (length * length) * way : contact;
    case ForceModel::textured_normal:
    case ForceModel::heightfield: break;
  }
  return contact;
}

}  // namespace papilla
