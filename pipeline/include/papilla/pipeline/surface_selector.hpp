// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/gltf_origin.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// Says by the names that people see which surfaces are meant. All that is given must fit.
///
/// Names are shell patterns of the whole name (matches_glob()); `node` is one of a path (matches_path_glob()).
struct SurfaceSelector {
  std::optional<std::string> part;           ///< As listed: the mesh's name, or the path of its first node without one.
  std::optional<std::string> mesh;           ///< Of glTF's mesh, of OBJ's object or group, of a CAD product or body.
  std::optional<std::string> node;           ///< Path of the node that shows the part: "cockpit/seat*/cushion".
  std::optional<std::string> instance;       ///< That node's own name.
  std::optional<std::string> assembly;       ///< Name of any node above it.
  std::optional<std::string> layer;          ///< Of a CAD file, of the part or of a node from it up.
  std::optional<std::string> cad_material;   ///< Name of the physical material, of the part or of a node from it up.
  std::optional<std::string> cad_colour;     ///< "#rrggbb", sRGB, of the part or face.
  std::optional<std::string> gltf_material;  ///< Name of the material in the scene.
  std::vector<SurfaceSelector> except;       ///< "not": what any of these fits is not meant.

  bool is_empty() const;
};

/// The triangles of one part that share a material, where one node shows them, with the names they go by.
struct SurfacePlace {
  std::uint32_t part = 0, slot = 0;
  std::optional<std::uint32_t> node;   ///< None when nothing shows the part.
  std::optional<std::uint32_t> level;  ///< Its number, when a coarser level of detail shows the part.
  std::vector<std::string> parts, meshes, nodes, instances, assemblies, layers, cad_materials, colours, materials;
};

/// A key of a selector in a settings file: its pattern, the names that it is compared with, and how.
struct SelectorKey {
  enum class Kind { glob, path_glob, colour };
  std::string_view name;
  std::optional<std::string> SurfaceSelector::*pattern;
  std::vector<std::string> SurfacePlace::*names;
  Kind kind;
};

/// All keys that have a pattern; "not" has none.
std::span<const SelectorKey> selector_keys() noexcept;

/// All places of a scene: nodes depth first, then coarser levels of detail, which go by the names of the finest, then
/// the parts that nothing shows; slots ascending.
/// Cost: O(uses x slots x depth), each with its names.
/// @throws InvalidInput as instances().
std::vector<SurfacePlace> surface_places(const Scene& scene, std::span<const GltfOrigin::Level> levels = {});

/// Cost: O(keys given x names of the place), exceptions included.
bool fits(const SurfaceSelector& selector, const SurfacePlace& place);

/// "part 'dash*', not layer 'hidden'": the selector in words.
std::string text_of(const SurfaceSelector& selector);

/// Why a selector fits none of the places: "part 'dahs_*' matches nothing; did you mean 'dash_skin'?".
/// Cost: O(keys given x places). @pre It fits none.
std::string reason_for_nothing(const SurfaceSelector& selector, const std::vector<SurfacePlace>& places);

/// What a rule, or a layer, took of a scene as it was read. A surface is the triangles of one part that share a
/// material.
struct RuleUse {
  std::string selector;      ///< What it is for, in words.
  std::size_t surfaces = 0;  ///< Of which it took some use.
  std::size_t uses = 0;      ///< Of them, with every instance counted.
  std::string problem;       ///< Why it took none, with near names; empty when it took some.
};

/// The problems of those that took nothing, a line each: "rule 3 (/assign/2): part 'x' matches nothing".
std::vector<std::string> problems_of(const std::vector<RuleUse>& uses, const std::string& what,
                                     const std::string& pointer);

/// A part that became several because its uses are not treated alike.
struct SplitPart {
  std::uint32_t part = 0, original = 0;  ///< The new one, behind all others, and the one it was made of.
};

/// A scene whose surfaces are labelled, every part the same at all of its uses.
struct LabelledParts {
  std::vector<std::vector<std::uint32_t>> labels;  ///< Of every part, by slot.
  std::vector<SplitPart> split;                    ///< Ascending by part.
};

/// Makes parts whose uses get different labels several parts, one for each way they are labelled, and lets the nodes
/// and levels show those. The first use keeps the part; the ids of the others are the paths of their first nodes.
/// Cost: O(places log places), and a copy of a mesh for each part that is made.
/// @param places surface_places() of the scene. @param label Of each place.
LabelledParts split_by_label(Scene& scene, const std::vector<SurfacePlace>& places,
                             const std::vector<std::uint32_t>& label, std::span<GltfOrigin::Level> levels = {});

}  // namespace papilla
