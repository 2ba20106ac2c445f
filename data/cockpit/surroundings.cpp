// SPDX-License-Identifier: MIT
#include "cockpit/parts.hpp"

#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cockpit/shapes.hpp"

namespace cockpit {
namespace {

double bell(double t, double width) { return std::exp(-(t / width) * (t / width)); }

}  // namespace

double door_x(double y, double z) {
  const double arm_rest = 52 * bell(z - 500, 130) / (1 + std::exp((y - 480) / 90));
  return -800 + arm_rest - 0.00009 * (y - 150) * (y - 150);
}

TopoDS_Shape door_panel() {
  return face_of(surface_through(15, 14, [](int i, int j) {
    const double y = -300 + 80.0 * i, z = 150 + 50.0 * j;
    return gp_Pnt(door_x(y, z), y, z);
  }));
}

TopoDS_Shape door_handle() {
  std::vector<TopoDS_Wire> sections;
  for (int i = -4; i <= 4; ++i) {
    const double t = i / 4.0, angle = 0.9 * t;
    const gp_Pnt centre(34 * std::cos(1.45 * t) + 3 * (1 - t * t), 78 * t, 0);
    const gp_Dir along(-std::sin(angle), std::cos(angle), 0);
    sections.push_back(ellipse(gp_Ax2(centre, along, gp::DZ()), 10 + 3 * t * t, 6.5 + 1.5 * t * t));
  }
  return loft(sections);
}

TopoDS_Shape door_handle_plate() { return moved(rounded_box(8, 210, 52, 3.5), at(0, 0, 0)); }

TopoDS_Shape speaker_grille() {
  constexpr double k_rim = 76, k_pitch = 7.6, k_hole = 2.3, k_thickness = 1.6;
  TopoDS_Compound holes;
  BRep_Builder builder;
  builder.MakeCompound(holes);
  constexpr int k_rings = 8;
  for (int a = -k_rings; a <= k_rings; ++a)
    for (int b = -k_rings; b <= k_rings; ++b) {
      if (std::abs(a + b) > k_rings) continue;
      const gp_Pnt start(k_pitch * (a + 0.5 * b), k_pitch * std::sqrt(3.0) / 2 * b, -1);
      builder.Add(holes, BRepPrimAPI_MakeCylinder(gp_Ax2(start, gp::DZ()), k_hole, 2 + k_thickness).Shape());
    }
  const TopoDS_Shape plate = cut(BRepPrimAPI_MakeCylinder(k_rim, k_thickness).Shape(), holes);
  const TopoDS_Shape lip = cut(BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 0.8), gp::DZ()), k_rim + 2, 5).Shape(),
                               BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -12), gp::DZ()), 90, 8.5).Shape());
  return fused(plate, lip);
}

TopoDS_Shape console() {
  BRepBuilderAPI_MakePolygon side;
  for (const auto& [y, z] : {std::pair{-260.0, 90.0},
                             {775.0, 90.0},
                             {770.0, 480.0},
                             {640.0, 470.0},
                             {330.0, 365.0},
                             {40.0, 365.0},
                             {-30.0, 420.0},
                             {-260.0, 420.0}})
    side.Add(gp_Pnt(-100, y, z));
  side.Close();
  return filleted(prism(side.Wire(), gp_Vec(200, 0, 0)), 14, [](const gp_Pnt& p) { return p.Z() > 91; });
}

TopoDS_Shape shifter_boot() {
  const auto section = [](double z, double width, double depth, double radius) {
    return rounded_rectangle(gp_Ax2(gp_Pnt(0, 215, z), gp::DZ(), gp::DX()), width, depth, radius);
  };
  return loft({section(364, 92, 120, 20), section(392, 66, 84, 18), section(424, 24, 26, 9)});
}

TopoDS_Shape shifter_knob() {
  const auto ring = [](double z, double width, double depth) {
    return ellipse(gp_Ax2(gp_Pnt(0, 215, z), gp::DZ(), gp::DX()), width, depth);
  };
  const TopoDS_Shape knob = loft({ring(420, 9, 9), ring(452, 10, 11), ring(490, 23, 28), ring(515, 20, 25)});
  return filleted(knob, 6, [](const gp_Pnt& p) { return std::abs(p.Z() - 515) < 1e-3; });
}

TopoDS_Shape floor_carpet() { return moved(rounded_box(1560, 1700, 12, 5), at(0, 230, 58)); }

}  // namespace cockpit
