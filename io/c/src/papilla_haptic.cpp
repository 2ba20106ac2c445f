// SPDX-License-Identifier: MIT
#include "papilla/io/papilla_haptic.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace papilla {
namespace {

/// What a handle stands for. Stays where it is: the tick refers to the surface.
struct Host {
  std::vector<std::string> names;
  std::vector<HeightField> heights;
  ContactSurface surface;
  SafetyLimits limits;
  double period_s;
  HapticTick tick;
  std::vector<std::string> warnings;

  Host(HapticScene scene, const papilla_haptic_options& options)
      : names(std::move(scene.names)),
        heights(scene.heights),
        surface(scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m, std::move(scene.channels)),
        limits(safety_limits(options.max_force_n)),
        period_s(1 / options.rate_hz),
        tick(surface, limits, period_s) {
    for (const MaterialWarning& w : scene.warnings)
      warnings.push_back(w.warning.code + ": " + w.material + (w.material.empty() ? "" : ": ") + w.warning.message);
    for (const AmplitudeClamp& clamp : clamp_amplitudes(surface, limits.max_force_n)) {
      const HapticWarning w = to_warning(clamp, limits.max_force_n);
      warnings.push_back(w.code + ": " + names[clamp.material] + ": " + w.message);
    }
    if (options.device == nullptr) return;
    const auto dynamics = device_preset(options.device).caps().dynamics;
    for (const StabilityClamp& clamp : clamp_to_stable(surface, dynamics, period_s))
      warnings.push_back("stability: " + names[clamp.material] + ": stiffness is held at " +
                         std::to_string(clamp.stiffness) + " N/m");
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// The height field of a material; null without one.
  const HeightField* relief(std::uint32_t material) const noexcept {
    if (material >= names.size()) return nullptr;
    const ContactMaterial& of = surface.material(material);
    const auto& index = of.height ? of.height : of.stimulus;
    return index ? &heights[*index] : nullptr;
  }
};

/// @throws InvalidInput naming the file when its triangles can't be touched.
std::unique_ptr<Host> host_of(HapticScene scene, const papilla_haptic_options& options, const char* path) try {
  return std::make_unique<Host>(std::move(scene), options);
} catch (const InvalidInput& error) {
  throw InvalidInput(std::string(path) + ": " + error.what());
}

/// Names of hosts. A name is the number of a place and how often it was given away, marked so that no address is one:
/// bit 0 is set, and where there are 64 bits the upper 16 are those of no address of a process. Finding is lock-free;
/// objects are never freed by the end of the program, whose threads may still tick.
class Handles {
 public:
  /// @throws Error when all places are taken.
  papilla_haptic* add(std::unique_ptr<Host> host) {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      Place& place = places_[i];
      if (place.name.load(std::memory_order_relaxed) != 0 || place.uses == k_most_uses) continue;
      const std::uintptr_t name = k_brand | ++place.uses << k_use_shift | i << 1 | 1;
      place.host = host.release();
      place.name.store(name, std::memory_order_release);
      return reinterpret_cast<papilla_haptic*>(name);  // NOLINT: a name, never followed.
    }
    throw Error("papilla_haptic_open: " + std::to_string(places_.size()) + " handles are open already");
  }

  Host* find(const papilla_haptic* handle) const noexcept {
    const auto name = reinterpret_cast<std::uintptr_t>(handle);
    const Place& place = places_[(name >> 1) % PAPILLA_HAPTIC_MOST_OPEN];
    return name != 0 && place.name.load(std::memory_order_acquire) == name ? place.host : nullptr;
  }

  /// Null when it is not open.
  std::unique_ptr<Host> take(const papilla_haptic* handle) noexcept {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Host> host(find(handle));
    if (!host) return host;
    Place& place = places_[(reinterpret_cast<std::uintptr_t>(handle) >> 1) % PAPILLA_HAPTIC_MOST_OPEN];
    place.name.store(0, std::memory_order_release);
    place.host = nullptr;
    return host;
  }

 private:
  struct Place {
    std::atomic<std::uintptr_t> name{0};
    Host* host = nullptr;
    std::uintptr_t uses = 0;
  };
  static constexpr unsigned k_use_shift = 9;  // Bit 0, and 8 bits for the place.
  static_assert(PAPILLA_HAPTIC_MOST_OPEN == 1 << (k_use_shift - 1));
  static constexpr bool k_wide = sizeof(std::uintptr_t) == 8;
  static constexpr std::uintptr_t k_brand = static_cast<std::uintptr_t>(k_wide ? std::uint64_t{0x5048} << 48U : 0U);
  static constexpr std::uintptr_t k_most_uses = (std::uintptr_t{1} << ((k_wide ? 48U : 32U) - k_use_shift)) - 1;

