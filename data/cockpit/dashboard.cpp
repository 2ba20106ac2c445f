// SPDX-License-Identifier: MIT
#include "cockpit/parts.hpp"

#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepOffsetAPI_MakePipeShell.hxx>
#include <GeomAPI_IntCS.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Line.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cockpit/shapes.hpp"
#include "papilla/core/error.hpp"

namespace cockpit {
namespace {

constexpr double k_half_width = 700;

/// The section in the middle of the car, from the windscreen over the edge down to the knees: y, z.
constexpr std::array<std::array<double, 2>, 12> k_profile = {{{1080, 898},
                                                              {970, 910},
                                                              {865, 910},
                                                              {772, 897},
                                                              {705, 868},
                                                              {669, 822},
                                                              {658, 768},
                                                              {667, 700},
                                                              {692, 625},
                                                              {738, 555},
                                                              {805, 505},
                                                              {890, 478}}};

double bell(double x, double width) { return std::exp(-(x / width) * (x / width)); }

/// Rises from 0 at `low` to 1 at `high`.
double ramp(double t, double low, double high) {
  const double s = std::clamp((t - low) / (high - low), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

gp_Pnt section_point(double x, std::size_t row) {
  const double t = static_cast<double>(row) / (k_profile.size() - 1);
  const double side = x / k_half_width;
  const double brow = bell(x - k_driver_x, 230) * ramp(t, 0.05, 0.25) * (1 - ramp(t, 0.45, 0.75));
  const double console = bell(x, 210) * ramp(t, 0.4, 0.75);
  const double y = k_profile[row][0] + 70 * side * side - 12 * brow - 34 * console;
  const double z = k_profile[row][1] - 22 * side * side + 26 * brow;
  return {x, y, z};
}

const Handle(Geom_BSplineSurface) & surface() {
  static const Handle(Geom_BSplineSurface) result =
      surface_through(static_cast<int>(k_profile.size()), 17, [](int row, int column) {
        return section_point(-k_half_width + 2 * k_half_width / 16 * column, static_cast<std::size_t>(row));
      });
  return result;
}

/// Y axis forward through (x, z), starting well in front of the fascia.
gp_Ax2 looking_forward(double x, double z) { return {gp_Pnt(x, 500, z), gp::DY(), gp::DX()}; }

TopoDS_Shape opening(double x, double z, double width, double height, double radius) {
  return prism(rounded_rectangle(looking_forward(x, z), width, height, radius), gp_Vec(0, 300, 0));
}

TopoDS_Shape glove_box_opening(double gap) { return opening(370, 622, 330 - 2 * gap, 120 - 2 * gap, 22 - gap); }

}  // namespace

gp_Pnt on_fascia(double x, double z) {
  const Handle(Geom_Line) line = new Geom_Line(gp_Pnt(x, 400, z), gp::DY());
  const GeomAPI_IntCS hits(line, surface());
  if (hits.NbPoints() == 0) throw papilla::SolverFailure("cockpit: no fascia at x " + std::to_string(x));
  gp_Pnt nearest = hits.Point(1);
  for (int i = 2; i <= hits.NbPoints(); ++i)
    if (hits.Point(i).Y() < nearest.Y()) nearest = hits.Point(i);
  return nearest;
}

gp_Trsf fascia_place(double x, double z, double off) {
  constexpr double k_step = 10;
  const auto slope = [](const gp_Pnt& a, const gp_Pnt& b) {
    return std::atan2(b.Y() - a.Y(), 2 * k_step) * 180 / std::numbers::pi;
  };
  const double yaw = slope(on_fascia(x - k_step, z), on_fascia(x + k_step, z));
  const double pitch = slope(on_fascia(x, z - k_step), on_fascia(x, z + k_step));
  const gp_Pnt p = on_fascia(x, z);
  const gp_Trsf place = turned(turned(at(p.X(), p.Y(), p.Z()), gp::OZ(), yaw), gp::OX(), -pitch);
  return place * at(0, -off, 0);
}

TopoDS_Shape dash_skin() {
  TopoDS_Shape skin = face_of(surface());
  skin = cut(skin, prism(ellipse(looking_forward(k_driver_x, k_instrument_z), 152, 56), gp_Vec(0, 240, 0)));
  for (const double x : k_vent_x) skin = cut(skin, opening(x, k_vent_z, k_vent_width - 8, k_vent_height - 8, 8));
  skin = cut(skin, steering_column_space());
  return cut(skin, glove_box_opening(0));
}

TopoDS_Shape glove_box_lid() { return common(face_of(surface()), glove_box_opening(1.5)); }

TopoDS_Shape trim_strip() {
  std::vector<gp_Pnt> path;
  for (double x = 100; x <= 640; x += 90) path.push_back(on_fascia(x, 722).Translated(gp_Vec(0, -0.6, 0)));
  const TopoDS_Edge spine = curve_through(path);
  BRepOffsetAPI_MakePipeShell sweep(BRepBuilderAPI_MakeWire(spine).Wire());
  const gp_Vec along(path[0], path[1]);
  sweep.SetMode(gp::DZ());
  sweep.Add(rounded_rectangle(gp_Ax2(path[0], gp_Dir(along), gp::DZ()), 16, 3, 0.4));
  sweep.Build();
  sweep.MakeSolid();
  return sweep.Shape();
}

}  // namespace cockpit
