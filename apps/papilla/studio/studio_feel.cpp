// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_feel.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {
namespace {

constexpr double k_reach_mm = 150;        ///< A drag leads hardly farther.
constexpr double k_stroke_m_per_s = 0.1;  ///< As papilla-player assumes it.
constexpr std::size_t k_longest_id = 64;
constexpr std::chrono::seconds k_patience{2};  ///< From "ready" to the first place.

Vec3 vec3_of(const Json& json, std::size_t first = 0) {
  const Vec3 v{json.at(first).get<double>(), json.at(first + 1).get<double>(), json.at(first + 2).get<double>()};
  if (!ContactSurface::is_valid_position(k_metres_per_mm * v)) throw InvalidInput("a place is no place");
  return v;
}

void add(Json& list, Vec3 v, double factor) {
  for (const double x : {v.x, v.y, v.z}) list.push_back(factor * x);
}

/// Rows as numbers one after the other, in mm and N.
Json batch_json(const std::string& id, const FeelBatch& batch) {
  Json numbers = Json::array(), sound = Json::array();
  for (const FeelRow& row : batch.rows) {
    numbers.push_back(row.t);
    for (const Vec3& place : {row.hand, row.probe, row.proxy}) add(numbers, place, k_mm_per_metre);
    add(numbers, row.force, 1);
    add(numbers, row.normal, 1);
    numbers.push_back(row.in_contact ? 1 : 0);
  }
  for (const float a : batch.sound) sound.push_back(a);
  static const Json columns = {"t",       "hand_x",   "hand_y",   "hand_z",   "probe_x", "probe_y",
                               "probe_z", "proxy_x",  "proxy_y",  "proxy_z",  "force_x", "force_y",
                               "force_z", "normal_x", "normal_y", "normal_z", "contact"};
  return {{"event", "felt"},    {"id", id},       {"columns", columns},         {"rows", numbers},
          {"late", batch.late}, {"sound", sound}, {"sound_hz", k_feel_sound_hz}};
}

HapticSceneOptions scene_options(const DeviceCaps& device) {
  HapticSceneOptions options;
  options.probe_radius_m = device.probe_radius_m;
  options.shortest_wave_m = 2 * k_stroke_m_per_s / k_feel_rate_hz;
  return options;
}

bool same(const std::vector<FeltSurface>& a, const std::vector<FeltSurface>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FeltSurface& x, const FeltSurface& y) {
    return x.surface == y.surface && x.world == y.world;
  });
}

const char* name_of(FeelEnd end) {
  switch (end) {
    case FeelEnd::lifted: return "lifted";
    case FeelEnd::silent: return "silent";
    case FeelEnd::stopped: return "stopped";
    case FeelEnd::fault: return "fault";
  }
  return "";
}

}  // namespace

Json feel_choices_json() {
  Json models = Json::array(), devices = Json::array();
  for (int i = 0; !papilla::name_of(static_cast<ForceModel>(i)).empty(); ++i) {
    const auto model = static_cast<ForceModel>(i);
    models.push_back({{"name", std::string(papilla::name_of(model))}, {"stimulus", is_stimulus(model)}});
  }
  for (const DevicePreset& preset : device_presets())
    devices.push_back({{"name", std::string(preset.name)},
                       {"title", std::string(preset.title)},
                       {"max_force_n", preset.max_force_n.value},
                       {"probe_radius_mm", k_mm_per_metre * preset.probe_radius_m.value},
                       {"mass_kg", preset.mass_kg.value},
                       {"damping", preset.damping.value},
                       {"friction_n", preset.friction_n.value},
                       {"encoder_step_mm", k_mm_per_metre * preset.encoder_step_m.value},
                       {"delay_ms", 1e3 * preset.delay_s.value}});
  return {{"models", models}, {"devices", devices}, {"rate_hz", k_feel_rate_hz}};
}

std::vector<FeltSurface> placed_surfaces(const StudioScene& scene, const StudioPlan& plan, const StudioWorker& worker) {
  std::vector<FeltSurface> placed;
  for (const StudioWish& wish : plan.wishes)
    if (const auto surface = worker.find(short_name(wish.key)))
      for (const std::uint32_t use : wish.uses) placed.push_back({surface, scene.uses().at(use).world});
  return placed;
}

StudioFeel::StudioFeel(Handlers handlers) : handlers_(std::move(handlers)), thread_([this] { run(); }) {}

