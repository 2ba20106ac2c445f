// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <sys/resource.h>

#include <cmath>

#include "audio_sink.hpp"
#include "json_object.hpp"
#include "shown_format.hpp"
#include "tags_json.hpp"

namespace papilla::player {
namespace {

using Json = nlohmann::ordered_json;

Json quantiles(const Histogram& h) {
  return JsonObject()("p50", h.quantile(0.5))("p99", h.quantile(0.99))("p999", h.quantile(0.999))("max", h.max());
}

std::string quantile_line(const char* what, const Histogram& h) {
  return app::shown_format("  {:<10} median {:.1f} us, 99 % {:.1f}, 99.9 % {:.1f}, worst {:.1f}\n", what,
                           h.quantile(0.5), h.quantile(0.99), h.quantile(0.999), h.max());
}

/// Largest resident memory of the process so far.
double peak_rss_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string clamp_line(const StabilityClamp& clamp, const std::string& name) {
  std::string line = app::shown_format("  {}: {:.0f} -> {:.0f} N/m where it is stiffest", name, clamp.stiffness_wanted,
                                       clamp.stiffness);
  if (clamp.damping < clamp.damping_wanted)
    line += app::shown_format(", damping {:.3g} -> {:.3g} N s/m", clamp.damping_wanted, clamp.damping);
  return line + ", so that the device stays stable\n";
}

std::string pause_line(const LoopResult& loop) {
  if (loop.pauses == 0) return "";
  return app::shown_format("  stood still {} times, {:.3g} s at most; the force faded in again from zero each time\n",
                           loop.pauses, loop.longest_pause_s);
}

Json vibration_json(const std::optional<VibrationReport>& vibration) {
  if (!vibration) return nullptr;
  return JsonObject()("target", vibration->target)("samples", vibration->samples)("sample_rate_hz", k_audio_rate_hz)(
      "peak_m_per_s2", vibration->peak_m_per_s2)("rms_m_per_s2", vibration->rms_m_per_s2)(
      "beyond_full_scale", vibration->limited)("missed_ticks", vibration->missed_ticks);
}

std::string vibration_line(const std::optional<VibrationReport>& vibration) {
  if (!vibration) return "";
  return app::shown_format("  vibration on {}: rms {:.3g} m/s2, peak {:.3g}{}\n", vibration->target,
                           vibration->rms_m_per_s2, vibration->peak_m_per_s2,
                           vibration->limited ? ", rounded off beyond --full-scale" : "");
}

}  // namespace

Json to_json(const RunReport& r) {
  Json clamped = Json::array(), clamps = Json::array(), warnings = Json::array();
  for (const StabilityClamp& c : r.clamps) {
    clamped.push_back(r.material_names[c.material]);
    clamps.push_back(JsonObject()("material", r.material_names[c.material])("stiffness_wanted", c.stiffness_wanted)(
        "stiffness", c.stiffness)("damping_wanted", c.damping_wanted)("damping", c.damping));
  }
  for (const MaterialWarning& w : r.warnings)
    warnings.push_back(JsonObject()("code", w.warning.code)("material", w.material)("message", w.warning.message));
  const LoopResult& loop = r.loop;
  JsonObject json;
  json("file", r.file);
  json("device", r.device);
  json("probe_radius_mm", 1e3 * r.probe_radius_m);
  json("rate_hz", r.rate_hz);
  json("achieved_rate_hz", loop.seconds > 0 ? static_cast<double>(loop.ticks) / loop.seconds : 0.0);
  json("ticks", loop.ticks);
  json("missed_deadlines", loop.missed_deadlines);
  json("pauses", JsonObject()("count", loop.pauses)("longest_s", loop.longest_pause_s));
  json("wakeup_us", quantiles(loop.wakeup_us));
  json("tick_us", quantiles(loop.tick_us));
  json("contact_ticks", loop.contact_ticks);
  json("lost_contact_ticks", loop.lost_contact_ticks);
  json("passivity_interventions", loop.passivity_interventions);
  json("max_force_n", loop.max_force_n);
  json("stiffness_limit_n_per_m", std::isfinite(r.stiffness_limit) ? Json(r.stiffness_limit) : Json());
  json("clamped_materials", std::move(clamped));
  json("clamps", std::move(clamps));
  json("height_maps",
       JsonObject()("loaded", r.maps_loaded)("missing", r.maps_missing)("roughness_overlays", r.roughness_overlays));
  json("channel_maps", JsonObject()("loaded", r.channels_loaded)("missing", r.channels_missing));
  json("materials", r.material_names);
  json("tags", app::tags_json(r.tags));
  json("left_out", JsonObject()("triangles", r.triangles_out_of_reach)("maps_made_coarser", r.maps_coarsened));
  json("fixed_priority", loop.fixed_priority);
  json("memory_locked", loop.memory_locked);
  json("warnings", std::move(warnings));
  json("vibration", vibration_json(r.vibration));
  json("registration_residual_mm", r.registration_residual_mm ? Json(*r.registration_residual_mm) : Json());
  json("triangles", r.triangles);
  json("contact_bytes", r.contact_bytes);
  json("load_seconds", r.load_seconds);
  json("rss_mib", peak_rss_mib());
  return json;
}

std::string summary(const RunReport& r) {
  const LoopResult& loop = r.loop;
  std::string text = app::shown_format("{} on {} at {:.0f} Hz\n", r.file, r.device, r.rate_hz);
  text += app::shown_format("  {} triangles to feel, {} height maps ({} missing), loaded in {:.2f} s\n", r.triangles,
                            r.maps_loaded, r.maps_missing, r.load_seconds);
  if (r.channels_loaded + r.channels_missing > 0)
    text += app::shown_format("  {} maps of stiffness, friction and damping ({} missing)\n", r.channels_loaded,
                              r.channels_missing);
  for (const StabilityClamp& clamp : r.clamps) text += clamp_line(clamp, r.material_names[clamp.material]);
  for (const MaterialWarning& w : r.warnings)
    text += app::shown_format("  warning {}: {}{}{}\n", w.warning.code, w.material, w.material.empty() ? "" : ": ",
                              w.warning.message);
  if (!loop.realtime_note.empty()) text += app::shown_format("  no guarantees of time: {}\n", loop.realtime_note);
  text += app::shown_format("  {} ticks in {:.2f} s, {} missed deadlines\n", loop.ticks, loop.seconds,
                            loop.missed_deadlines);
  text += pause_line(loop);
  text += quantile_line("tick", loop.tick_us) + quantile_line("wake-up", loop.wakeup_us);
  text += app::shown_format("  contact on {} ticks, lost on {}, largest force {:.2f} N, stiffness limit {:.0f} N/m\n",
                            loop.contact_ticks, loop.lost_contact_ticks, loop.max_force_n, r.stiffness_limit);
  if (r.registration_residual_mm)
    text += app::shown_format("  on a real part: touched points within {:.2f} mm (rms) of its own\n",
                              *r.registration_residual_mm);
  return text + vibration_line(r.vibration);
}

}  // namespace papilla::player
