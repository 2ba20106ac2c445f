// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/shared_parts.hpp"
#include "papilla/pipeline/surface_selector.hpp"

namespace papilla {

/// What the surfaces of a part get.
struct AssignedPart {
  std::vector<const MaterialRule*> rules;  ///< By slot; nullptr: left alone.
  bool is_split = false;                   ///< It shows some of the uses of a part; its name alone does not tell which.

  /// nullptr also for slots beyond the list.
  const MaterialRule* rule_of(std::uint32_t slot) const { return slot < rules.size() ? rules[slot] : nullptr; }
};

/// Which material every surface gets.
struct Assignment {
  std::vector<AssignedPart> parts;
  std::vector<SplitPart> split;  ///< Parts that were made because uses get different materials.
  std::vector<RuleUse> uses;     ///< Of every entry of Materials::assign.
};

/// Assigns every surface the material of the first rule that fits it. Parts whose uses get different ones are split.
/// Cost: O(uses x slots x rules) comparisons, beside surface_places() and split_by_label().
/// @param rules Must stay as long as the result. @param levels Get what the finest level gets; they, too, name the
/// parts that are split. @throws InvalidInput as instances().
Assignment assign_materials(Scene& scene, const Materials& rules, std::span<GltfOrigin::Level> levels = {});

/// Whether nodes of one group would get different materials, at the same cost.
/// @param groups Number of the group of each node, of which all show the same part.
bool assigns_groups_apart(const Scene& scene, const Materials& rules, std::span<const std::uint32_t> groups);

/// Makes identical parts that are assigned the same rules one part, so that each class is baked once. The assignment's
/// parts follow; its list of split ones stays as it was.
std::vector<SharedPart> share_identical_parts(Scene& scene, Assignment& assignment);

}  // namespace papilla