StudioFeel::~StudioFeel() {
  {
    const std::scoped_lock lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StudioFeel::message(const std::string& text) noexcept {
  try {
    const Json json = Json::parse(text);
    if (json.is_object() && json.contains("feel")) take(json);
  } catch (const std::exception&) {
    // Of a page that is not ours.
  }
}

void StudioFeel::take(const Json& message) {
  if (message.at("id").get<std::string>().size() > k_longest_id) return;
  if (message.at("feel") == "press") return press(message);
  {
    const std::scoped_lock lock(mutex_);
    if (message.at("id") != running_) return;
  }
  follow(message);
  changed_.notify_all();
}

void StudioFeel::press(const Json& message) {
  Press press{message.at("id").get<std::string>(), message.at("device").get<std::string>(),
              message.value("model", std::string()), vec3_of(message.at("point"))};
  {
    const std::scoped_lock lock(mutex_);
    if (running_.empty() && !wanted_) {
      path_.clear();
      running_ = press.id;
      wanted_ = std::move(press);
      changed_.notify_all();
      return;
    }
  }
  tell(press.id, "failed", "another press is being felt");
}

/// {"path": [[t, x, y, z], …]} in seconds and mm, {"lift": t}
void StudioFeel::follow(const Json& message) {
  if (const auto path = message.find("path"); path != message.end())
    for (const Json& place : *path)
      if (const double t = place.at(0).get<double>(); std::isfinite(t))
        path_.add({t, k_metres_per_mm * vec3_of(place, 1)});
  if (const auto lift = message.find("lift"); lift != message.end()) path_.lift(lift->get<double>());
}

void StudioFeel::tell(const std::string& id, const std::string& state, const std::string& problem) {
  handlers_.tell({{"event", "feel"}, {"id", id}, {"state", state}, {"problem", problem}});
}

void StudioFeel::run() {
  std::unique_lock lock(mutex_);
  while (!stops_) {
    changed_.wait(lock, [&] { return stops_ || wanted_; });
    if (stops_) return;
    const Press press = *std::exchange(wanted_, std::nullopt);
    lock.unlock();
    std::string state = "failed", problem;
    try {
      state = feel(press);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    running_.clear();  // Before it is told, as the page may press again at once.
    lock.unlock();
    tell(press.id, state, problem);
    lock.lock();
  }
}

std::string StudioFeel::feel(const Press& press) {
  prepare(press);
  const DeviceCaps device = device_preset(press.device).caps();
  Json ready = {{"event", "feel"}, {"id", press.id}, {"state", "ready"}, {"problem", ""}};
  ready.update(prepared_.about);
  handlers_.tell(ready);
  if (!wait_for_path()) return name_of(stops_ ? FeelEnd::stopped : FeelEnd::silent);
  return name_of(run_feel_loop(
      *prepared_.surface, device, path_, [&](const FeelBatch& batch) { handlers_.tell(batch_json(press.id, batch)); },
      stops_));
}

bool StudioFeel::wait_for_path() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, k_patience, [&] { return stops_ || path_.is_begun(); });
  return !stops_ && path_.is_begun();
}

void StudioFeel::prepare(const Press& press) {
  const std::vector<FeltSurface> of = felt_surfaces(handlers_.surfaces(), press.point_mm, k_reach_mm);
  if (of.empty()) throw InvalidInput("nothing here has a haptic material");
  if (prepared_.surface && prepared_.device == press.device && prepared_.model == press.model && same(prepared_.of, of))
    return;
  const DeviceCaps device = device_preset(press.device).caps();
  HapticScene scene = felt_scene(of, press.model, handlers_.file(), scene_options(device));
  ContactSurface surface(scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m,
                         std::move(scene.channels));
  Json warnings = Json::array(), limits = Json::array();
  for (const MaterialWarning& warning : scene.warnings)
    warnings.push_back(warning.material + (warning.material.empty() ? "" : ": ") + warning.warning.message);
  for (const StabilityClamp& clamp : clamp_to_stable(surface, device.dynamics, 1 / k_feel_rate_hz))
    limits.push_back({{"material", scene.names.at(clamp.material)},
                      {"stiffness_wanted", clamp.stiffness_wanted},
                      {"stiffness", clamp.stiffness},
                      {"damping_wanted", clamp.damping_wanted},
                      {"damping", clamp.damping}});
  for (const AmplitudeClamp& clamp : clamp_amplitudes(surface, device.max_force_n))
    warnings.push_back(scene.names.at(clamp.material) + ": " + to_warning(clamp, device.max_force_n).message);
  prepared_ = {of,
               press.device,
               press.model,
               std::make_shared<const ContactSurface>(std::move(surface)),
               {{"materials", scene.names},
                {"warnings", warnings},
                {"limits", limits},
                {"triangles", scene.mesh.triangles.size()}}};
}

}  // namespace papilla::app
