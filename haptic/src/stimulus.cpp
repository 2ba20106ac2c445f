// SPDX-License-Identifier: MIT
#include "papilla/haptic/stimulus.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {
namespace {

constexpr double k_reference_s = 1e-3;   // Time of the displacement w.
constexpr double k_least_pixels = 0.01;  // Shorter displacements have no defined direction.
constexpr double k_default_pixel_m = 1e-4;
constexpr double k_steepest = 256;  // Grey levels a pixel.

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
    {ForceModel::graph_orthogonal, "graph"},
};

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

std::string_view name_of(ForceModel model, StimulusForm form) noexcept {
  if (model == ForceModel::lateral) return form == StimulusForm::displacement ? "displacement" : "gradient";
  if (is_graph(model)) return form == StimulusForm::place ? "place" : "path";
  return {};
}

std::optional<StimulusForm> stimulus_form(ForceModel model, std::string_view name) noexcept {
  for (const StimulusForm form : {StimulusForm::usual, StimulusForm::displacement, StimulusForm::place})
    if (!name.empty() && name_of(model, form) == name) return form;
  return std::nullopt;
}

Stimulus::Stimulus(const ContactSurface& surface) : surface_(&surface), graph_of_(surface.material_count()) {
  for (std::uint32_t i = 0; i < surface.material_count(); ++i) {
    const ContactMaterial& material = surface.material(i);
    if (!is_graph(material.model)) continue;
    graph_of_[i] = static_cast<std::uint32_t>(graphs_.size());
    graphs_.emplace_back(material.hurst, material.level);
  }
}

Vec3 Stimulus::force(const ProxyState& state, Vec3 probe, Vec3 velocity, double period_s, Vec3 contact) noexcept {
  const double near = 2 * surface_->contact_radius_m() + norm(state.proxy - probe);
  const ContactMaterial& material = surface_->material(state.material);
  const auto here = material.stimulus ? surface_->stimulus(state.proxy, near) : std::nullopt;
  if (!here && !is_graph(material.model)) return contact;

  const Vec3 n = state.normal, along = velocity - dot(velocity, n) * n, way = k_reference_s * along;
  const double length = norm(way), sign = material.literal_sign ? 1 : -1, a = material.amplitude;
  const double pixel = here && here->pixel_m > 0 ? here->pixel_m : k_default_pixel_m;
  const bool moves = length > k_least_pixels * pixel;
  if (is_graph(material.model)) {
    travelled_m_ += norm(along) * period_s;
    const GreyGraph& graph = graphs_[graph_of_[state.material]];
    double now = travelled_m_ / pixel, before = std::max(0.0, travelled_m_ - length) / pixel;
    if (material.form == StimulusForm::place && here) {
      const auto there = surface_->stimulus(state.proxy - way, near + length);
      now = here->column, before = there ? there->column : now;
    }
    const double change = graph.at(now) - graph.at(before);
    if (material.model == ForceModel::graph_orthogonal) return contact + a * change * n;
    return moves ? contact + sign * a * change * pixel / (length * length) * way : contact;
  }

  const StimulusSample now = *here;
  const auto change = [&] {
    const auto there = surface_->stimulus(state.proxy - way, near + length);
    return there ? now.grey - there->grey : 0;
  };
  const Vec3 u = now.along_u, v = cross(now.normal, u);
  switch (material.model) {
    case ForceModel::orthogonal: return contact + a * change() * n;
    case ForceModel::lateral_isotropic: return contact + sign * a * change() * (u + v);
    case ForceModel::lateral: break;
    default: return contact;
  }
  if (material.form != StimulusForm::displacement) return contact + sign * a * pixel * now.slope;
  if (!moves) return contact;
  const double difference = change();
  const auto quotient = [&](Vec3 axis) {
    const double pixels = dot(way, axis) / pixel;
    return std::abs(pixels) > k_least_pixels ? difference / pixels : 0;
  };
  const Vec3 slope = quotient(u) * u + quotient(v) * v;
  return contact + sign * a * std::min(1.0, k_steepest / std::max(norm(slope), k_steepest)) * slope;
}

}  // namespace papilla
