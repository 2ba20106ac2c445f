// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/channel_field.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

struct HeightMap;

/// A defect of a tag or its height map, and the fallback.
struct HapticWarning {
  std::string code;     ///< Stable, for scripts: "tag_version", "height_sha256", ...
  std::string message;  ///< One line: place, value, fallback.
};

/// A picture of a tag: where its bytes are, and how it lies on a surface.
struct PlacedPicture {
  std::string uri;     ///< Sidecar file next to the glTF, or a data: URI; may be empty.
  std::string image;   ///< Name of an image in the glTF; may be empty.
  std::string sha256;  ///< Of the PNG's bytes, 64 hexadecimal digits. Pictures with another sum are not used.
  int bits = 16;       ///< A sample.
  std::array<int, 2> size{0, 0};  ///< Width, height in samples; 0: not given.
  int tex_coord = 0;
  UvTransform uv_transform;
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
  friend bool operator==(const PlacedPicture&, const PlacedPicture&) = default;

  bool is_embedded() const { return uri.starts_with("data:"); }
};

/// Location and units of a material's height map: height = offset + scale · v / 65535 metres along the outward normal,
/// v the 16-bit sample, linear.
struct HeightTag : PlacedPicture {
  std::string channel = "r";
  double scale_m = 0;
  double offset_m = 0;
  bool white_is_outward = true;  ///< "outward": "white" or "black".
  Vec2 metres_per_uv{1, 1};      ///< Metres on the surface per unit of uv before the transform.
  double rms_m = 0;              ///< Root mean square of the height around its mean; 0: not given.
  friend bool operator==(const HeightTag&, const HeightTag&) = default;
};

/// Maps of what the constants say of the whole surface: one picture, a quantity a channel. Version 2.
struct MapsTag : PlacedPicture {
  std::array<std::optional<MapChannel>, 3> channels;  ///< Red, green, blue; no two of the same quantity.
  friend bool operator==(const MapsTag&, const MapsTag&) = default;
};

/// What lies below the skin, whose stiffness is the material's. Version 2.
struct BackingTag {
  double stiffness = 0;  ///< N/m, ≥ 0.
  double depth_m = 0;    ///< Where it is reached, ≥ 0.
  friend bool operator==(const BackingTag&, const BackingTag&) = default;
};

/// Statistics of a rough surface: of the relief, from which the player synthesises one when the map is lost, or, with
/// `overlay`, of what is to be laid over the map.
struct RoughnessTag {
  std::optional<double> fractal_dimension;  ///< In [2, 3]; nothing where no power law holds.
  double rms_height_m = 0;
  Vec2 wavelength_range_m{2e-4, 2e-2};  ///< Shortest, longest.
  double anisotropy = 1;                ///< Along `direction` waves are that many times as long as across, ≥ 1.
  double direction = 0;                 ///< Radians, from u towards v, as the map's rows and columns run.
  bool overlay = false;                 ///< The map does not hold it: version 2.
  friend bool operator==(const RoughnessTag&, const RoughnessTag&) = default;
};

/// The force model, when it is not the displaced surface.
struct ForceModelTag {
  std::string name = "heightfield";  ///< A name of force_model().
  double amplitude = 0.01;           ///< A: N per grey level, or per grey level and pixel.
  bool literal = false;              ///< "sign": "literal": lateral forces push uphill.
  std::string form;                  ///< A name of stimulus_form(); empty: the first one of the model.
  int level = 8;                     ///< Of a graph's detail, 1 to 8: 2^level pieces.
  friend bool operator==(const ForceModelTag&, const ForceModelTag&) = default;
};

/// The friction model, when it is not Coulomb's.
struct FrictionTag {
  std::string name = "coulomb";  ///< A name of friction_model().
  double stiffness = 0;          ///< N/m, of bristles, ≥ 0; 0: that of the material.
  friend bool operator==(const FrictionTag&, const FrictionTag&) = default;
};

struct SymmetryTag {
  std::string group;               ///< Wallpaper group, for example "pmm".
  std::array<Vec2, 2> period_m{};  ///< The two lattice vectors.
  friend bool operator==(const SymmetryTag&, const SymmetryTag&) = default;
};

struct ProvenanceTag {
  std::string tool, source, plan;
  friend bool operator==(const ProvenanceTag&, const ProvenanceTag&) = default;
};

