// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {

/// "heightfield", "orthogonal", "lateral", "lateral-isotropic", "graph-orthogonal", "graph-lateral", "textured-normal".
std::string_view name_of(ForceModel model) noexcept;
std::optional<ForceModel> force_model(std::string_view name) noexcept;

/// Forces of a relief that are added to the contact with the smooth base [Schulze 2005, 6.6 to 6.8; Minsky 1995; Cho
/// 2017]. With g the relief in grey levels (256 from black to white), n the contact's normal, w the displacement of the
/// proxy along the surface in 1 ms, at every rate of the loop, and Δg = g(p) − g(p − w):
///
///     orthogonal           F = A·Δg·n
///     lateral              F = −A·∇g            per pixel; A in N per grey level and pixel
///     lateral-isotropic    F = −A·Δg·(u + v)    u and v the tangents of the texture
///     graph-orthogonal     as orthogonal, with g a Brownian graph of 257 samples, one a pixel, over the path length s
///     graph-lateral        F = −A·(Δg/Δs)·w/|w|, with the same graph
///     textured-normal      F = k·(c − x), c the closest point of the textured surface to a probe x below it; 0 above
///                          it. Replaces the force of the contact.
///
/// literal_sign flips the sign of the lateral ones, which then push uphill as in the source's 6.7. Zero without contact
/// and, except for lateral, at rest. Never NaN for finite input; noexcept, no allocation;
/// deterministic. Cost: one or two closest points.
class Stimulus {
 public:
  /// @param surface must outlive the object.
  explicit Stimulus(const ContactSurface& surface) noexcept;

  /// Whether the touched material has a stimulus.
  bool acts(const ProxyState& state) const noexcept {
    return state.in_contact && surface_->material(state.material).stimulus.has_value();
  }
  /// The total force on the probe.
  /// @param contact the force of the smooth contact. @param velocity of the probe, m/s.
  Vec3 force(const ProxyState& state, Vec3 probe, Vec3 velocity, double period_s, Vec3 contact) noexcept;

  static constexpr int k_graph = 257;
  const std::array<double, k_graph>& graph() const noexcept { return graph_; }

 private:
  double graph_at(double distance_m, double pixel_m) const noexcept;
  Vec3 textured_normal(const StimulusSample& here, Vec3 probe) const noexcept;

  const ContactSurface* surface_;
  std::array<double, k_graph> graph_{};
  double travelled_m_ = 0;
};

}  // namespace papilla
