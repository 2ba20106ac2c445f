// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/study/study.hpp"

namespace papilla {

struct StudyStimulusOptions {
  double relief_mm = 0.3;  ///< Peak to valley of ×1 on a plate of 40 mm; larger plates are larger as a whole.
  double stiffness = 800;  ///< N/m
  double friction = 0.1;   ///< Static and dynamic.
  int picture_px = 320;    ///< Side of the grains' pictures.
};

/// Bakes every stimulus of a study as a tagged GLB file into `folder`, by bake_scene() as `papilla bake` does, and
/// writes the grains' lit pictures that trials show. A plate in the plane lies face up with one tile of its relief;
/// fractals are exact fractional Brownian surfaces of 257 × 257 samples of one seed, so that they differ in dimension
/// only. Models that add a force get the amplitude of [Schulze 2005, 6.4.2] times the height: 0.005 N a grey level for
/// orthogonal, 0.01 for the others; the force of a graph follows the dimension in its tag.
/// @returns the study with the depths as baked, and which part of a relief was too steep.
/// Cost: about 0.5 s a relief. @throws IoError, as bake_scene() and write_scene().
Study write_stimuli(Study study, const std::filesystem::path& folder, const StudyStimulusOptions& options = {},
                    const ProgressCallback& progress = {});

}  // namespace papilla
