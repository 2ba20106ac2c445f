// SPDX-License-Identifier: MIT
#include "cockpit/shapes.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <array>
#include <cmath>
#include <gp_Elips.hxx>
#include <numbers>

#include "papilla/core/error.hpp"

namespace cockpit {
namespace {

gp_Pnt in_plane(const gp_Ax2& axes, double x, double y) {
  return axes.Location().Translated(gp_Vec(axes.XDirection()) * x + gp_Vec(axes.YDirection()) * y);
}

}  // namespace

gp_Trsf at(double x, double y, double z) {
  gp_Trsf result;
  result.SetTranslation(gp_Vec(x, y, z));
  return result;
}

gp_Trsf turned(const gp_Trsf& first, const gp_Ax1& axis, double degrees) {
  gp_Trsf turn;
  turn.SetRotation(axis, degrees * std::numbers::pi / 180);
  return first * turn;
}

Handle(Geom_BSplineSurface) surface_through(int rows, int columns, const std::function<gp_Pnt(int, int)>& point) {
  TColgp_Array2OfPnt points(1, rows, 1, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) points.SetValue(i + 1, j + 1, point(i, j));
  GeomAPI_PointsToBSplineSurface fit;
  fit.Interpolate(points);
  return fit.Surface();
}

TopoDS_Face face_of(const Handle(Geom_Surface) & surface) { return BRepBuilderAPI_MakeFace(surface, 1e-6).Face(); }

TopoDS_Edge curve_through(const std::vector<gp_Pnt>& points) {
  const Handle(TColgp_HArray1OfPnt) array = new TColgp_HArray1OfPnt(1, static_cast<int>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) array->SetValue(static_cast<int>(i) + 1, points[i]);
  GeomAPI_Interpolate fit(array, false, 1e-6);
  fit.Perform();
  return BRepBuilderAPI_MakeEdge(fit.Curve()).Edge();
}

TopoDS_Wire ellipse(const gp_Ax2& axes, double half_width, double half_height) {
  const bool wide = half_width >= half_height;
  const gp_Ax2 major(axes.Location(), axes.Direction(), wide ? axes.XDirection() : axes.YDirection());
  const gp_Elips curve(major, std::max(half_width, half_height), std::min(half_width, half_height));
  return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve).Edge()).Wire();
}

TopoDS_Wire rounded_rectangle(const gp_Ax2& axes, double width, double height, double radius) {
  const double x = width / 2, y = height / 2, inner = radius * (1 - std::numbers::sqrt2 / 2);
  struct Corner {
    gp_Pnt start, middle, end;
  };
  std::array<Corner, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const double sx = i == 0 || i == 3 ? 1 : -1, sy = i < 2 ? 1 : -1;
    const gp_Pnt on_x = in_plane(axes, sx * (x - radius), sy * y), on_y = in_plane(axes, sx * x, sy * (y - radius));
    const bool y_first = i % 2 == 0;
    corners[i] = {y_first ? on_y : on_x, in_plane(axes, sx * (x - inner), sy * (y - inner)), y_first ? on_x : on_y};
  }
  BRepBuilderAPI_MakeWire wire;
  for (std::size_t i = 0; i < 4; ++i) {
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(corners[i].start, corners[i].middle, corners[i].end).Value())
                 .Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(corners[i].end, corners[(i + 1) % 4].start).Edge());
  }
  return wire.Wire();
}

TopoDS_Shape prism(const TopoDS_Wire& outline, const gp_Vec& along) {
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline, true).Face(), along).Shape();
}

TopoDS_Shape loft(const std::vector<TopoDS_Wire>& sections) {
  BRepOffsetAPI_ThruSections maker(true, false);
  for (const TopoDS_Wire& section : sections) maker.AddWire(section);
  maker.Build();
  return maker.Shape();
}

TopoDS_Shape revolve(const std::vector<gp_Pnt2d>& profile) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const gp_Pnt2d& p : profile) polygon.Add(gp_Pnt(p.X(), 0, p.Y()));
  polygon.Close();
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(polygon.Wire(), true).Face(), gp::OZ()).Shape();
}

TopoDS_Shape rounded_box(double width, double depth, double height, double radius) {
  const gp_Pnt low(-width / 2, -depth / 2, -height / 2);
  return filleted(BRepPrimAPI_MakeBox(low, width, depth, height).Shape(), radius, [](const gp_Pnt&) { return true; });
}

TopoDS_Shape cut(const TopoDS_Shape& shape, const TopoDS_Shape& tool) { return BRepAlgoAPI_Cut(shape, tool).Shape(); }

TopoDS_Shape common(const TopoDS_Shape& shape, const TopoDS_Shape& tool) {
  return BRepAlgoAPI_Common(shape, tool).Shape();
}

TopoDS_Shape fused(const TopoDS_Shape& shape, const TopoDS_Shape& tool) {
  return BRepAlgoAPI_Fuse(shape, tool).Shape();
}

TopoDS_Shape filleted(const TopoDS_Shape& shape, double radius, const std::function<bool(const gp_Pnt&)>& wanted) {
  BRepFilletAPI_MakeFillet maker(shape);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    if (wanted(curve.Value((curve.FirstParameter() + curve.LastParameter()) / 2))) maker.Add(radius, edge);
  }
  maker.Build();
  if (!maker.IsDone()) throw papilla::SolverFailure("cockpit: a fillet of " + std::to_string(radius) + " mm failed");
  return maker.Shape();
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& where) {
  return BRepBuilderAPI_Transform(shape, where, true).Shape();
}

TopoDS_Shape mirrored_in_x(const TopoDS_Shape& shape) {
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp::Origin(), gp::DX()));
  return moved(shape, mirror);
}

}  // namespace cockpit
