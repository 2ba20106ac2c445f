// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/pipeline/materials.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {

/// A value with where it comes from.
template <class T>
struct Sourced {
  T value{};
  std::string source;  ///< A key of LibraryMaterial::sources; empty: estimated.
  std::string note;    ///< Which table, what was measured, how it follows; may be empty.

  bool is_estimated() const { return source.empty(); }
};
using SourcedNumber = Sourced<double>;

/// Words of people, English and German.
struct BilingualWords {
  std::vector<std::string> en, de;
};

/// What lies below a soft layer: beyond `depth_mm` of penetration the surface has this stiffness.
struct LibraryBacking {
  SourcedNumber stiffness;  ///< N/m
  SourcedNumber depth_mm;
};

/// The visible grain: exactly one of recipe, grain and picture.
struct LibraryRelief {
  std::string recipe;              ///< Of `papilla texture`, in full: no recipe file is needed beside it.
  std::optional<GrainKind> grain;  ///< Of `papilla synthesize grain`.
  std::uint64_t seed = 1;          ///< Of the grain.
  std::filesystem::path picture;   ///< A photograph beside the file or below it.
  std::string process;             ///< How the photograph was taken; may be empty.
  SourcedNumber size_mm[2];        ///< Width and height of one repeat.
  SourcedNumber depth_mm;          ///< Peak to valley.
  bool is_shown = false;           ///< Its picture is the base colour (wood, stone).
};

/// What is finer than the grain, under the names of the haptic tag's version 2.
struct LibraryRoughness {
  SourcedNumber hurst;                  ///< In (0, 1).
  SourcedNumber rms_m;                  ///< Root mean square height.
  SourcedNumber wavelength_range_m[2];  ///< Shortest, longest.
};

struct LibraryAppearance {
  Sourced<std::string> color;         ///< "#rrggbb", sRGB.
  SourcedNumber roughness, metallic;  ///< Of glTF's metallic-roughness model.
};

/// One material of the library, in the units and under the names of MATERIALS.json and the haptic tag.
/// docs/materials-library.md explains the file, library-material.schema.json is its JSON Schema.
struct LibraryMaterial {
  std::string id;  ///< "leather/nappa-fine": the file's path in the library without ".json".
  std::filesystem::path file;
  std::string name_en, name_de;
  BilingualWords aliases, categories, uses;  ///< `uses`: parts that are made of it.
  SourcedNumber stiffness;                   ///< N/m
  SourcedNumber damping;                     ///< N·s/m
  SourcedNumber static_friction, dynamic_friction;
  SourcedNumber stribeck_velocity;              ///< m/s
  std::optional<SourcedNumber> youngs_modulus;  ///< Pa, of what yields under a finger: of the foam below a thin skin.
  std::optional<LibraryBacking> backing;
  std::optional<LibraryRelief> relief;
  std::optional<LibraryRoughness> roughness;
  LibraryAppearance appearance;
  std::map<std::string, std::string> sources;  ///< Citations by key.
};

/// A number of a material: the path of its key, its value as text, and where it comes from.
struct LibraryNumber {
  std::string key;  ///< "stiffness", "backing/depth_mm"
  std::string value;
  std::string source;  ///< A key of sources; empty: estimated.
  std::string note;
};

/// All numbers of a material, the colour included, in the order of the file.
std::vector<LibraryNumber> numbers_of(const LibraryMaterial& material);

/// "library:leather/nappa-fine" begins with it.
inline constexpr std::string_view k_library_prefix = "library:";

/// Whether a text may be an id: words of a-z, 0-9 and '-' joined by '/'.
bool is_library_id(std::string_view text) noexcept;

/// Reads the file of one material. Unknown keys, values out of range, numbers that neither name a source of the file
/// nor are marked as estimated, sources that no number names, and a friction that falls below its dynamic one are
/// refused.
/// @param folder  of the library; the rest of the path is the id.
/// @throws IoError, InvalidInput naming the file and the JSON pointer of the offending value.
LibraryMaterial read_library_material(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The rule that MATERIALS.json would have with the material's numbers written out. Young's modulus has no place
/// there. @param name of the rule.
MaterialRule rule_of(const LibraryMaterial& material, const std::string& name);

/// Stiffness in N/m with which a device renders a solid of Young's modulus E, so that soft things differ as they do
/// under a finger and hard ones are as hard as is sensible:
///
///     k = 1 / (1/K + 1/k_H),  k_H = (6 E*² R F)^(1/3),  E* = E / (1 − ν²)
///
/// k_H is the stiffness of Hertz's contact of a fingertip, a ball of R = 8 mm, at F = 1 N, with Poisson's ratio
/// ν = 0.3 for all; K = 2500 N/m stands for what no hand tells from a wall. Monotonic, below K.
/// Hertz, Über die Berührung fester elastischer Körper, 1881. @pre E > 0 pascal.
double rendered_stiffness(double youngs_modulus_pa);

}  // namespace papilla
