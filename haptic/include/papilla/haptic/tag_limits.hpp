// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/material_tag.hpp"

namespace papilla {

/// Largest height of a relief above or below its mesh.
inline constexpr double k_highest_relief_m = 0.02;

/// By how much a relief with heights from l to h has to be moved so that it lies no farther from its mesh than it is
/// high: l ≤ h − l and h ≥ −(h − l). 0 when it does.
double relief_shift_m(double low_m, double high_m) noexcept;
/// By which factor its heights have to be shrunk so that |l|, |h| ≤ k_highest_relief_m. 1 when they are.
double relief_share(double low_m, double high_m) noexcept;

/// Limits where a tag's relief may be, by scale and offset: it is moved by relief_shift_m() (code tag_offset_limit),
/// then shrunk by relief_share() (tag_height_limit). The rms of a roughness is limited to a quarter of
/// k_highest_relief_m, as its peaks are about four times as high (tag_roughness_limit). Each warning names field, value
/// and limit.
void limit_relief(MaterialTag& tag, std::vector<HapticWarning>& warnings);

/// Largest amplitude A of a stimulus on a device: a change from black to white, 256 grey levels, within a tick asks for
/// no more than the device's largest force,
///     A ≤ F/256,   lateral-isotropic, which acts along both tangents: A ≤ F/(256·√2).
/// Infinite for the models without amplitude.
double amplitude_limit(ForceModel model, double max_force_n) noexcept;

/// An amplitude that was reduced.
struct AmplitudeClamp {
  std::uint32_t material = 0;
  double wanted = 0, limit = 0;
};

/// Limits every stimulus of the surface to amplitude_limit(). @returns the reduced ones, in order.
std::vector<AmplitudeClamp> clamp_amplitudes(ContactSurface& surface, double max_force_n);

/// Code tag_amplitude_limit, with field, value and limit.
HapticWarning to_warning(const AmplitudeClamp& clamp, double max_force_n);

}  // namespace papilla
