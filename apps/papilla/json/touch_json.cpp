// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/touch_json.hpp"

#include <cmath>

namespace papilla::app {
namespace {

Json difference_json(const std::optional<double>& difference) {
  if (!difference) return nullptr;
  return std::isfinite(*difference) ? Json(*difference) : Json("infinite");
}

const char* name_of(PairVerdict verdict) {
  if (verdict == PairVerdict::told_apart) return "told_apart";
  return verdict == PairVerdict::alike ? "alike" : "unknown";
}

Json relief_json(const FeltWaves& felt, const ReliefSaving& saving) {
  Json json{{"frequencies_hz", {felt.slowest_hz, felt.fastest_hz}}, {"receptors", Json::array()}};
  for (const ReceptorShare& share : felt.receptors)
    json["receptors"].push_back({{"name", share.receptor},
                                 {"variance_share", share.variance_share},
                                 {"times_threshold", share.times_threshold}});
  json["times_threshold"] = felt.times_threshold;
  json["most_times_threshold"] = felt.most_times_threshold;
  json["roughness"] = felt.roughness;
  json["finest_felt_mm"] = felt.finest_felt_mm > 0 ? Json(felt.finest_felt_mm) : Json(nullptr);
  json["may_be_left_out"] = felt.may_be_left_out;
  json["size"] = {saving.width, saving.height};
  json["needed_size"] = {saving.needed_width, saving.needed_height};
  json["bytes"] = saving.bytes;
  json["needed_bytes"] = saving.needed_bytes;
  return json;
}

}  // namespace

Json touch_json(const TouchReport& report) {
  const TouchOptions& options = report.options;
  Json json{{"speed_m_per_s", options.speed_m_per_s},
            {"speeds_m_per_s", {options.slow * options.speed_m_per_s, options.fast * options.speed_m_per_s}}};
  for (const char* list : {"weber", "receptors", "materials", "pairs"}) json[list] = Json::array();
  for (const WeberFraction& weber : weber_fractions())
    json["weber"].push_back({{"quantity", weber.name},
                             {"unit", weber.unit},
                             {"fraction", weber.fraction},
                             {"noise", weber.noise},
                             {"source", weber.source}});
  for (const TouchReceptor& receptor : k_touch_receptors)
    json["receptors"].push_back({{"name", receptor.name},
                                 {"senses", receptor.senses},
                                 {"low_hz", receptor.low_hz},
                                 {"high_hz", receptor.high_hz}});
  for (const FeltMaterial& material : report.materials)
    json["materials"].push_back(
        {{"name", material.name},
         {"stiffness", material.stiffness},
         {"damping", material.damping},
         {"static_friction", material.static_friction},
         {"dynamic_friction", material.dynamic_friction},
         {"relief", material.felt ? relief_json(*material.felt, report.savings.at(material.name)) : Json(nullptr)}});
  for (const MaterialPair& pair : report.pairs) {
    Json line{{"a", report.materials[pair.a].name}, {"b", report.materials[pair.b].name}};
    for (std::size_t k = 0; k < k_touch_quantities; ++k)
      line[std::string(weber_fractions()[k].name)] = difference_json(pair.difference[k]);
    line["verdict"] = name_of(pair.verdict);
    line["reason"] = pair.reason;
    json["pairs"].push_back(std::move(line));
  }
  return json;
}

Json touch_survey_json(const TouchSurvey& touch) {
  Json json{{"speed_m_per_s", touch.speed_m_per_s},
            {"frequencies_hz", {touch.slowest_hz, touch.fastest_hz}},
            {"receptors", Json::array()}};
  for (std::size_t i = 0; i < k_touch_receptors.size(); ++i)
    json["receptors"].push_back({{"name", k_touch_receptors[i].name}, {"variance_share", touch.receptor_shares[i]}});
  json["unfelt_share"] = touch.unfelt_share;
  json["needed_size"] = {touch.needed_width, touch.needed_height};
  return json;
}

}  // namespace papilla::app
