// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Triangles that are connected through edges of exactly two and have a border, or no side at all.
struct OpenSheet {
  std::vector<Index> triangles;
  std::vector<Index> border;  ///< Half-edges of edges with one triangle.
  bool orientable = true;
};

struct OpenSheets {
  std::vector<OpenSheet> sheets;      ///< In the order of their first triangles.
  std::vector<std::uint8_t> against;  ///< Per triangle: it runs against most of its sheet.
};

/// The sheets of a mesh. Equal positions count as one vertex. A component is open when one of its edges has an odd
/// number of triangles, so closed surfaces that touch along an edge stay closed. Triangles whose back is there, too,
/// belong to no sheet: they are seen from both sides as they are. O(n log n), deterministic.
/// @param mesh with indices in range and finite positions.
OpenSheets find_open_sheets(const TriangleMesh& mesh);

}  // namespace papilla::detail
