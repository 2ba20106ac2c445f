// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

/// The mesh moved inwards to the lowest height of each material's relief.
struct ReliefBase {
  std::vector<Vec3> corners;   ///< Three per triangle.
  std::vector<double> shifts;  ///< Three per triangle: how far the corner moved along its vertex normal, ≤ 0.
};

/// Vertices at the same place move together, by the lowest height of the materials that meet there, along the mean of
/// their normals (corner normals where given, else faces, by angle), lengthened at sharp edges so that faces move by
/// the full amount. Shortened where a triangle would turn over. Cost: one sort of the vertices.
ReliefBase relief_base(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                       const std::vector<HeightField>& heights);

}  // namespace papilla
