// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace papilla {

/// Measures of the solids that write_sample_solids() writes, mm.
namespace sample_solids {
inline constexpr double k_ball_radius = 20;
inline constexpr double k_ring_radius = 30,
                        k_tube_radius = 8;  ///< A torus: of the circle in its tube, and of the tube.
inline constexpr double k_cone_radius = 20, k_cone_top_radius = 8, k_cone_height = 40;
}  // namespace sample_solids

/// Writes a ball, a ring and a blunt cone side by side as BREP: surfaces of known area, for measuring what
/// a tessellation leaves of them.
/// @throws IoError when the file can't be written.
void write_sample_solids(const std::filesystem::path& path);

}  // namespace papilla