  std::array<Place, PAPILLA_HAPTIC_MOST_OPEN> places_;
  std::mutex mutex_;
};

constinit Handles handles;

Vec3 to_vec(const double* p) noexcept { return {p[0], p[1], p[2]}; }

void store(Vec3 v, double* to) noexcept {
  if (to == nullptr) return;
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

void copy_message(const char* what, char* message, std::size_t size) noexcept {
  if (message == nullptr || size == 0) return;
  const std::size_t length = std::min(std::strlen(what), size - 1);
  std::memcpy(message, what, length);
  message[length] = '\0';
}

const char* text_or_null(const std::vector<std::string>& texts, std::size_t index) noexcept {
  return index < texts.size() ? texts[index].c_str() : nullptr;
}

/// The options of a caller of any version. A size beyond k_most_size is no size but memory that nobody set.
constexpr std::uint64_t k_most_size = 4096;
papilla_haptic_options known_part(const papilla_haptic_options* given) {
  const std::uint64_t size = given->struct_size;
  if (size < sizeof size || size > k_most_size)
    throw InvalidInput("papilla_haptic_open: struct_size of the options is " + std::to_string(size) + ", not " +
                       std::to_string(sizeof *given));
  papilla_haptic_options options{};
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  std::memcpy(&options, bytes, std::min<std::size_t>(size, sizeof options));
  for (std::size_t i = sizeof options; i < size; ++i)
    if (bytes[i] != 0) throw InvalidInput("papilla_haptic_open: the options have members that this version lacks");
  return options;
}

papilla_haptic_options with_defaults(const papilla_haptic_options* given) {
  papilla_haptic_options options{};
  if (given != nullptr) options = known_part(given);
  if (options.rate_hz == 0) options.rate_hz = 1000;
  if (options.max_force_n == 0) options.max_force_n = 3.3;
  if (options.probe_radius_m == 0)
    options.probe_radius_m =
        options.device != nullptr ? device_preset(options.device).caps().probe_radius_m : k_default_probe_radius_m;
  else if (options.probe_radius_m < 0)
    options.probe_radius_m = 0;
  if (options.felt_depth_m == 0)
    options.felt_depth_m = k_felt_depth_m;
  else if (options.felt_depth_m < 0)
    options.felt_depth_m = 0;
  if (!(options.rate_hz >= 1 && options.rate_hz <= 1e5) || !(options.max_force_n > 0 && options.max_force_n < 1e3) ||
      !(options.probe_radius_m >= 0 && options.probe_radius_m < 1) ||
      !(options.felt_depth_m >= 0 && options.felt_depth_m < 1))
    throw InvalidInput("papilla_haptic_open: rate, force, radius or depth is out of range");
  return options;
}

/// Writes what the caller's struct has room for.
template <class Result>
std::int32_t write_known(Result value, Result* to) noexcept {
  if (to == nullptr || to->struct_size < sizeof to->struct_size || to->struct_size > k_most_size)
    return PAPILLA_HAPTIC_BAD_ARGUMENT;
  value.struct_size = to->struct_size;
  std::memcpy(to, &value, std::min<std::size_t>(value.struct_size, sizeof value));
  return 0;
}

}  // namespace
}  // namespace papilla

using papilla::handles;

std::uint32_t papilla_haptic_abi() { return PAPILLA_HAPTIC_ABI; }

const char* papilla_haptic_version() { return papilla::version(); }

papilla_haptic* papilla_haptic_open(const char* path, const papilla_haptic_options* options, char* message,
                                    std::size_t message_size) {
  papilla::copy_message("", message, message_size);
  try {
    if (path == nullptr || *path == '\0') throw papilla::InvalidInput("papilla_haptic_open: no path");
    const papilla_haptic_options all = papilla::with_defaults(options);
    papilla::HapticSceneOptions scene;
    scene.probe_radius_m = all.probe_radius_m;
    scene.felt_depth_m = all.felt_depth_m;
    if (all.tags != nullptr) scene.tags = all.tags;
    return handles.add(papilla::host_of(papilla::load_haptic_scene(path, scene), all, path));
  } catch (const std::exception& error) {
    papilla::copy_message(error.what(), message, message_size);
  } catch (...) {
    papilla::copy_message("papilla_haptic_open: unknown failure", message, message_size);
  }
  return nullptr;
}

std::int32_t papilla_haptic_close(papilla_haptic* haptic) {
  return handles.take(haptic) ? 0 : PAPILLA_HAPTIC_BAD_HANDLE;
}

std::int32_t papilla_haptic_reset(papilla_haptic* haptic, const double position[3]) {
  papilla::Host* const host = handles.find(haptic);
  if (host == nullptr) return PAPILLA_HAPTIC_BAD_HANDLE;
  if (position == nullptr) return PAPILLA_HAPTIC_BAD_ARGUMENT;
  host->tick.reset(papilla::to_vec(position));
  return 0;
}

std::int32_t papilla_haptic_tick(papilla_haptic* haptic, const double position[3], double age_s, double force[3]) {
  papilla::Host* const host = handles.find(haptic);
  if (host == nullptr || position == nullptr || force == nullptr) {
    papilla::store({}, force);
    return host == nullptr ? PAPILLA_HAPTIC_BAD_HANDLE : PAPILLA_HAPTIC_BAD_ARGUMENT;
  }
  papilla::DeviceState state;
  state.position = papilla::to_vec(position);
  state.age_s = age_s;
  papilla::store(host->tick(state), force);
  const papilla::ProxyState& proxy = host->tick.proxy();
  const bool fault = host->tick.guard().fault() != papilla::ForceGuard::Fault::none;
  return (proxy.in_contact ? PAPILLA_HAPTIC_CONTACT : 0) | (proxy.sliding ? PAPILLA_HAPTIC_SLIDING : 0) |
         (fault ? PAPILLA_HAPTIC_FAULT : 0);
}

