// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/pipeline/bake_plan.hpp"
#include "papilla/pipeline/felt_waves.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla {

/// What hands tell materials apart by.
enum class TouchQuantity { stiffness, viscosity, friction, roughness };
inline constexpr std::size_t k_touch_quantities = 4;

/// The least relative difference that is felt.
struct WeberFraction {
  std::string_view name, unit;
  double fraction = 0;
  double noise = 0;  ///< a of Δφ/(φ + a): near it the fraction of φ alone grows (Schulze 2005, 5.2).
  std::string_view source;
};

/// By TouchQuantity.
std::span<const WeberFraction, k_touch_quantities> weber_fractions();

/// A material as a hand meets it.
struct FeltMaterial {
  std::string name;
  double stiffness = 0, damping = 0, static_friction = 0, dynamic_friction = 0;
  std::string models;             ///< Force and friction model where they are not the usual ones, as text.
  std::string pattern;            ///< What its relief is made of; equal ones are equal reliefs. Empty: smooth.
  std::optional<FeltWaves> felt;  ///< Of its relief with the roughness over it; nothing before it is made.
};

/// The material of a rule.
/// @param grain that was made of it; nullptr: none yet, or none at all.
FeltMaterial felt_material(const MaterialRule& rule, const Grain* grain, const TouchOptions& options = {});

enum class PairVerdict { told_apart, alike, unknown };

/// Two materials, and by what they differ.
struct MaterialPair {
  std::size_t a = 0, b = 0;
  /// Weber difference |φa − φb| / (min(φa, φb) + a), by TouchQuantity; infinite where the divisor is 0, nothing where
  /// one is not known. Of the two frictions the larger difference.
  std::array<std::optional<double>, k_touch_quantities> difference;
  PairVerdict verdict = PairVerdict::unknown;
  std::string reason;  ///< One sentence.
};

/// All pairs, in order. Told apart is what differs by more than a Weber fraction, or whose reliefs differ and are felt;
/// alike what does not: nobody tells these apart who feels no finer than the people of the sources. Unknown is what the
/// reliefs decide that are not made yet, and other force or friction models. The divisor is the smaller value, so that
/// neither of the two is the reference. What a device cuts off (stiffness) is not looked at.
std::vector<MaterialPair> compare_materials(std::span<const FeltMaterial> materials);

/// What touch tells of a scene.
struct TouchReport {
  TouchOptions options;
  std::vector<FeltMaterial> materials;
  std::vector<MaterialPair> pairs;
  std::map<std::string, ReliefSaving> savings;  ///< By material; of those with a relief that was made.
};

/// Of the materials that surfaces use. @param grains by material; empty: before the bake.
TouchReport report_touch(const Materials& rules, const std::vector<PartSurface>& surfaces,
                         const std::map<std::string, Grain>& grains, const TouchOptions& options = {});

}  // namespace papilla
