// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace papilla {
namespace {

constexpr std::array<WeberFraction, k_touch_quantities> k_fractions{{
    {"stiffness", "N/m", 0.23, 0,
     "Jones and Hunter, A perceptual analysis of stiffness, Experimental Brain Research 79, 1990"},
    {"viscosity", "N·s/m", 0.34, 2,
     "Jones and Hunter, A perceptual analysis of viscosity, Experimental Brain Research 94, 1993; "
     "2 N·s/m is the least that was tried"},
    {"friction", "", 0.18, 0,
     "Samur, Colgate and Peshkin, Psychophysical evaluation of a variable friction tactile interface, SPIE 7240, 2009"},
    {"roughness", "times threshold", 0.20, 1,
     "Forta, Griffin and Morioka, Vibrotactile difference thresholds, Somatosensory and Motor Research 29, 2012 "
     "(0.20 to 0.58, the least); roughness as the power of vibration over the threshold: Bensmaia and Hollins, "
     "Pacinian "
     "representations of fine surface texture, Perception and Psychophysics 67, 2005"},
}};

std::string models_of(const MaterialRule& rule) {
  std::string text;
  if (const auto& m = rule.force_model; m && m->name != ForceModelTag{}.name)
    text = fmt::format("{} {} {} {} {}", m->name, m->form, m->amplitude, m->literal, m->level);
  if (const auto& m = rule.friction_model; m && m->name != FrictionTag{}.name)
    text += fmt::format(" {} {}", m->name, m->stiffness);
  return text;
}

/// Whatever the relief of a rule depends on.
std::string pattern_of(const MaterialRule& rule) {
  if (rule.texture.empty()) return "";
  const HeightRule& h = rule.height;
  std::string text =
      fmt::format("{}|{}|{}|{}x{}|{}|{}|{}|{}|{}", rule.texture.string(), rule.recipe, rule.time, rule.size_mm[0],
                  rule.size_mm[1], h.pitch_mm, h.depth_mm.value_or(0), h.opposite, h.scale, h.max_slope.value_or(0));
  text += fmt::format("|{}", h.relief.height.seed);
  for (const auto& image : h.images) text += "|" + image.string();
  return text;
}

double weber_difference(double a, double b, double noise) {
  const double difference = std::abs(a - b), least = std::min(a, b) + noise;
  if (difference == 0) return 0;
  return least > 0 ? difference / least : std::numeric_limits<double>::infinity();
}

bool is_smooth(const FeltMaterial& m) { return m.pattern.empty(); }
/// Its relief is known, and nobody feels it.
bool feels_smooth(const FeltMaterial& m) { return is_smooth(m) || (m.felt && m.felt->most_times_threshold < 1); }

std::optional<double> roughness_of(const FeltMaterial& m) {
  if (m.felt) return m.felt->roughness;
  return is_smooth(m) ? std::optional<double>(0) : std::nullopt;
}

void compare_quantities(const FeltMaterial& a, const FeltMaterial& b, MaterialPair& pair) {
  const auto set = [&](TouchQuantity quantity, double x, double y) {
    const auto k = static_cast<std::size_t>(quantity);
    const double difference = weber_difference(x, y, k_fractions[k].noise);
    pair.difference[k] = std::max(pair.difference[k].value_or(0), difference);
  };
  set(TouchQuantity::stiffness, a.stiffness, b.stiffness);
  set(TouchQuantity::viscosity, a.damping, b.damping);
  set(TouchQuantity::friction, a.static_friction, b.static_friction);
  set(TouchQuantity::friction, a.dynamic_friction, b.dynamic_friction);
  if (a.pattern == b.pattern && a.static_friction == b.static_friction)  // Friction limits slopes, too.
    pair.difference[static_cast<std::size_t>(TouchQuantity::roughness)] = 0;
  else if (const auto x = roughness_of(a), y = roughness_of(b); x && y)
    set(TouchQuantity::roughness, *x, *y);
}

void judge(const FeltMaterial& a, const FeltMaterial& b, MaterialPair& pair) {
  std::string felt;
  for (std::size_t k = 0; k < k_touch_quantities; ++k)
    if (pair.difference[k] && *pair.difference[k] > k_fractions[k].fraction)
      felt += fmt::format("{}{}", felt.empty() ? "" : ", ", k_fractions[k].name);
  if (!felt.empty()) {
    pair.verdict = PairVerdict::told_apart;
    pair.reason = "differs by more than the Weber fraction of " + felt;
    return;
  }
  if (a.models != b.models) {
    pair.reason = "their force or friction models differ, for which no fraction is known";
    return;
  }
  if (a.pattern == b.pattern) {
    pair.verdict = PairVerdict::alike;
    pair.reason = a.pattern.empty() ? "both are smooth, and no constant differs by its Weber fraction"
                                    : "they have one relief, and no constant differs by its Weber fraction";
    return;
  }
  if (feels_smooth(a) && feels_smooth(b)) {
    pair.verdict = PairVerdict::alike;
    pair.reason = "nobody feels their reliefs, and no constant differs by its Weber fraction";
    return;
  }
  const auto is_known = [](const FeltMaterial& m) { return is_smooth(m) || m.felt; };
  if (!is_known(a) || !is_known(b)) {
    pair.reason = "only their reliefs may differ enough, which the bake makes";
    return;
  }
  pair.verdict = PairVerdict::told_apart;
  pair.reason = "their reliefs are different and felt";
}

}  // namespace

std::span<const WeberFraction, k_touch_quantities> weber_fractions() { return k_fractions; }

FeltMaterial felt_material(const MaterialRule& rule, const Grain* grain, const TouchOptions& options) {
  const MaterialTag tag = surface_tag(rule, grain, 0);
  FeltMaterial felt{rule.name,       tag.stiffness,    tag.damping, tag.static_friction, tag.dynamic_friction,
                    models_of(rule), pattern_of(rule), {}};
  if (grain == nullptr) return felt;
  std::vector<WaveBand> bands = wave_bands(grain->relief, true);  // A surface repeats it, whether it tiles or not.
  if (grain->height.overlay) add_roughness(bands, *grain->height.overlay);
  felt.felt = measure_felt_waves(bands, options);
  return felt;
}

std::vector<MaterialPair> compare_materials(std::span<const FeltMaterial> materials) {
  std::vector<MaterialPair> pairs;
  for (std::size_t a = 0; a < materials.size(); ++a)
    for (std::size_t b = a + 1; b < materials.size(); ++b) {
      MaterialPair pair{a, b, {}, PairVerdict::unknown, {}};
      compare_quantities(materials[a], materials[b], pair);
      judge(materials[a], materials[b], pair);
      pairs.push_back(std::move(pair));
    }
  return pairs;
}

TouchReport report_touch(const Materials& rules, const std::vector<PartSurface>& surfaces,
                         const std::map<std::string, Grain>& grains, const TouchOptions& options) {
  TouchReport report;
  report.options = options;
  std::set<std::string> used;
  for (const PartSurface& surface : surfaces)
    if (!surface.material.empty() && !surface.is_left_out) used.insert(surface.material);
  for (const std::string& name : used) {
    const auto grain = grains.find(name);
    const Grain* made = grain == grains.end() ? nullptr : &grain->second;
    report.materials.push_back(felt_material(rules.materials.at(name), made, options));
    if (made != nullptr)
      report.savings.emplace(
          name, measure_relief_saving(made->relief, *report.materials.back().felt, made->height_png.bytes.size()));
  }
  report.pairs = compare_materials(report.materials);
  return report;
}

}  // namespace papilla
