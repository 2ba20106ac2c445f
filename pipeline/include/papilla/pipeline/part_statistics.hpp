// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {

/// The statistics of every part of a scene, measured in parallel; in the order of the parts.
/// @throws InvalidInput naming the part.
std::vector<MeshStatistics> part_statistics(const Scene& scene, const ProgressCallback& progress = {});

/// The box around all parts as instances place them, along the file's axes.
Bounds3 scene_bounds(const Scene& scene);

/// The most that a file in single precision moves a vertex [mm].
/// @param placed The file holds parts where their nodes place them, not in their own frames.
double single_precision_mm(const Scene& scene, bool placed);

/// How many nodes show each part.
std::vector<std::size_t> uses_of_parts(const Scene& scene);

/// How many triangles show each material, counted for every use of a part.
std::vector<std::size_t> triangles_of_materials(const Scene& scene);

/// A material's pictures: use (base_color, metallic_roughness, normal, occlusion, emissive) and name of each.
std::vector<std::pair<std::string, std::string>> texture_names(const Scene& scene, const Material& material);

/// The statistics of several meshes together: counters added, the largest aspect, has_uv when all have uv.
MeshStatistics total_statistics(const std::vector<MeshStatistics>& parts);

}  // namespace papilla
