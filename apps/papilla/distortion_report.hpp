// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "papilla/io/scene.hpp"
#include "papilla/param/measure.hpp"
#include "verb.hpp"

namespace papilla::app {

/// The distortion of all parts of a scene that have uv, as one list of triangles.
struct SceneDistortion {
  TriangleMesh mesh;                ///< All parts that have uv, in their own frames.
  std::vector<std::uint32_t> part;  ///< Per triangle: number in Scene::parts.
  DistortionReport report;          ///< Overlap counts within parts only.
};

/// @param options its `part` is set here.
/// @param wanted says by number which parts are measured; empty: all.
/// @throws InvalidInput when no such part has uv.
SceneDistortion measure_scene(const Scene& scene, MeasureOptions options = {},
                              const std::function<bool(std::size_t)>& wanted = {});

/// The report under the key names of `measure`.
Json distortion_json(const DistortionReport& report);

/// The chart that has the largest share of the distortion, Σ A (E - 4) of symmetric Dirichlet: one sliver can own the
/// mean. Null without any distortion.
Json worst_chart_json(const Scene& scene, const SceneDistortion& distortion);

/// A few lines for people.
/// @param worst_chart of worst_chart_json().
std::string distortion_text(const DistortionReport& report, const Json& worst_chart);

/// Every triangle of the scene as a line of CSV.
std::string distortion_csv(const SceneDistortion& distortion);

/// How the surface's area is spread over distortion: for each measure, the upper ends of the bins and the share of the
/// area in them; the last bin has no end.
Json histogram_json(const DistortionReport& report);

/// The same for symmetric Dirichlet as bars for people.
std::string histogram_text(const DistortionReport& report);

/// Gives every triangle that has uv the colour of its distortion, as corner colours; the others are grey.
/// @param report of measure_scene() for this scene with all parts wanted.
void colour_by_distortion(const SceneDistortion& distortion, double worst, Scene& scene);

}  // namespace papilla::app
