// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/fit_json.hpp"

#include <cmath>

#include "json/scene_json.hpp"
#include "shown_format.hpp"
#include "text/fit_text.hpp"

namespace papilla::app {
namespace {

Json number_json(const std::optional<FittedNumber>& number, double unit = 1) {
  if (!number) return nullptr;
  return {{"value", unit * number->value}, {"low", unit * number->low}, {"high", unit * number->high}};
}

Json roughness_json(const std::optional<FittedRoughness>& roughness) {
  if (!roughness) return nullptr;
  Json json{{"rms_mm", number_json(roughness->rms_m, 1e3)}, {"hurst", number_json(roughness->hurst)}};
  json["dimension"] = nullptr;
  if (const auto& h = roughness->hurst)
    json["dimension"] = {{"value", 3 - h->value}, {"low", 3 - h->high}, {"high", 3 - h->low}};
  json["wavelength_range_mm"] = {1e3 * roughness->shortest_wave_m, 1e3 * roughness->longest_wave_m};
  return json;
}

/// Four digits: more than an interval is ever worth.
double rounded(double value) {
  if (value == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 3);
  return unit >= 1 ? std::round(value / unit) * unit : std::round(value / unit) / std::round(1 / unit);
}

}  // namespace

Json fit_json(const std::string& stroke, const MaterialFit& fit) {
  Json json{{"stroke", stroke},
            {"stiffness", number_json(fit.stiffness)},
            {"damping", number_json(fit.damping)},
            {"static_friction", number_json(fit.static_friction)},
            {"dynamic_friction", number_json(fit.dynamic_friction)},
            {"stribeck_velocity", number_json(fit.stribeck_velocity)},
            {"roughness", roughness_json(fit.roughness)},
            {"not_identified", Json::array()}};
  for (const NotIdentified& missing : fit.not_identified)
    json["not_identified"].push_back({{"parameter", missing.parameter}, {"reason", missing.reason}});
  json["surface"] = fit.surface == StrokeSurface::recorded ? "recorded" : "plane";
  json["normal"] = {fit.normal.x, fit.normal.y, fit.normal.z};
  json["rms_residual_n"] = fit.rms_residual_n;
  json["samples"] = fit.samples;
  json["outliers"] = fit.outliers;
  json["slip_m_per_s"] = Json(nullptr);
  if (fit.fastest_slip_m_per_s > 0) json["slip_m_per_s"] = {fit.slowest_slip_m_per_s, fit.fastest_slip_m_per_s};
  json["stop"] = to_string(fit.stop);
  json["trace"] = trace_json(fit.trace);
  json["warnings"] = fit.warnings;
  return json;
}

Json fitted_materials_json(const std::string& stroke, const std::string& material, const MaterialFit& fit) {
  Json entry = Json::object();
  const auto add = [&](const char* key, const std::optional<FittedNumber>& number) {
    if (number) entry[key] = rounded(number->value);
  };
  add("stiffness", fit.stiffness);
  add("damping", fit.damping);
  add("staticFriction", fit.static_friction);
  add("dynamicFriction", fit.dynamic_friction);
  add("stribeckVelocity", fit.stribeck_velocity);
  entry["$comment"] = shown_format("fitted to {}; 95 % intervals: {}", stroke, fit_intervals(fit));
  return {{"materials", {{material, entry}}}, {"assign", {{{"part", "*"}, {"material", material}}}}};
}

}  // namespace papilla::app
