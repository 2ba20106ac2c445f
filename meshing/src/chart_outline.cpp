// SPDX-License-Identifier: MIT
#include "chart_outline.hpp"

namespace papilla::detail {

ChartOutline make_outline(const Piece& piece, const ChartField& field) {
  ChartOutline outline;
  outline.triangles = piece.triangle_of;
  const std::vector<Index> outer = border_loops(piece).front();
  outline.place = field.lay_out(piece, outer);
  for (const Index h : outer) {
    outline.border.push_back(piece.halfedge_of(h));
    outline.turning.push_back(field.defect(piece.from(h)));
  }
  for (Index t = 0; t < piece.size(); ++t) outline.area += piece.area(t);
  outline.distortion = field.distortion();
  return outline;
}

}  // namespace papilla::detail
