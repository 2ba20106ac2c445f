// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "seam_state.hpp"

namespace papilla::test {

/// The borders of a mesh alone, as SeamState::seam.
inline std::vector<std::uint8_t> border_seams(const param_detail::SeamMesh& mesh) {
  std::vector<std::uint8_t> seam;
  for (const Index opposite : mesh.opposite) seam.push_back(opposite == param_detail::k_no_triangle);
  return seam;
}

/// Makes the edges on the straight line between two points seams.
inline void draw_seam(const param_detail::SeamMesh& mesh, std::vector<std::uint8_t>& seam, Vec3 a, Vec3 b) {
  const auto is_on = [&](Index v) {
    const Vec3 p = mesh.mesh.positions[v];
    return std::abs(norm(p - a) + norm(p - b) - norm(b - a)) < 1e-9;
  };
  for (Index h = 0; h < seam.size(); ++h)
    if (is_on(mesh.from(h)) && is_on(mesh.to(h))) seam[h] = 1;
}

}  // namespace papilla::test
