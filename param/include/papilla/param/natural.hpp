// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

struct NaturalOptions {
  UpAxis up = UpAxis::z;
  bool fall_back = true;  ///< Triangles without parameters, or turned over by them, get triplanar pieces; false: throw.
  TriplanarOptions projection;  ///< Of the fallback; its `up` is taken from here.
};

/// The CAD surface's own parameters as texture coordinates: a chart per CAD face (mesh.face, connected over edges at
/// which mesh.cad_uv agrees), u and v scaled, each by one factor per face, to arc length in millimetres:
///     factor of u = Σ A |∂p/∂u| / Σ A   over the face's triangles.
///
/// Guarantees: what Flattening promises; faces whose parameters run clockwise are mirrored in u. Planes, cylinders and
/// extrusions come out as isometries; on other surfaces distortion is that of the parameters (spheres shrink towards
/// the poles). Good input: a part that was tessellated from STEP, IGES or BREP by this toolkit. O(n). Trace: empty.
/// Source: section 4.2.2.1 of the thesis on haptic textures.
/// @throws InvalidInput for a mesh that breaks these preconditions, or has no parameters at all; without fall_back also
///         for a triangle without usable parameters, naming it.
Flattening flatten_natural(const TriangleMesh& mesh, const NaturalOptions& options = {});

}  // namespace papilla
