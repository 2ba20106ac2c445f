// SPDX-License-Identifier: MIT
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Wire.hxx>
#include <functional>
#include <gp_Ax2.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <vector>

namespace cockpit {

// Solids and surfaces that several parts are made of. Millimetres and degrees.

gp_Trsf at(double x, double y, double z);
gp_Trsf turned(const gp_Trsf& first, const gp_Ax1& axis, double degrees);

/// C2 surface through a grid of points; u runs with the first index.
Handle(Geom_BSplineSurface) surface_through(int rows, int columns, const std::function<gp_Pnt(int, int)>& point);
TopoDS_Face face_of(const Handle(Geom_Surface) & surface);
TopoDS_Edge curve_through(const std::vector<gp_Pnt>& points);

/// Closed wires in the plane of `axes`, around its origin.
TopoDS_Wire ellipse(const gp_Ax2& axes, double half_width, double half_height);
TopoDS_Wire rounded_rectangle(const gp_Ax2& axes, double width, double height, double radius);

TopoDS_Shape prism(const TopoDS_Wire& outline, const gp_Vec& along);
/// Smooth solid through closed wires.
TopoDS_Shape loft(const std::vector<TopoDS_Wire>& sections);
/// Solid of revolution about Z of a profile of (radius, z) points joined by straight lines.
TopoDS_Shape revolve(const std::vector<gp_Pnt2d>& profile);
/// A box around the origin with all edges rounded.
TopoDS_Shape rounded_box(double width, double depth, double height, double radius);

TopoDS_Shape cut(const TopoDS_Shape& shape, const TopoDS_Shape& tool);
TopoDS_Shape common(const TopoDS_Shape& shape, const TopoDS_Shape& tool);
TopoDS_Shape fused(const TopoDS_Shape& shape, const TopoDS_Shape& tool);
/// Rounds the edges that `wanted` picks by their middle.
TopoDS_Shape filleted(const TopoDS_Shape& shape, double radius, const std::function<bool(const gp_Pnt&)>& wanted);
TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& where);
TopoDS_Shape mirrored_in_x(const TopoDS_Shape& shape);

}  // namespace cockpit
