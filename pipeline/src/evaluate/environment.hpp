// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "papilla/pipeline/evaluate/evaluation.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// environment_uv() over the resolution: the mesh and simplified ones of it, down to 1/64 of the triangles. The map is
/// computed at vertices and interpolated between them; the error is, as a mean over the area, how far in uv the
/// interpolated value in the middle of a triangle is from that of the triangle's own normal. Falls with the length of
/// the edges where the surface is smooth. Ends early when the budget is spent.
EvaluationRun environment_run(const TriangleMesh& mesh, const std::string& input, const Budget& budget);

}  // namespace papilla
