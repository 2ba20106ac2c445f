// SPDX-License-Identifier: MIT
#include "papilla/io/papilla_haptic.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/haptic_scene.hpp"

struct papilla_haptic {
  papilla::HapticScene scene;
  papilla::ContactSurface surface;
  papilla::SafetyLimits limits;
  double period_s;
  papilla::HapticTick tick;
  std::vector<std::string> warnings;

  papilla_haptic(papilla::HapticScene from, const papilla_haptic_options& options)
      : scene(std::move(from)),
        surface(scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m, std::move(scene.channels)),
        limits(papilla::safety_limits(options.max_force_n)),
        period_s(1 / options.rate_hz),
        tick(surface, limits, period_s) {
    scene.mesh = {};
    for (const papilla::MaterialWarning& w : scene.warnings)
      warnings.push_back(w.warning.code + ": " + w.material + (w.material.empty() ? "" : ": ") + w.warning.message);
    for (const papilla::AmplitudeClamp& clamp : papilla::clamp_amplitudes(surface, limits.max_force_n)) {
      const papilla::HapticWarning w = papilla::to_warning(clamp, limits.max_force_n);
      warnings.push_back(w.code + ": " + scene.names[clamp.material] + ": " + w.message);
    }
    if (options.device == nullptr) return;
    const auto dynamics = papilla::device_preset(options.device).caps().dynamics;
    for (const papilla::StabilityClamp& clamp : papilla::clamp_to_stable(surface, dynamics, period_s))
      warnings.push_back("stability: " + scene.names[clamp.material] + ": stiffness is held at " +
                         std::to_string(clamp.stiffness) + " N/m");
  }
};

namespace {

papilla::Vec3 to_vec(const double* p) noexcept { return {p[0], p[1], p[2]}; }

void store(papilla::Vec3 v, double* to) noexcept {
  if (to == nullptr) return;
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

void copy_message(const char* what, char* message, size_t size) noexcept {
  if (message == nullptr || size == 0) return;
  const size_t length = std::min(std::strlen(what), size - 1);
  std::memcpy(message, what, length);
  message[length] = '\0';
}

const char* text_or_null(const std::vector<std::string>& texts, size_t index) noexcept {
  return index < texts.size() ? texts[index].c_str() : nullptr;
}

papilla_haptic_options with_defaults(const papilla_haptic_options* given) {
  papilla_haptic_options options{};
  if (given != nullptr) options = *given;
  if (options.rate_hz == 0) options.rate_hz = 1000;
  if (options.max_force_n == 0) options.max_force_n = 3.3;
  if (options.probe_radius_m == 0)
    options.probe_radius_m = options.device != nullptr ? papilla::device_preset(options.device).caps().probe_radius_m
                                                       : papilla::k_default_probe_radius_m;
  else if (options.probe_radius_m < 0)
    options.probe_radius_m = 0;
  if (!(options.rate_hz >= 1 && options.rate_hz <= 1e5) || !(options.max_force_n > 0 && options.max_force_n < 1e3) ||
      !(options.probe_radius_m >= 0 && options.probe_radius_m < 1))
    throw papilla::InvalidInput("papilla_haptic_open: rate, force or radius is out of range");
  return options;
}

}  // namespace

papilla_haptic* papilla_haptic_open(const char* path, const papilla_haptic_options* options, char* message,
                                    size_t message_size) {
  try {
    if (path == nullptr) throw papilla::InvalidInput("papilla_haptic_open: no path");
    const papilla_haptic_options all = with_defaults(options);
    papilla::HapticSceneOptions scene;
    scene.probe_radius_m = all.probe_radius_m;
    return new papilla_haptic(papilla::load_haptic_scene(path, scene), all);
  } catch (const std::exception& error) {
    copy_message(error.what(), message, message_size);
  } catch (...) {
    copy_message("papilla_haptic_open: unknown failure", message, message_size);
  }
  return nullptr;
}

void papilla_haptic_close(papilla_haptic* haptic) { delete haptic; }

void papilla_haptic_reset(papilla_haptic* haptic, const double position[3]) {
  if (haptic != nullptr && position != nullptr) haptic->tick.reset(to_vec(position));
}

int papilla_haptic_tick(papilla_haptic* haptic, const double position[3], double age_s, double force[3]) {
  if (haptic == nullptr || position == nullptr) {
    store({}, force);
    return PAPILLA_HAPTIC_FAULT;
  }
  papilla::DeviceState state;
  state.position = to_vec(position);
  state.age_s = age_s;
  store(haptic->tick(state), force);
  const bool fault = haptic->tick.guard().fault() != papilla::ForceGuard::Fault::none;
  return (haptic->tick.proxy().in_contact ? PAPILLA_HAPTIC_CONTACT : 0) |
         (haptic->tick.proxy().sliding ? PAPILLA_HAPTIC_SLIDING : 0) | (fault ? PAPILLA_HAPTIC_FAULT : 0);
}

void papilla_haptic_proxy(const papilla_haptic* haptic, double position[3], double normal[3]) {
  store(haptic != nullptr ? haptic->tick.proxy().proxy : papilla::Vec3{}, position);
  store(haptic != nullptr ? haptic->tick.proxy().normal : papilla::Vec3{}, normal);
}

size_t papilla_haptic_triangles(const papilla_haptic* haptic) {
  return haptic != nullptr ? haptic->surface.triangles() : 0;
}

const char* papilla_haptic_material(const papilla_haptic* haptic, size_t index) {
  return haptic != nullptr ? text_or_null(haptic->scene.names, index) : nullptr;
}

const char* papilla_haptic_warning(const papilla_haptic* haptic, size_t index) {
  return haptic != nullptr ? text_or_null(haptic->warnings, index) : nullptr;
}
