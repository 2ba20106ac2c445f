// SPDX-License-Identifier: MIT
#pragma once

#include <BRepAdaptor_Curve.hxx>
#include <Geom2d_Curve.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <memory>
#include <vector>

#include "face_patch.hpp"
#include "face_refine.hpp"
#include "face_surface.hpp"

namespace papilla::cad {

/// A CAD edge as the polyline that all faces around it share.
struct EdgeLine {
  std::vector<double> parameters;     ///< On the curve, ascending; empty when nothing is known yet.
  std::vector<std::uint32_t> shared;  ///< Number of each point; ends are CAD vertices.
  bool degenerate = false;            ///< A point in space: one side of the parametrization, collapsed.
};

/// One side of a face along a CAD edge.
struct EdgeUse {
  std::uint32_t edge = 0;
  bool reversed = false;          ///< The face's wire runs against the edge.
  std::vector<Index> nodes;       ///< The face's nodes of EdgeLine::parameters, one each.
  Handle(Geom2d_Curve) curve;     ///< The edge in the face's parameters.
  double factor = 1, offset = 0;  ///< Parameter on `curve` = offset + factor * parameter of the edge.
};

/// Everything that is known of one face before and while it is refined.
struct FaceMesh {
  TopoDS_Face face;  ///< Forward, so that triangles run counter-clockwise in (u, v).
  bool reversed = false;
  FacePatch patch;
  std::vector<EdgeUse> uses;
  RefineLimits limits;
};

/// The edges and vertices of one shape, and the points on them.
class EdgeNet {
 public:
  explicit EdgeNet(const TopoDS_Shape& shape);

  std::uint32_t index_of(const TopoDS_Edge& edge) const;
  std::vector<EdgeLine>& lines() { return lines_; }
  const std::vector<EdgeLine>& lines() const { return lines_; }
  const std::vector<Vec3>& points() const { return points_; }
  TopoDS_Edge edge(std::uint32_t index) const;

  /// Points of the parameters; the ends are the edge's vertices.
  void set_line(std::uint32_t index, std::vector<double> parameters);
  /// The edge's own discretization, for edges of which no face has triangles.
  std::vector<double> discretize(std::uint32_t index, const RefineLimits& limits) const;
  /// Splits segments until they keep the limits of all their faces, against the curve and against the surfaces, and
  /// splits the faces' triangles with them.
  /// @return the number of points added.
  std::size_t refine(std::vector<FaceMesh>& faces);

 private:
  std::vector<std::size_t> least_segments() const;
  std::uint32_t vertex_point(const TopoDS_Shape& vertex, Vec3 position);
  std::uint32_t add_point(Vec3 position);

  TopTools_IndexedMapOfShape edges_, vertices_;
  std::vector<std::uint32_t> vertex_points_;
  std::vector<EdgeLine> lines_;
  std::vector<Vec3> points_;
};

/// The side of the face along an edge of it; false when the edge has no curve in the face's parameters.
bool make_use(const EdgeNet& net, const TopoDS_Edge& edge, const TopoDS_Face& face, EdgeUse& use);

/// Node of the face at a parameter of the edge.
PatchNode edge_node(const EdgeUse& use, double parameter, const FaceSurface& surface, std::uint32_t shared,
                    Vec3 position);

}  // namespace papilla::cad
