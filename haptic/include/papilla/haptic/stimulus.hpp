// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/grey_graph.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// "heightfield", "orthogonal", "lateral", "lateral-isotropic", "graph-orthogonal", "graph-lateral", "textured-normal".
std::string_view name_of(ForceModel model) noexcept;
/// The same names, and "graph" for "graph-orthogonal".
std::optional<ForceModel> force_model(std::string_view name) noexcept;

/// "gradient" and "displacement" of lateral, "path" and "place" of the graphs, nothing of other models.
std::string_view name_of(ForceModel model, StimulusForm form) noexcept;
/// Nothing where the model has no such form.
std::optional<StimulusForm> stimulus_form(ForceModel model, std::string_view name) noexcept;

/// Whether the model's force is added to the contact with the smooth base.
constexpr bool is_stimulus(ForceModel model) noexcept {
  return model != ForceModel::heightfield && model != ForceModel::textured_normal;
}
constexpr bool is_graph(ForceModel model) noexcept {
  return model == ForceModel::graph_orthogonal || model == ForceModel::graph_lateral;
}

/// Forces of a relief that are added to the contact with the smooth base [Schulze 2005, 6.6 to 6.8; Minsky 1995]. With
/// g the relief in grey levels (256 from black to white), n the contact's normal, w the displacement of the proxy along
/// the surface in 1 ms, at every rate of the loop, and Δg = g(p) − g(p − w):
///
///     orthogonal             F = A·Δg·n
///     lateral, gradient      F = −A·∇g               per pixel; A in N per grey level and pixel
///     lateral, displacement  F = −A·(q_u·u + q_v·v)  q_i = Δg/w_i, 0 where |w_i| is below 0.01 pixels: 6.7 as printed
///     lateral-isotropic      F = −A·Δg·(u + v)       u and v the tangents of the texture
///     graph-orthogonal       as orthogonal, with g a GreyGraph, one sample a pixel
///     graph-lateral          F = −A·(Δg/Δs)·w/|w|    with the same graph
///
/// 6.7's quotients are those of a displacement along u or v; across both they exceed the gradient, and their resultant
/// is limited to 256 grey levels a pixel, the steepest slope of a picture. The graph is a function of the distance
/// travelled in contact ("path", the source's step 2b), or of the place, the columns of the picture, as the source's
/// picture of 257 × 1 laid over the surface ("place"): then a stroke there and back feels the same profile backwards.
/// Without a relief a pixel of the graph is 0.1 mm long, and place is path.
///
/// literal_sign flips the sign of the lateral ones, which then push uphill as in the source's 6.7. Zero without contact
/// and, except for lateral with the gradient, at rest. Never NaN for finite input; force() is noexcept and allocates
/// nothing; deterministic. Cost: one or two closest points.
class Stimulus {
 public:
  /// @param surface must outlive the object; H and level of its materials are read here.
  explicit Stimulus(const ContactSurface& surface);

  /// Whether the touched material has a stimulus.
  bool acts(const ProxyState& state) const noexcept {
    if (!state.in_contact) return false;
    const ContactMaterial& material = surface_->material(state.material);
    return is_graph(material.model) || (is_stimulus(material.model) && material.stimulus.has_value());
  }
  /// The total force on the probe.
  /// @param contact the force of the smooth contact. @param velocity of the probe, m/s.
  Vec3 force(const ProxyState& state, Vec3 probe, Vec3 velocity, double period_s, Vec3 contact) noexcept;

 private:
  const ContactSurface* surface_;
  std::vector<GreyGraph> graphs_;
  std::vector<std::uint32_t> graph_of_;  // By material.
  double travelled_m_ = 0;
};

}  // namespace papilla