/// materials[i].extras.haptic of a glTF file, version 1 or 2, in SI units. A tag is written as version 2 where it has
/// what version 1 does not: roughness that is laid over the map, maps, a backing. docs/haptic-material.md explains it
/// and haptic-material.schema.json is its JSON Schema. The values here are the defaults of the tag.
struct MaterialTag {
  static constexpr int k_newest_version = 2;
  double stiffness = 500;           ///< N/m, ≥ 0; of the skin where there is a backing.
  double damping = 0;               ///< N·s/m, ≥ 0.
  double static_friction = 0;       ///< ≥ 0. Defaults to dynamic_friction when only that is given.
  double dynamic_friction = 0;      ///< In [0, static_friction]. Defaults to static_friction when only that is given.
  double stribeck_velocity = 0.01;  ///< m/s, > 0.
  std::optional<FrictionTag> friction_model;
  bool force_shading = false;  ///< Where there is no relief; see ContactSurface::shaded_normal().
  std::optional<HeightTag> height;
  std::optional<MapsTag> maps;  ///< On the texture coordinates of `height`; the constants are for where it is lost.
  std::optional<BackingTag> backing;
  std::optional<RoughnessTag> roughness;
  std::optional<ForceModelTag> force_model;
  std::optional<SymmetryTag> symmetry;
  std::optional<ProvenanceTag> provenance;
  std::string other_json;  ///< A JSON object of the members that the versions do not define, or empty.
  friend bool operator==(const MaterialTag&, const MaterialTag&) = default;
};

/// The pictures of a tag, height first.
std::vector<PlacedPicture*> pictures_of(MaterialTag& tag);

/// The texture coordinates that its pictures lie on; nothing without any.
std::optional<int> tex_coord_of(const MaterialTag& tag) noexcept;

/// The largest static friction of a place: of the maps, else the constant.
double largest_static_friction(const MaterialTag& tag) noexcept;

/// A relief as it is stored: 16-bit grey samples v with h = offset_mm + scale_mm · v / 65535.
struct EncodedRelief {
  std::span<const std::byte> png;
  double scale_mm = 0, offset_mm = 0;
  double rms_mm = 0;     ///< Root mean square of the height around its mean.
  std::string uri = {};  ///< Of the PNG next to the glTF; empty: the tag holds it as a data: URI.
};

/// The height member of a tag, in SI units: size and pitch of `relief`, numbers and SHA-256 of the picture. uv is 1 per
/// repeat of the map, without a transform. A data: URI in extras survives tools that drop images no texture uses.
HeightTag make_height_tag(const HeightMap& relief, const EncodedRelief& encoded);

/// Channel samples as they are stored: an RGB picture of 8 or 16 bits a sample.
struct EncodedMaps {
  std::span<const std::byte> png;
  int width = 0, height = 0, bits = 8;
  std::array<std::optional<MapChannel>, 3> channels;
};

/// The maps member of a tag, with the picture as a data: URI.
MapsTag make_maps_tag(const EncodedMaps& encoded);

/// Reads one tag. Unknown members are kept in other_json. A value of the wrong type or range is reported and replaced
/// by its default: codes tag_stiffness, tag_damping, tag_friction, tag_stribeck, tag_height (no relief when its scale
/// or offset is no number), tag_height_bits, tag_height_sha256, tag_height_uv, tag_maps (a channel that is none or can
/// be out of range, a picture on other coordinates than the relief: no map), tag_maps_sha256, tag_backing,
/// tag_roughness, tag_force_model, tag_friction_model, tag_force_shading, tag_symmetry, tag_provenance. Then
/// limit_relief() applies (tag_limits.hpp).
/// @param json the object itself, not the extras around it.
/// @throws InvalidInput when it is no JSON object, of another version than 1 and 2, or has neither stiffness nor
/// height.
MaterialTag parse_material_tag(std::string_view json, std::vector<HapticWarning>& warnings);

/// Moves the tag out of a material's extras, which keep their other members. A tag that parse_material_tag() refuses,
/// and extras that are no JSON, are reported as tag_refused, stay where they are and give none.
std::optional<MaterialTag> take_material_tag(std::string& extras_json, std::vector<HapticWarning>& warnings);

/// The tag as compact JSON; parse_material_tag() gives the same value back, bit for bit.
std::string to_json(const MaterialTag& tag);

}  // namespace papilla
