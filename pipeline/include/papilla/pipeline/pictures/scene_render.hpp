// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/environment.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

enum class RenderMode {
  material,   ///< Base colour, its texture and the normal map.
  triangles,  ///< Grey, edges of triangles dark, borders (edges of one triangle, by indices) red and wide.
  checker     ///< Squares of `checker_mm` on everything that has uv: shows scale, stretch and seams.
};

/// A view of one point of the surface, in the scene's own axes and millimetres.
struct CloseUp {
  Vec3 point, normal;
  double extent_mm = 100;  ///< Height of the visible area at the point.
};

/// Position of its camera in glTF axes: in front of the surface, raised and a little to the side, so that relief is
/// shaded. @param up of the scene.
Vec3 camera_position(const CloseUp& close_up, UpAxis up);

/// Options of render_scene().
struct SceneViewOptions {
  RenderMode mode = RenderMode::material;
  int width = 1600, height = 1000;
  int samples = 2;                       ///< Per pixel and axis.
  Vec3 towards_camera{0.5, 0.45, 1.0};   ///< In glTF axes: Y up, Z towards the viewer.
  std::optional<CloseUp> close_up = {};  ///< Instead of the whole scene.
  double checker_mm = 20;
  /// Millimetres per unit of uv channel 0, one per material of the scene; 0 or missing: unknown, no checker.
  std::vector<Vec2> mm_per_uv = {};
  std::shared_ptr<const EnvironmentLight> environment = {};  ///< Lights the scene instead of the lamps.
};

/// A picture of the scene by perspective projection with a depth buffer, mip-mapped textures, one key and one fill
/// light, or of an environment; materials with an environment of their own are lit by that. Materials whose alpha mode
/// is BLEND are transparent, sorted by triangles, not by samples. Deterministic. Cost: proportional to triangles and
/// pixels; memory 16 bytes a sample.
/// @throws InvalidInput when the scene has no triangle or a texture can't be decoded.
ColorImage render_scene(const Scene& scene, const SceneViewOptions& options);

}  // namespace papilla
