// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// The bytes of a tag's height map: of its data: URI or of the file next to the glTF, else of the image of that name,
/// else of another tag that holds a picture of the same sum. Only bytes with the tag's SHA-256 are accepted. Failures
/// become warnings (height_data_uri, height_file, height_sha256, height_image).
/// @param file      the glTF file.
/// @param material  number of the tag's material in it.
/// @throws InvalidInput, IoError as read_reference(): a URI that leads out of the file's folder or to no PNG picture.
std::optional<std::string> find_height_bytes(const HeightTag& tag, const Scene& scene,
                                             const std::filesystem::path& file, std::size_t material,
                                             std::vector<HapticWarning>& warnings);

/// The same of the picture of a tag's maps (maps_data_uri, maps_file, maps_sha256, maps_image).
std::optional<std::string> find_maps_bytes(const MapsTag& tag, const Scene& scene, const std::filesystem::path& file,
                                           std::size_t material, std::vector<HapticWarning>& warnings);

/// The decoded map; further warnings: height_bits, height_size, and height_image when the bytes are no picture.
/// @throws InvalidInput, IoError as find_height_bytes().
std::optional<HeightField> find_height_map(const HeightTag& tag, const Scene& scene, const std::filesystem::path& file,
                                           std::size_t material, std::vector<HapticWarning>& warnings);

/// The decoded maps; further warnings: maps_bits, maps_size, and maps_image when the bytes are no picture.
/// @param probe_radius_m maps as a ball feels them (channel_average.hpp), with the length of a unit of uv; 0: a point.
/// @throws InvalidInput, IoError as find_height_bytes().
std::optional<ChannelField> find_maps(const MapsTag& tag, const Scene& scene, const std::filesystem::path& file,
                                      std::size_t material, std::vector<HapticWarning>& warnings,
                                      double probe_radius_m = 0, Vec2 metres_per_uv = {});

}  // namespace papilla
