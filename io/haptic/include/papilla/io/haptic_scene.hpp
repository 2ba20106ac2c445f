// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// A warning and the material it is about; empty for the file.
struct MaterialWarning {
  std::string material;
  HapticWarning warning;
};

/// What a device can do with a scene; the rest is left out.
struct HapticSceneOptions {
  double probe_radius_m = 0;
  double shortest_wave_m = 0;  ///< Waves of the relief that are shorter can't be carried: 2·speed/rate. 0 keeps all.
  /// Triangles farther than reach_m from the ways between these points are left out. Empty: nothing is.
  std::vector<Vec3> reach_around = {};
  double reach_m = 0;
};

/// What can be felt of a scene: the triangles of tagged materials, in metres, in the file's frame.
struct HapticScene {
  ContactMesh mesh;
  std::vector<ContactMaterial> materials;
  std::vector<std::string> names;  ///< Of the materials.
  std::vector<HeightField> heights;
  int maps_loaded = 0, maps_missing = 0, maps_coarsened = 0;
  std::size_t triangles_out_of_reach = 0;
  std::vector<MaterialWarning> warnings;
};

/// Reads the tags, finds the height maps, makes up reliefs from `roughness` where a map is missing (warning
/// height_from_roughness; height_lost when there is none), widens them by the probe, and gathers the triangles.
/// Maps of materials that no triangle uses are not read; maps finer than the shortest wave are halved until they
/// aren't. Where a tool has given the normal texture (without one: the base colour) a KHR_texture_transform that
/// differs from the tag's, as packers do that quantise coordinates, that one is followed (warning uv_transform). Other
/// codes: those of the tag, uv_missing, uv_degenerate, probe_dilation.
/// @param path names the file in messages; sidecars are looked for beside it.
/// @throws InvalidInput naming `path` when no tagged material has triangles, or none is within reach.
HapticScene haptic_scene(const Scene& scene, const std::filesystem::path& path, const HapticSceneOptions& options = {});

/// Reads a glTF file for that. @throws IoError, InvalidInput as read_gltf() does.
HapticScene load_haptic_scene(const std::filesystem::path& path, const HapticSceneOptions& options = {});

/// The material with the largest area, and the centre of that area.
struct LargestMaterial {
  std::uint32_t material = 0;
  Vec3 centre;
};
LargestMaterial largest_material(const HapticScene& scene);

}  // namespace papilla
