// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::test {

/// A surface over the unit square.
using Surface = std::function<Vec3(double s, double t)>;

/// columns × rows quads of a surface, each cut along its shorter diagonal; counter-clockwise in (s, t).
/// Interior vertices are moved by up to `jitter` cells, the same in every run.
TriangleMesh grid_mesh(int columns, int rows, const Surface& surface, double jitter = 0);

/// Shapes in millimetres.
Vec3 dashboard(double s, double t);      ///< 1400 × 500, crowned, with a cluster hood and a console dip.
Vec3 open_cylinder(double s, double t);  ///< Radius 500, height 2000, cut open; outside counter-clockwise.
Vec3 grab_handle(double s, double t);    ///< U-shaped tapered tube, cut open along its inside.
Vec3 helical_ramp(double s, double t);   ///< Two and a half turns of a spiral ramp: overlaps itself seen from above.

TriangleMesh dashboard_mesh(int columns, int rows);  ///< With the jitter of 0.15 cells that the benchmarks use.
/// Rings around a pole fan, down to latitude `last` from the pole; the radius may depend on the direction.
TriangleMesh sphere_mesh(int rings, int segments, double last, const std::function<double(Vec3)>& radius);
TriangleMesh hemisphere_mesh(int rings, int segments, double radius = 1000);  ///< CAD style: rings and a pole fan.

/// All triangles in one chart.
ChartSet one_chart(const TriangleMesh& mesh);

/// The map (x, y, z) -> uv given per vertex.
CornerAttribute<Vec2> uv_per_vertex(const TriangleMesh& mesh, const std::function<Vec2(Vec3)>& map);

}  // namespace papilla::test
