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

/// A few lines for people.
std::string distortion_text(const DistortionReport& report);

/// Every triangle of the scene as a line of CSV.
std::string distortion_csv(const SceneDistortion& distortion);

}  // namespace papilla::app
