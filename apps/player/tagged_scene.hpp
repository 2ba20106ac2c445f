// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::player {

/// A warning and the material it is about; empty for the file.
struct MaterialWarning {
  std::string material;
  HapticWarning warning;
};

/// What can be felt of a scene: the triangles of tagged materials, in metres, in the file's frame.
struct TaggedScene {
  ContactMesh mesh;
  std::vector<ContactMaterial> materials;
  std::vector<std::string> names;  ///< Of the materials.
  std::vector<HeightField> heights;
  int maps_loaded = 0, maps_missing = 0;
  std::vector<MaterialWarning> warnings;
};

/// Reads the tags, finds the height maps, makes up reliefs from `roughness` where a map is missing (warning
/// height_from_roughness; height_lost when there is none), widens them by the probe, and gathers the triangles.
/// Other codes: those of the tag, uv_missing, uv_degenerate, probe_dilation.
/// @throws InvalidInput naming `path` when no tagged material has triangles.
TaggedScene tagged_scene(const Scene& scene, const std::filesystem::path& path, double probe_radius_m);

/// The material with the largest area, and the centre of that area.
struct LargestMaterial {
  std::uint32_t material = 0;
  Vec3 centre;
};
LargestMaterial largest_material(const TaggedScene& scene);

}  // namespace papilla::player
