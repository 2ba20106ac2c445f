// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/sheet_sides.hpp"

namespace papilla {

class StageCache;

/// "inside", "both_sides_seen" and so on, as in reports.
std::string_view to_string(Viewpoint viewpoint) noexcept;
std::string_view to_string(SideReason reason) noexcept;

/// Options of turn_sheets().
struct SceneSideOptions {
  bool keep = false;           ///< Sheets stay as they are and are not looked at.
  std::optional<Vec3> inside;  ///< A point where people are, mm in the scene's frame; not given: it is looked for.
  /// Parts without material get one where a sheet must be seen from both sides. Only glTF has a place for that.
  bool add_materials = true;
  Deadline deadline = {};             ///< After it sheets stay as they are.
  const StageCache* cache = nullptr;  ///< Remembers find_sides().
};

/// The sheets of one part: its pieces with a border.
struct PartSides {
  std::string part;
  std::size_t open_components = 0;
  std::size_t facing_away = 0;       ///< Of these: show their back to those who see them.
  std::size_t ambiguous = 0;         ///< Of these: have no side.
  std::size_t turned_triangles = 0;  ///< To make all but the ambiguous ones face those who see them.
  std::vector<SideReason> reasons;   ///< Of all of them, each once, ascending.
  std::size_t left_facing_away = 0, left_ambiguous = 0;  ///< Of the above: those that leave_sheets() left as they are.
};

/// The sheets of one part, triangle by triangle.
struct PartSheets {
  std::uint32_t part = 0;
  std::vector<SheetSide> sheets;
  std::vector<std::uint8_t> turn;  ///< As MeshSheets::turn.
};

/// What is known of the sides of a scene's sheets.
struct SceneSides {
  Viewpoint viewpoint = Viewpoint::none;
  Vec3 eye;                      ///< Of Viewpoint::inside and Viewpoint::room, mm in the scene's frame.
  double enclosure = 0;          ///< Of Viewpoint::room.
  std::vector<PartSides> parts;  ///< Those with sheets, in the order of Scene::parts.
  std::size_t open_components = 0, facing_away = 0, ambiguous = 0;  ///< Of all parts.
  std::vector<PartSheets> sheets;                                   ///< Of `parts`.
  std::string skipped;  ///< Why nothing was looked at, though it was to be: coordinates beyond what sight lines carry,
                        ///< or no time was left.
  double seconds = 0;
};

/// find_sheet_sides() of the parts that nodes show, at its cost; those with a material that is blended hide nothing.
/// @param view Where eyes can be; counts when `inside` is not given.
/// @throws InvalidInput as instances().
SceneSides find_sides(const Scene& scene, const SceneSideOptions& options = {}, std::span<const Volume> view = {});

/// A part and a slot of its materials (TriangleMesh::material).
using PartSlot = std::pair<std::uint32_t, std::uint32_t>;

/// Makes the materials of these slots double sided: copies of them, of the same name, where other slots share them.
/// @param add_materials As SceneSideOptions has it.
void show_both_sides(Scene& scene, const std::set<PartSlot>& slots, bool add_materials);

/// Turns the sheets over that face away from those who see them (turn_triangles()), and lets
/// show_both_sides() those of ambiguous ones. Runs before charts are made, so that new uv are not mirrored; uv that a
/// turned sheet has already keep their place and become mirrored.
/// Cost: as find_sides(), and O(triangles).
/// @throws InvalidInput as find_sides().
SceneSides turn_sheets(Scene& scene, const SceneSideOptions& options = {}, std::span<const Volume> view = {});

/// Takes back the turning of the sheets of one part of which no triangle is flagged, and counts them as left.
/// Cost: O(triangles of the part).
/// @param number Index into `sides.parts` and `sides.sheets`. @param flags One a triangle of the part.
void leave_sheets(SceneSides& sides, std::size_t number, const std::vector<std::uint8_t>& flags);

}  // namespace papilla
