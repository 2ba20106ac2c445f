// SPDX-License-Identifier: MIT
#include "papilla/pipeline/assignment.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "papilla/io/node_places.hpp"

namespace papilla {
namespace {

/// What one rule fits, and what it took.
struct RuleCount {
  std::set<std::pair<std::uint32_t, std::uint32_t>> fitting, taken;  ///< Part and slot.
  std::size_t uses = 0;
};

std::string problem_of(const AssignRule& rule, const RuleCount& count, const std::vector<SurfacePlace>& places) {
  if (!count.taken.empty()) return "";
  if (count.fitting.empty()) return reason_for_nothing(rule, places);
  return fmt::format("{} takes nothing: rules before it take all {} surfaces that it matches", text_of(rule),
                     count.fitting.size());
}

/// The first rule that fits a place; rules.assign.size() when none does.
std::size_t first_fitting(const Materials& rules, const SurfacePlace& place) {
  return static_cast<std::size_t>(std::find_if(rules.assign.begin(), rules.assign.end(),
                                               [&](const AssignRule& rule) { return fits(rule, place); }) -
                                  rules.assign.begin());
}

/// Which parts' patterns in the rules' unwrap mean the part of this name: parts that differ there are unwrapped apart.
std::string named_by_unwrap(const std::vector<const MaterialRule*>& rules, const std::string& part) {
  std::string named;
  for (const MaterialRule* rule : rules)
    if (rule && rule->unwrap_options)
      for (const std::string& pattern : named_parts(*rule->unwrap_options))
        named += is_for_part(pattern, part) ? '1' : '0';
  return named;
}

}  // namespace

bool assigns_groups_apart(const Scene& scene, const Materials& rules, std::span<const std::uint32_t> groups) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> material_of;  // By group and slot.
  for (const SurfacePlace& place : surface_places(scene)) {
    if (!place.node) continue;
    const std::size_t rule = first_fitting(rules, place);
    const std::string material = rule < rules.assign.size() ? rules.assign[rule].material : "";
    if (material_of.try_emplace({groups[*place.node], place.slot}, material).first->second != material) return true;
  }
  return false;
}

Assignment assign_materials(Scene& scene, const Materials& rules, std::span<GltfOrigin::Level> levels) {
  std::map<std::string, std::uint32_t> label_of{{"", 0}};
  std::vector<const MaterialRule*> rule_of_label{nullptr};
  for (const auto& [name, rule] : rules.materials) {
    label_of[name] = static_cast<std::uint32_t>(rule_of_label.size());
    rule_of_label.push_back(&rule);
  }
  const std::vector<SurfacePlace> places = surface_places(scene, levels);
  std::vector<RuleCount> counts(rules.assign.size());
  std::vector<std::uint32_t> labels(places.size(), 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    bool is_taken = false;
    for (std::size_t r = 0; r < rules.assign.size(); ++r) {
      if (!fits(rules.assign[r], places[i])) continue;
      const std::pair surface{places[i].part, places[i].slot};
      counts[r].fitting.insert(surface);
      if (std::exchange(is_taken, true)) continue;
      counts[r].taken.insert(surface);
      ++counts[r].uses;
      labels[i] = label_of.at(rules.assign[r].material);
    }
  }
  Assignment result;
  for (std::size_t r = 0; r < rules.assign.size(); ++r)
    result.uses.push_back({text_of(rules.assign[r]), counts[r].taken.size(), counts[r].uses,
                           problem_of(rules.assign[r], counts[r], places)});
  LabelledParts labelled = split_by_label(scene, places, labels, levels);
  result.split = std::move(labelled.split);
  for (const std::vector<std::uint32_t>& slots : labelled.labels) {
    std::vector<const MaterialRule*>& assigned = result.parts.emplace_back().rules;
    for (const std::uint32_t label : slots) assigned.push_back(rule_of_label[label]);
  }
  for (const SplitPart& split : result.split)
    result.parts[split.part].is_split = result.parts[split.original].is_split = true;
  return result;
}

std::vector<SharedPart> share_identical_parts(Scene& scene, Assignment& assignment) {
  std::map<std::pair<std::vector<const MaterialRule*>, std::string>, std::uint64_t> numbers;
  const std::vector<SharedPart> shared = share_identical_parts(scene, [&](std::uint32_t part) {
    const std::vector<const MaterialRule*>& rules = assignment.parts.at(part).rules;
    return numbers.try_emplace({rules, named_by_unwrap(rules, shown_name(scene.parts[part]))}, numbers.size())
        .first->second;
  });
  std::set<std::uint32_t> copies;
  for (const SharedPart& part : shared) copies.insert(part.number);
  std::vector<AssignedPart> kept;
  for (std::uint32_t p = 0; p < assignment.parts.size(); ++p)
    if (!copies.contains(p)) kept.push_back(std::move(assignment.parts[p]));
  assignment.parts = std::move(kept);
  return shared;
}

}  // namespace papilla
