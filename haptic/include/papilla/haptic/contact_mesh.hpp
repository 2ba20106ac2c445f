// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// How a material's relief becomes a force. `heightfield` and `textured_normal` are contacts with the displaced
/// surface (force_model.hpp, textured_normal.hpp); the others are stimuli on the smooth base, after Schulze 2005, and
/// promise no passivity. See stimulus.hpp.
enum class ForceModel {
  heightfield,
  orthogonal,
  lateral,
  lateral_isotropic,
  graph_orthogonal,
  graph_lateral,
  textured_normal,
};

/// What a stimulus takes its differences from, where there is a choice; see stimulus.hpp.
enum class StimulusForm {
  usual,         ///< The gradient of the relief, or the distance travelled on the graph.
  displacement,  ///< lateral: the displacement of the proxy.
  place,         ///< graph: the place on the surface.
};

/// Friction between surface and probe; see friction.hpp.
enum class FrictionModel { coulomb, bristle };

/// What a place of a surface feels like: the constants of its material, or what the material's maps say there.
struct ContactConstants {
  double stiffness = 500;           ///< N/m, of the skin.
  double damping = 0;               ///< N·s/m, of the wall; acts along the contact normal.
  double static_friction = 0;       ///< Coulomb, dimensionless.
  double dynamic_friction = 0;      ///< Coulomb, dimensionless, at most static_friction.
  double stribeck_velocity = 0.01;  ///< m/s, the speed over which static friction fades into dynamic.
};

/// The numbers of the material tag that the tick uses.
struct ContactMaterial : ContactConstants {
  double backing_stiffness = 0;  ///< N/m, of what lies below the skin; see spring_force().
  double backing_depth_m = std::numeric_limits<double>::infinity();  ///< Where it is reached; infinity: never.
  std::optional<std::uint32_t> channels;  ///< Index of its maps in the surface's channel fields.
  /// What the maps are held to; see clamp_to_stable().
  double most_stiffness = std::numeric_limits<double>::infinity();
  double most_damping = std::numeric_limits<double>::infinity();
  FrictionModel friction = FrictionModel::coulomb;
  double bristle_stiffness = 0;         ///< N/m, of bristle friction, at most `stiffness`; 0: `stiffness`.
  bool shading = false;                 ///< Force shading; see ContactSurface::shaded_normal().
  std::optional<std::uint32_t> height;  ///< Index of the relief in the surface's height fields.
  ForceModel model = ForceModel::heightfield;
  std::optional<std::uint32_t> stimulus;  ///< Index of the relief of a stimulus, which displaces nothing.
  double amplitude = 0.01;                ///< A of a stimulus: N per grey level, or per grey level and pixel.
  bool literal_sign = false;              ///< Lateral stimuli push uphill, as in the source.
  StimulusForm form = StimulusForm::usual;
  double hurst = 0.5;  ///< H of the graph of a stimulus.
  int level = 8;       ///< Its level of detail; see GreyGraph.
};

/// Triangles of a haptic scene: metres, in the frame of the scene, counter-clockwise seen from outside.
/// A soup is valid input: duplicated vertices, gaps, slivers, T-junctions, several parts.
struct ContactMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec2> corner_uv;       ///< Three per triangle, or empty. Needed by materials with a relief.
  std::vector<Vec3> corner_normals;  ///< Three per triangle, or empty: taken from the faces.
  /// In place of these, one per position; or empty. As files store them, in a fifth of the memory.
  std::vector<std::array<float, 2>> vertex_uv;
  std::vector<std::array<float, 3>> vertex_normals;
  std::vector<std::uint32_t> material;  ///< Per triangle, index of its ContactMaterial; or empty: all 0.

  Vec3 corner(std::size_t t, std::size_t k) const { return positions[triangles[t][k]]; }
  bool has_uv() const noexcept { return !corner_uv.empty() || !vertex_uv.empty(); }
  /// @pre has_uv().
  Vec2 uv(std::size_t t, std::size_t k) const {
    if (vertex_uv.empty()) return corner_uv[3 * t + k];
    const auto& uv = vertex_uv[triangles[t][k]];
    return {double{uv[0]}, double{uv[1]}};
  }
  bool has_normals() const noexcept { return !corner_normals.empty() || !vertex_normals.empty(); }
  /// @pre has_normals().
  Vec3 normal(std::size_t t, std::size_t k) const {
    if (vertex_normals.empty()) return corner_normals[3 * t + k];
    const auto& n = vertex_normals[triangles[t][k]];
    return {double{n[0]}, double{n[1]}, double{n[2]}};
  }
  std::uint32_t material_of(std::size_t t) const { return material.empty() ? 0 : material[t]; }
};

}  // namespace papilla
