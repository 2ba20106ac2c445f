// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>

#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"

namespace papilla {

/// All that the uv of one surface and their measure depend on: what a job on another machine is given.
struct SurfaceInput {
  std::string label;                    ///< PartSurface::label.
  std::string unwrap;                   ///< MaterialRule::unwrap.
  TriangleMesh mesh;                    ///< The surface, with its own uv.
  bool unwraps = false;                 ///< It gets new uv; else its own are measured.
  double uv_mm_per_unit = 0;            ///< Of its own uv.
  std::string uv_note;                  ///< What was found about its own uv.
  std::array<double, 2> size_mm{0, 0};  ///< Of its grain.
  Vec2 phase_mm{0, 0};                  ///< MaterialRule::phase_mm.
  PartContext context;
  UnwrapOptions options;
};

/// What is made of it.
struct SurfaceOutput {
  TriangleMesh mesh;    ///< uv: repeats of the grain when new, as they were when kept.
  BakedSurface report;  ///< Without part, slot, label and material.
  double repair_seconds = 0, charts_seconds = 0, unwrap_seconds = 0, measure_seconds = 0;
};

/// A surface as a mesh of its own. A whole part keeps the numbers of its vertices, so that it is mapped as by
/// unwrap_scene().
TriangleMesh surface_mesh(const Scene& scene, const PartSurface& surface);

/// @param mesh The surface. @param options,context Of the whole bake.
SurfaceInput surface_input(const PartSurface& surface, const MaterialRule& rule, TriangleMesh mesh, const Grain& grain,
                           PartContext context, UnwrapOptions options);

/// unwrap_part() where the surface gets new uv, and measure_distortion() of what is written. The method's cache is
/// asked first.
/// @throws InvalidInput, SolverFailure of the method, naming the part.
SurfaceOutput bake_surface(SurfaceInput input);

}  // namespace papilla
