// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gltf_file.hpp"
#include "papilla/io/gltf_edit.hpp"

namespace papilla {

/// Mesh and number within it.
using PrimitiveNumber = std::pair<std::uint32_t, std::uint32_t>;

/// What primitives want; those that are missing stay as they are.
using WantedEdits = std::map<PrimitiveNumber, const GltfSurfaceEdit*>;

/// A use of a material: by a primitive, by one of its variants, or as a coarser level of that material.
struct MaterialUse {
  PrimitiveNumber primitive;
  std::optional<std::size_t> mapping;  ///< Of KHR_materials_variants.
  bool is_level = false;               ///< MSFT_lod of a material names it.
};

/// Uses of one material of the file that become one material by one edit.
struct EditedMaterial {
  std::optional<std::size_t> original;  ///< Nothing: the default material.
  const GltfSurfaceEdit* edit = nullptr;
  std::vector<MaterialUse> uses;
  std::size_t number = 0;       ///< In the file written.
  int channel = 0;              ///< Of the edit's pictures and tag.
  bool has_normal_map = false;  ///< That of the edit.
};

/// Edits the materials of the file, and what primitives name them, by what primitives want.
/// @param notes  gets what could not be done.
/// @throws InvalidInput as write_edited_gltf().
std::vector<EditedMaterial> edit_materials(GltfFile& file, const WantedEdits& wanted, std::vector<std::string>& notes);

}  // namespace papilla