std::int32_t papilla_haptic_proxy(const papilla_haptic* haptic, double position[3], double normal[3]) {
  papilla::Host* const host = handles.find(haptic);
  const papilla::ProxyState state = host != nullptr ? host->tick.proxy() : papilla::ProxyState{};
  papilla::store(state.proxy, position);
  papilla::store(state.normal, normal);
  if (host == nullptr) return PAPILLA_HAPTIC_BAD_HANDLE;
  return state.in_contact ? static_cast<std::int32_t>(state.material) : PAPILLA_HAPTIC_NONE;
}

std::int64_t papilla_haptic_triangles(const papilla_haptic* haptic) {
  const papilla::Host* const host = handles.find(haptic);
  if (host == nullptr) return PAPILLA_HAPTIC_BAD_HANDLE;
  return static_cast<std::int64_t>(host->surface.triangles());
}

std::int32_t papilla_haptic_material_count(const papilla_haptic* haptic) {
  const papilla::Host* const host = handles.find(haptic);
  return host != nullptr ? static_cast<std::int32_t>(host->names.size()) : PAPILLA_HAPTIC_BAD_HANDLE;
}

std::int32_t papilla_haptic_warning_count(const papilla_haptic* haptic) {
  const papilla::Host* const host = handles.find(haptic);
  return host != nullptr ? static_cast<std::int32_t>(host->warnings.size()) : PAPILLA_HAPTIC_BAD_HANDLE;
}

const char* papilla_haptic_material_name(const papilla_haptic* haptic, std::uint32_t material) {
  const papilla::Host* const host = handles.find(haptic);
  return host != nullptr ? papilla::text_or_null(host->names, material) : nullptr;
}

const char* papilla_haptic_warning(const papilla_haptic* haptic, std::uint32_t index) {
  const papilla::Host* const host = handles.find(haptic);
  return host != nullptr ? papilla::text_or_null(host->warnings, index) : nullptr;
}

std::int32_t papilla_haptic_material(const papilla_haptic* haptic, std::uint32_t material,
                                     papilla_haptic_constants* constants) {
  const papilla::Host* const host = handles.find(haptic);
  if (host == nullptr) return PAPILLA_HAPTIC_BAD_HANDLE;
  if (material >= host->names.size()) return PAPILLA_HAPTIC_NONE;
  const papilla::ContactMaterial& from = host->surface.material(material);
  papilla_haptic_constants value{};
  value.stiffness = from.stiffness;
  value.damping = from.damping;
  value.static_friction = from.static_friction;
  value.dynamic_friction = from.dynamic_friction;
  value.stribeck_velocity = from.stribeck_velocity;
  value.backing_stiffness = from.backing_stiffness;
  value.backing_depth_m = from.backing_depth_m;
  value.max_stiffness = host->surface.most(material, papilla::Quantity::stiffness);
  return papilla::write_known(value, constants);
}

std::int32_t papilla_haptic_material_relief(const papilla_haptic* haptic, std::uint32_t material,
                                            papilla_haptic_relief* relief) {
  const papilla::Host* const host = handles.find(haptic);
  if (host == nullptr) return PAPILLA_HAPTIC_BAD_HANDLE;
  const papilla::HeightField* const field = host->relief(material);
  if (field == nullptr) return PAPILLA_HAPTIC_NONE;
  papilla_haptic_relief value{};
  value.width = static_cast<std::uint32_t>(field->width());
  value.height = static_cast<std::uint32_t>(field->height());
  value.min_m = field->min_m();
  value.max_m = field->max_m();
  return papilla::write_known(value, relief);
}

std::int32_t papilla_haptic_height(const papilla_haptic* haptic, std::uint32_t material, const double* uv,
                                   std::size_t count, double* heights_m, double* gradients_m) {
  const papilla::Host* const host = handles.find(haptic);
  if (host == nullptr) return PAPILLA_HAPTIC_BAD_HANDLE;
  if (uv == nullptr || count > PTRDIFF_MAX / (2 * sizeof(double))) return PAPILLA_HAPTIC_BAD_ARGUMENT;
  const papilla::HeightField* const field = host->relief(material);
  if (field == nullptr) return PAPILLA_HAPTIC_NONE;
  for (std::size_t i = 0; i < count; ++i) {
    const papilla::HeightSample at = field->sample({uv[2 * i], uv[2 * i + 1]});
    if (heights_m != nullptr) heights_m[i] = at.height_m;
    if (gradients_m == nullptr) continue;
    gradients_m[2 * i] = at.gradient_m.x;
    gradients_m[2 * i + 1] = at.gradient_m.y;
  }
  return 0;
}
