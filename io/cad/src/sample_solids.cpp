// SPDX-License-Identifier: MIT
#include "papilla/io/sample_solids.hpp"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Trsf.hxx>
#include <sstream>

#include "cad_plugin.hpp"

namespace papilla::cad {
namespace {

TopoDS_Shape moved_along_x(const TopoDS_Shape& shape, double by) {
  gp_Trsf move;
  move.SetTranslation(gp_Vec(by, 0, 0));
  return BRepBuilderAPI_Transform(shape, move).Shape();
}

}  // namespace

std::string sample_solids_text() {
  using namespace sample_solids;
  constexpr double ring_radius = k_ring_radius + k_tube_radius;
  constexpr double ring_x = 2 * k_ball_radius + ring_radius, cone_x = ring_x + ring_radius + 2 * k_cone_radius;
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  builder.Add(all, BRepPrimAPI_MakeSphere(k_ball_radius).Shape());
  builder.Add(all, moved_along_x(BRepPrimAPI_MakeTorus(k_ring_radius, k_tube_radius).Shape(), ring_x));
  builder.Add(all,
              moved_along_x(BRepPrimAPI_MakeCone(k_cone_radius, k_cone_top_radius, k_cone_height).Shape(), cone_x));
  std::ostringstream text;
  BRepTools::Write(all, text);
  return text.str();
}

}  // namespace papilla::cad
