// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// The stages of a bake in the order in which they run. The first five look at a surface's geometry,
/// the next three at the material's picture, the last at both.
enum class Stage { tessellate, repair, charts, unwrap, measure, analyze, height, normal_map, tag };
inline constexpr std::size_t k_stage_count = 9;

/// Which uv the grain of a surface shall have.
enum class UvWish {
  automatic,  ///< Its own where they are usable.
  keep,       ///< Its own, whatever they are like.
  renew       ///< New ones: a method is named, or just new ones are wanted.
};

/// What the user wants of a surface.
struct Wanted {
  bool grain = false;  ///< Its material has a picture of grain.
  bool feel = false;   ///< Its material has haptic constants or grain.
  UvWish uv = UvWish::automatic;
};

/// Why a part is left out: nobody gets at it.
enum class LeftOut { no, unreachable, unseen, unreachable_and_unseen };

/// The reason as reports print it; empty for `no`.
constexpr std::string_view reason_of(LeftOut left_out) {
  switch (left_out) {
    case LeftOut::no: break;
    case LeftOut::unreachable: return "it can't be reached";
    case LeftOut::unseen: return "it can't be seen";
    case LeftOut::unreachable_and_unseen: return "it can neither be reached nor seen";
  }
  return {};
}

/// What the input already gives.
enum class UvState { absent, usable, unusable };
struct Given {
  bool cad = false;  ///< Surfaces come from CAD and were tessellated here.
  UvState uv = UvState::absent;
  bool is_clean = false;           ///< Its mesh is manifold and without defects.
  std::string_view left_out = {};  ///< reason_of() when the part is left out: then nothing but tessellation runs.
  bool is_only_seen = false;       ///< The part stays because it is seen, but it can't be reached.
  bool in_place = false;           ///< The file is edited: triangles stay as they are.
};

struct Decision {
  bool run = false;
  std::string_view reason;
};

/// A stage, its name in reports, and the rule that says whether a surface needs it.
struct StageRule {
  Stage stage;
  std::string_view name;
  Decision (*decide)(const Wanted&, const Given&);
};

namespace stage_rules {

constexpr std::string_view k_no_grain = "no grain is assigned";

constexpr Decision tessellate(const Wanted&, const Given& given) {
  return given.cad ? Decision{true, "the file holds CAD surfaces"}
                   : Decision{false, "the file holds triangles already"};
}

/// Charts and unwrap serve one purpose: uv for the grain.
constexpr Decision new_uv(const Wanted& wanted, const Given& given) {
  if (!given.left_out.empty()) return {false, given.left_out};
  if (!wanted.grain) return {false, k_no_grain};
  if (given.uv != UvState::absent && wanted.uv == UvWish::keep)
    return {false, "its own uv is kept, as the material says"};
  if (given.uv != UvState::absent && wanted.uv == UvWish::renew) return {true, "the material asks for new uv"};
  switch (given.uv) {
    case UvState::usable: return {false, "its own uv is usable and kept"};
    case UvState::unusable: return {true, "its own uv is not usable"};
    case UvState::absent: break;
  }
  return {true, "the grain needs uv and there is none"};
}

constexpr Decision repair(const Wanted& wanted, const Given& given) {
  const Decision uv = new_uv(wanted, given);
  if (uv.run && given.in_place) return {false, "the file is edited in place: its triangles stay"};
  return uv.run && given.is_clean ? Decision{false, "its mesh has no defect"} : uv;
}

constexpr Decision measure(const Wanted& wanted, const Given& given) {
  if (!given.left_out.empty()) return {false, given.left_out};
  return wanted.grain ? Decision{true, "distortion of the grain is reported"} : Decision{false, k_no_grain};
}

constexpr Decision picture(const Wanted& wanted, const Given& given) {
  if (!given.left_out.empty()) return {false, given.left_out};
  return wanted.grain ? Decision{true, "its grain has a picture"} : Decision{false, k_no_grain};
}

constexpr Decision tag(const Wanted& wanted, const Given& given) {
  if (!given.left_out.empty()) return {false, given.left_out};
  if (!wanted.feel) return {false, "no haptic material is assigned"};
  if (given.is_only_seen) return {false, reason_of(LeftOut::unreachable)};
  return {true, "it is to be felt"};
}

}  // namespace stage_rules

inline constexpr std::array<StageRule, k_stage_count> k_stages = {{
    {Stage::tessellate, "tessellate", stage_rules::tessellate},
    {Stage::repair, "repair", stage_rules::repair},
    {Stage::charts, "charts", stage_rules::new_uv},
    {Stage::unwrap, "unwrap", stage_rules::new_uv},
    {Stage::measure, "measure", stage_rules::measure},
    {Stage::analyze, "analyze", stage_rules::picture},
    {Stage::height, "height", stage_rules::picture},
    {Stage::normal_map, "normal_map", stage_rules::picture},
    {Stage::tag, "tag", stage_rules::tag},
}};

/// The decision for every stage, in the order of k_stages.
using SurfacePlan = std::array<Decision, k_stage_count>;

constexpr SurfacePlan make_plan(const Wanted& wanted, const Given& given) {
  SurfacePlan plan{};
  for (std::size_t i = 0; i < k_stage_count; ++i) plan[i] = k_stages[i].decide(wanted, given);
  return plan;
}

constexpr const Decision& decision(const SurfacePlan& plan, Stage stage) {
  return plan[static_cast<std::size_t>(stage)];
}

// The table's order is the enumeration's; decision() relies on it.
static_assert([] {
  for (std::size_t i = 0; i < k_stage_count; ++i)
    if (k_stages[i].stage != static_cast<Stage>(i)) return false;
  return true;
}());

}  // namespace papilla
