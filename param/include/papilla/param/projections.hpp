// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "papilla/param/flattening.hpp"
#include "papilla/param/grain_frame.hpp"

namespace papilla {

/// What projections come to. Charts are the connected pieces that look the same way; those that the projection turns
/// over are mirrored in u, so that no texture is mirrored.
struct ProjectionResult {
  Flattening flattening;        ///< Trace: empty. Triangles seen edge-on have no area in uv.
  std::size_t turned_over = 0;  ///< Triangles in mirrored charts.
  Vec3 direction{};             ///< Of planar: the outward direction of the plane.
};

struct PlanarOptions {
  UpAxis up = UpAxis::z;
  /// Outward direction of the plane; not given: the dominant normal (of greatest Σ A (n·d)²), on the side that more of
  /// the surface faces.
  std::optional<Vec3> direction;
};

/// One parallel projection of the whole mesh:
///     u = d_u·p,  v = d_v·p   in millimetres,
/// with d_v the grain direction of the plane, and d_u × d_v its outward direction. Lengths in the plane are kept,
/// others shrink. Guarantees: what Flattening promises; charts may overlap themselves. O(n), deterministic. Source:
/// section 4.2.2.3 of the thesis on haptic textures; its division by |d_u|² is that of axes which are not of length 1.
/// @throws InvalidInput when a position is not finite, an index out of range, or the direction has no length.
ProjectionResult flatten_planar(const TriangleMesh& mesh, const PlanarOptions& options = {});

/// The surface that is mapped first.
enum class IntermediateShape { sphere, cylinder, cone, box };

/// How a point of the object finds its point on the intermediate surface.
enum class IntermediateRule {
  reflected_ray,        ///< Where the ray from the eye goes on after its reflection at the object.
  object_normal,        ///< Where the object's normal points.
  object_centroid,      ///< Where the line from the object's middle through the point leads.
  intermediate_normal,  ///< The point whose own normal runs through the object's point.
};

struct IntermediateOptions {
  UpAxis up = UpAxis::z;
  IntermediateShape shape = IntermediateShape::box;
  IntermediateRule rule = IntermediateRule::intermediate_normal;
  /// Of reflected_ray; not given: in front of the object, three times its size away.
  std::optional<Vec3> eye;
};

/// Two-step mapping: the texture is laid, in millimetres and without distortion as far as the shape allows, on a
/// surface around the object, and from there onto the object.
///
/// The shapes stand upright around the middle of the bounding box, with R half its larger horizontal extent: sphere
/// whose radius S is half the largest extent, u = S φ and v = S λ (φ longitude, λ latitude); cylinder of radius R, u =
/// R φ and v = height; cone of radius R at the top and 2 R at the bottom of the box, unrolled; the box itself, each of
/// its faces a plane: u, v are where the ray meets the face. Angles come from atan2. A triangle has one face of the
/// box, that which the ray of its middle meets, or, with intermediate_normal, that whose normal is nearest to its own;
/// its corners' rays go on to the plane of that face. Rays that miss the shape, or meet it more than eight diagonals of
/// the object away, take intermediate_normal. Guarantees: what Flattening promises; triangles across the back (φ = ±π)
/// keep together, the seam lies between them. Charts may overlap themselves. Distortion is that of the rule:
/// intermediate_normal is an isometry for an object that has the intermediate surface's own shape. O(n), deterministic.
/// Source: E. Bier, K. Sloan, Two-part texture mappings, 1986; section 4.2.2.2 of the thesis on haptic textures, with u
/// and v of the sphere exchanged and atan2 for arccos.
/// @throws InvalidInput when a position is not finite, an index out of range, or the eye is not finite.
ProjectionResult flatten_intermediate(const TriangleMesh& mesh, const IntermediateOptions& options = {});

/// How directions are laid into the picture of the surroundings.
enum class EnvironmentMap {
  sphere,      ///< OpenGL's sphere map: what a small mirroring ball shows the eye.
  equal_area,  ///< Cylindrical equal-area panorama (Lambert's), the source's formula: it stands still in the world.
};

struct EnvironmentOptions {
  UpAxis up = UpAxis::z;
  EnvironmentMap map = EnvironmentMap::sphere;
  std::optional<Vec3> eye;  ///< Not given: in front of the object, three times its size away; it looks at its middle.
};

/// Texture coordinates of an environment picture, in [0, 1]: with r the view ray reflected at the vertex normal, of
/// length 1,
///     sphere:      u = r_x / m + 1/2,   v = r_y / m + 1/2,   m = 2 √(r_x² + r_y² + (r_z + 1)²),
///     equal_area:  u = (1 + atan2(r_x, r_z) / π) / 2,   v = (r_y + 1) / 2,
/// x right, y up, z back towards the viewer; of sphere in the frame of the eye, which looks at the object's middle, of
/// equal_area in that of the world. Values 0 to V-1 are those of the V mesh vertices. The triangles are indexed like
/// the mesh's, except that with equal_area corners of triangles across the back (u = 0 and 1) and at the poles have
/// values of their own behind these, so that u does not run around the whole picture inside a triangle; these u lie in
/// [0, 2), for a picture that repeats. It depends on the eye: for previews only. O(n).
/// Sources: section 4.2.2.4 of the thesis on haptic textures, whose formula is that of equal_area; the sphere map of
/// OpenGL.
/// @throws InvalidInput when a position is not finite, an index out of range, or the eye is not finite.
CornerAttribute<Vec2> environment_uv(const TriangleMesh& mesh, const EnvironmentOptions& options = {});

}  // namespace papilla
