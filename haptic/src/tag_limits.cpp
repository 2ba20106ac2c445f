// SPDX-License-Identifier: MIT
#include "papilla/haptic/tag_limits.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace papilla {
namespace {

constexpr double k_grey_levels = 256;
constexpr double k_peaks_of_rms = 4;
constexpr double k_rounding = 1e-6;  // Of the limit: what a float rounds beyond it is left alone.

std::string shown(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6);
  return {buffer, error == std::errc() ? end : buffer};
}

void limit_offset(HeightTag& height, std::vector<HapticWarning>& warnings) {
  const double range = std::abs(height.scale_m), low = height.offset_m + std::min(0.0, height.scale_m);
  const double shift = relief_shift_m(low, low + range);
  if (shift == 0) return;
  const std::string wanted = shown(height.offset_m);
  // Not by adding the shift, which a distant offset would round: limiting twice changes nothing.
  height.offset_m = (shift < 0 ? range : -2 * range) - std::min(0.0, height.scale_m);
  warnings.push_back({"tag_offset_limit", "haptic.height.offset = " + wanted +
                                              ": moves the surface farther from its mesh than its relief of " +
                                              shown(range) + " m is high, " + shown(height.offset_m) + " is used"});
}

void limit_height(HeightTag& height, std::vector<HapticWarning>& warnings) {
  const double one = height.offset_m, other = height.offset_m + height.scale_m;
  const double share = relief_share(one, other);
  if (share == 1) return;
  const std::string wanted = shown(height.scale_m);
  const double highest = std::max(std::abs(one), std::abs(other));
  height.scale_m *= share;
  height.offset_m *= share;
  warnings.push_back({"tag_height_limit", "haptic.height.scale = " + wanted + ": a height of " + shown(highest) +
                                              " m is beyond the limit of " + shown(k_highest_relief_m) + ", scale " +
                                              shown(height.scale_m) + " and offset " + shown(height.offset_m) +
                                              " are used"});
}

}  // namespace

double relief_shift_m(double low_m, double high_m) noexcept {
  const double range = high_m - low_m;
  const double shift = low_m > range ? range - low_m : high_m < -range ? -range - high_m : 0;
  return std::abs(shift) > k_rounding * range ? shift : 0;
}

double relief_share(double low_m, double high_m) noexcept {
  const double highest = std::max(std::abs(low_m), std::abs(high_m));
  return highest > k_highest_relief_m * (1 + k_rounding) ? k_highest_relief_m / highest : 1;
}

void limit_relief(MaterialTag& tag, std::vector<HapticWarning>& warnings) {
  if (tag.height) {
    limit_offset(*tag.height, warnings);
    limit_height(*tag.height, warnings);
  }
  constexpr double k_roughest_m = k_highest_relief_m / k_peaks_of_rms;
  if (!tag.roughness || tag.roughness->rms_height_m <= k_roughest_m) return;
  warnings.push_back({"tag_roughness_limit", "haptic.roughness.rmsHeight = " + shown(tag.roughness->rms_height_m) +
                                                 ": is beyond the limit of " + shown(k_roughest_m) +
                                                 ", which is used"});
  tag.roughness->rms_height_m = k_roughest_m;
}

double amplitude_limit(ForceModel model, double max_force_n) noexcept {
  switch (model) {
    case ForceModel::lateral_isotropic: return max_force_n / (k_grey_levels * std::numbers::sqrt2);
    case ForceModel::heightfield:
    case ForceModel::textured_normal: return std::numeric_limits<double>::infinity();
    case ForceModel::orthogonal:
    case ForceModel::lateral:
    case ForceModel::graph_orthogonal:
    case ForceModel::graph_lateral: break;
  }
  return max_force_n / k_grey_levels;
}

std::vector<AmplitudeClamp> clamp_amplitudes(ContactSurface& surface, double max_force_n) {
  std::vector<AmplitudeClamp> clamps;
  for (std::uint32_t i = 0; i < surface.material_count(); ++i) {
    ContactMaterial& material = surface.material(i);
    const double limit = amplitude_limit(material.model, max_force_n);
    if (!material.stimulus || !(std::abs(material.amplitude) > limit)) continue;
    clamps.push_back({i, material.amplitude, limit});
    material.amplitude = std::copysign(limit, material.amplitude);
  }
  return clamps;
}

HapticWarning to_warning(const AmplitudeClamp& clamp, double max_force_n) {
  return {"tag_amplitude_limit", "haptic.forceModel.amplitude = " + shown(clamp.wanted) + ": asks a device of " +
                                     shown(max_force_n) + " N for more than its largest force in a tick, " +
                                     shown(clamp.limit) + " is used"};
}

}  // namespace papilla
