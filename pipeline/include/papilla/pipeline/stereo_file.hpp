// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/texture/light_sphere.hpp"
#include "papilla/texture/photometric_stereo.hpp"

namespace papilla {

/// Lights of photographs: directions, or a ball in every photograph, or neither: unknown.
struct StereoLights {
  std::vector<Vec3> directions;
  std::optional<LightSphere> sphere;
  std::string source = {};  ///< Where they stand, for messages.
};

/// Reads LIGHTS.json: {"lights": [[x, y, z], …]}, one a photograph in order, to the light, x right, y down, z to the
/// camera, any length, or the list alone; {"lights": "unknown"} or "unknown"; or {"sphere": {"centre_px": [x, y],
/// "radius_px": r, "kind": "mirror" or "matte"}}, where the ball lies in all photographs.
/// @throws IoError; InvalidInput naming file and JSON pointer, also when there are not `photographs` lights.
StereoLights read_lights(const std::filesystem::path& path, std::size_t photographs);

/// A reference in the picture for its scale along the surface or in height.
struct HeightReference {
  enum class Kind { ruler, grid, step, profile, shadow } kind = Kind::ruler;
  double mm = 0;                      ///< Of the ruler, grid or step.
  Vec2 from_px, to_px;                ///< Of a step: low and high; of a shadow: edge and end.
  std::filesystem::path profile_csv;  ///< Columns mm_along, mm_height.
};

/// Reads REF.json: one of {"ruler_mm", "from_px", "to_px"}, {"grid_mm"}, {"step_mm", "low_px", "high_px"},
/// {"profile_csv", "from_px", "to_px"}, {"shadow": {"from_px", "to_px"}} (of the first photograph, from the edge to the
/// end of its shadow), several of them in one object, or a list of such objects. In one object a ruler and a profile
/// lie along the same line. Files are looked for beside REF.json.
/// @throws IoError; InvalidInput naming file and JSON pointer.
std::vector<HeightReference> read_references(const std::filesystem::path& path);

/// Memory for a pixel of height_of_picture_files(), and for one of each photograph.
inline constexpr std::size_t k_stereo_bytes_per_pixel = 220, k_photograph_bytes_per_pixel = 36;

/// Options of height_of_picture_files().
struct StereoFileOptions {
  HeightFileOptions files;  ///< Of `height`: pitch_mm, and depth_mm where `keeps_depth` is false.
  StereoLights lights;
  std::vector<HeightReference> references;
  bool is_depth_given = false;  ///< The result gets files.height.depth_mm, not the depth that was measured.
};

/// What a reference in the picture says.
struct ReferenceReading {
  std::string name;                   ///< ruler, grid, step, profile, shadow.
  double value = 0;                   ///< Pitch in mm, or mm of height per pixel of height.
  std::optional<double> correlation;  ///< Of a profile.
};

/// What relief_of_picture_files() computed, and height_of_picture_files() wrote.
struct StereoFiles {
  HeightFiles files;               ///< `result` has the map, its depth, what was measured and assumed, and the trace.
  PhotometricStereoResult stereo;  ///< Without heights.
  std::vector<Vec2> shifts_px;     ///< Of the photographs against the first one.
  std::string depth_source;        ///< measured, step, profile, shadow, given.
  double mean_confidence = 0, low_confidence_fraction = 0;  ///< Low: below 0.5.
  std::vector<ReferenceReading> references;
  std::string confidence_picture;  ///< confidence.png in the folder of pictures; empty: none was asked for.
};

/// Width of photographs of one place, of which only the sizes are read.
/// @throws InvalidInput naming the file when there are fewer than three, their sizes differ, or they take more than
///         picture_memory(); IoError.
int width_of_picture_files(const std::vector<std::filesystem::path>& photographs);

/// Reads photographs of one place from one point under different light, moves them onto each other, and makes the
/// relief of photometric_stereo(). They are decoded as `files.height.transfer` says. The depth is measured where the
/// lights are known; of several references of height their mean is taken. Nothing is written.
/// @throws as width_of_picture_files(); InvalidInput when lights and references do not fit.
StereoFiles relief_of_picture_files(const std::vector<std::filesystem::path>& photographs,
                                    const StereoFileOptions& options);

/// Writes relief_of_picture_files(). @throws as that; IoError.
StereoFiles height_of_picture_files(const std::vector<std::filesystem::path>& photographs,
                                    const std::filesystem::path& output, const StereoFileOptions& options);

}  // namespace papilla
