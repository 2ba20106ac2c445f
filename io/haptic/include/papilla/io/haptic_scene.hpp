// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/device.hpp"
#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// A warning and its material; empty for the file.
struct MaterialWarning {
  std::string material;
  HapticWarning warning;
};

/// Depth below a relief as far as the force has no choice between several closest points; see HeightField::rounded().
inline constexpr double k_felt_depth_m = 2e-3;

/// Limits of the device; what it cannot reach or carry is left out.
struct HapticSceneOptions {
  double probe_radius_m = k_default_probe_radius_m;
  double felt_depth_m = k_felt_depth_m;  ///< 0: peaks stay as sharp as they are.
  double shortest_wave_m = 0;            ///< Shortest wavelength of a relief, 2·speed/rate; 0 keeps all.
  bool overlay = true;                   ///< Lay the roughness of tags of version 2 over their maps.
  /// Triangles farther than reach_m from every one of these points are left out. Empty: none.
  std::vector<Vec3> reach_around = {};
  double reach_m = 0;
  std::filesystem::path tags = {};  ///< As GltfReadOptions::tags; for load_haptic_scene().
};

/// The haptic part of a scene: the triangles of tagged materials, in metres, in the frame of the file.
struct HapticScene {
  ContactMesh mesh;
  std::vector<ContactMaterial> materials;
  std::vector<std::string> names;  ///< Of the materials.
  std::vector<HeightField> heights;
  std::vector<ChannelField> channels;
  double probe_radius_m = 0;  ///< By which the reliefs are dilated; that of the ContactSurface must be the same.
  int maps_loaded = 0, maps_missing = 0, maps_coarsened = 0;
  int roughness_overlays = 0;                     ///< Maps over which roughness was laid.
  int channels_loaded = 0, channels_missing = 0;  ///< Pictures of stiffness, friction and damping.
  std::size_t triangles_out_of_reach = 0;
  TagSurvival tags;
  std::vector<MaterialWarning> warnings;
};

/// Reads the tags and height maps, lays the roughness of tags of version 2 over their maps, synthesises reliefs from
/// `roughness` where a map is missing (warning height_from_roughness; height_lost when there is no roughness), and
/// collects the triangles.
///
/// A relief is felt as a ball of radius r feels it that is pressed as deep as D, the felt depth: its peaks are rounded
/// to a radius of D − r, and it is dilated by r. So up to that depth there is one closest point, and the force along a
/// stroke is as steady as the relief; on sharper peaks a difference of a micrometre decides where the probe slips off.
/// Reliefs of stimuli displace nothing and stay as they are. Where a map is steeper than 1/μ, μ the static friction, a
/// point does not slide; such a map is reported with the share of its area (warning relief_steep).
///
/// Pictures of stiffness, friction and damping are read as they are; where one is lost the constants are used (warning
/// maps_lost).
///
/// Maps of materials that no triangle uses are not read, those of like tags once; maps are halved while they stay fine
/// enough for the shortest wavelength. A KHR_texture_transform of the normal texture (without one: of the base colour)
/// that differs from the tag's, as packers that quantise coordinates write it, replaces the tag's (warning
/// uv_transform). Other codes: those of the tag, tags_missing and tag_restored (Scene::tags), uv_missing,
/// uv_degenerate, probe_dilation.
/// @param path of the file, for messages and for sidecar files next to it.
/// @throws InvalidInput naming `path` when no tagged material has triangles, or none is within reach.
HapticScene haptic_scene(const Scene& scene, const std::filesystem::path& path, const HapticSceneOptions& options = {});

/// The same of a glTF file, primitive by primitive: the meshes of the scene are never in memory, and its attributes are
/// ContactMesh::vertex_uv and vertex_normals. Peak: the file, what its largest primitive draws (32 bytes a vertex and
/// 12 a triangle at most) and the result (24 to 44 bytes a vertex and 16 a triangle).
/// @throws IoError, InvalidInput as read_gltf() does.
HapticScene load_haptic_scene(const std::filesystem::path& path, const HapticSceneOptions& options = {});

/// The material with the largest area, and the centroid of that area.
struct LargestMaterial {
  std::uint32_t material = 0;
  Vec3 centre;
};
LargestMaterial largest_material(const HapticScene& scene);

}  // namespace papilla
