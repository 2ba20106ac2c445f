// SPDX-License-Identifier: MIT
#include "cockpit/parts.hpp"

#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <cmath>
#include <numbers>
#include <vector>

#include "cockpit/shapes.hpp"

namespace cockpit {
namespace {

constexpr double k_rim_radius = 182;
constexpr double k_column_radius = 36;
constexpr double k_tilt_degrees = 25;

/// A body of revolution about +Z, laid so that +Z becomes -Y.
TopoDS_Shape facing_passengers(const TopoDS_Shape& shape) { return moved(shape, turned(gp_Trsf(), gp::OX(), 90)); }

gp_Ax2 spoke_section(double radius, double height) { return {gp_Pnt(radius, 0, height), gp::DX(), gp::DY()}; }

gp_Ax2 forward_at(double x, double y, double z) { return {gp_Pnt(x, y, z), gp::DY(), gp::DX()}; }

TopoDS_Shape cylinder_y(double x, double y, double z, double radius, double length) {
  return BRepPrimAPI_MakeCylinder(forward_at(x, y, z), radius, length).Shape();
}

bool near(double a, double b) { return std::abs(a - b) < 1e-3; }

}  // namespace

gp_Trsf steering_wheel_place() { return turned(at(k_driver_x, 455, 765), gp::OX(), 90 - k_tilt_degrees); }

TopoDS_Shape steering_rim() { return BRepPrimAPI_MakeTorus(k_rim_radius, 15.5).Shape(); }

TopoDS_Shape steering_spoke() {
  const TopoDS_Shape blade = loft({ellipse(spoke_section(40, -22), 26, 9), ellipse(spoke_section(75, -19), 22, 7),
                                   ellipse(spoke_section(120, -11), 17, 6), ellipse(spoke_section(182, 0), 19, 7)});
  return cut(cut(blade, steering_rim()), steering_hub());
}

TopoDS_Shape steering_hub() {
  std::vector<TopoDS_Wire> sections;
  const auto add = [&](double z, double width, double height, double radius) {
    sections.push_back(rounded_rectangle(gp_Ax2(gp_Pnt(0, 0, z), gp::DZ(), gp::DX()), width, height, radius));
  };
  add(-40, 84, 78, 20);
  add(-25, 118, 104, 30);
  add(-8, 124, 108, 34);
  add(6, 112, 98, 34);
  return filleted(loft(sections), 5, [](const gp_Pnt& p) { return near(p.Z(), 6); });
}

TopoDS_Shape steering_emblem() {
  const TopoDS_Shape ring = BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 7), gp::DZ()), 17, 1.6).Shape();
  const TopoDS_Shape bar = moved(rounded_box(33, 4, 3, 0.8), at(0, 0, 7));
  return fused(ring, bar);
}

TopoDS_Shape steering_column() {
  const TopoDS_Shape tube =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -290), gp::DZ()), k_column_radius, 248).Shape();
  return moved(filleted(tube, 6, [](const gp_Pnt& p) { return near(p.Z(), -42); }), steering_wheel_place());
}

TopoDS_Shape steering_column_space() {
  const gp_Ax2 axes(gp_Pnt(0, 0, -400), gp::DZ());
  return moved(BRepPrimAPI_MakeCylinder(axes, k_column_radius + 3, 380).Shape(), steering_wheel_place());
}

TopoDS_Shape stalk() {
  const auto section = [](double x, double width, double height) {
    return ellipse(gp_Ax2(gp_Pnt(x, 0, -70), gp::DX(), gp::DY()), width, height);
  };
  const TopoDS_Shape lever = loft({section(30, 5, 5), section(70, 5, 5), section(105, 8, 6), section(150, 11, 7)});
  return filleted(
      cut(lever, BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -290), gp::DZ()), k_column_radius, 248).Shape()), 3,
      [](const gp_Pnt& p) { return near(p.X(), 150); });
}

TopoDS_Shape vent_frame() {
  const auto block = [](double width, double height, double radius, double front, double depth) {
    return prism(rounded_rectangle(forward_at(0, front, 0), width, height, radius), gp_Vec(0, depth, 0));
  };
  TopoDS_Shape frame = block(k_vent_width, k_vent_height, 11, -7, 9);
  frame = filleted(frame, 2.5, [](const gp_Pnt& p) { return near(p.Y(), -7); });
  frame = fused(frame, block(k_vent_width - 12, k_vent_height - 12, 7, 0, 46));
  return cut(frame, block(k_vent_width - 18, k_vent_height - 18, 5, -20, 60));
}

TopoDS_Shape vent_slat() {
  const TopoDS_Shape blade = rounded_box(k_vent_width - 18.6, 15, 1.8, 0.6);
  return moved(blade, turned(gp_Trsf(), gp::OX(), 10));
}

TopoDS_Shape vent_slider() { return rounded_box(9, 12, 7, 2); }

TopoDS_Shape knob_grip() {
  constexpr int k_ridges = 60;
  constexpr double k_outer = 19, k_inner = 17.9, k_height = 17;
  BRepBuilderAPI_MakePolygon star;
  for (int i = 0; i < 2 * k_ridges; ++i) {
    const double angle = std::numbers::pi * i / k_ridges, radius = i % 2 == 0 ? k_outer : k_inner;
    star.Add(gp_Pnt(radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  star.Close();
  const TopoDS_Shape ridges = prism(star.Wire(), gp_Vec(0, 0, k_height));
  // The ridges run out in chamfers at both ends, and the middle is left open for the cap.
  const TopoDS_Shape body = revolve({{15, 0}, {18, 0}, {19.5, 1.5}, {19.5, 14.5}, {17, k_height}, {15, k_height}});
  return facing_passengers(common(ridges, body));
}

TopoDS_Shape knob_cap() {
  TopoDS_Shape cap = BRepPrimAPI_MakeCylinder(15, 18.5).Shape();
  cap = filleted(cap, 1.5, [](const gp_Pnt& p) { return near(p.Z(), 18.5); });
  const TopoDS_Shape mark = moved(rounded_box(1.6, 9, 2, 0.4), at(0, 8, 18.5));
  return facing_passengers(cut(cap, mark));
}

TopoDS_Shape button() { return rounded_box(30, 14, 13, 0.5); }

TopoDS_Shape latch() {
  const TopoDS_Shape plate = rounded_box(58, 9, 20, 4);
  const TopoDS_Shape grip = moved(rounded_box(40, 12, 9, 3), at(0, -4, -6));
  return cut(plate, grip);
}

TopoDS_Shape instrument_hood() {
  const auto ring = [](double y, double width, double height) {
    return ellipse(forward_at(k_driver_x, y, k_instrument_z), width, height);
  };
  const TopoDS_Shape outside = loft({ring(606, 156, 60), ring(640, 152, 56), ring(690, 144, 50), ring(735, 138, 46)});
  const TopoDS_Shape inside =
      loft({ring(600, 154.5, 58.5), ring(640, 148, 52), ring(690, 140, 46), ring(740, 133, 41)});
  return cut(outside, inside);
}

TopoDS_Shape instrument_dials() {
  TopoDS_Shape plate = prism(ellipse(forward_at(k_driver_x, 724, k_instrument_z), 131, 39.5), gp_Vec(0, 4, 0));
  for (const double x : {-66.0, 66.0}) {
    const gp_Ax2 axes(gp_Pnt(k_driver_x + x, 724, k_instrument_z), gp::DY(), gp::DX());
    plate = fused(plate, BRepPrimAPI_MakeTorus(axes, 33, 2.2).Shape());
    plate = fused(plate, cylinder_y(k_driver_x + x, 717, k_instrument_z, 5, 8));
  }
  return plate;
}

TopoDS_Shape instrument_glass() {
  return prism(ellipse(forward_at(k_driver_x, 660, k_instrument_z), 143, 48.5), gp_Vec(0, 1.2, 0));
}

TopoDS_Shape display_frame() {
  const TopoDS_Shape body = rounded_box(250, 14, 140, 5);
  return cut(body, prism(rounded_rectangle(forward_at(0, -10, 0), 236, 126, 4), gp_Vec(0, 5, 0)));
}

TopoDS_Shape display_glass() {
  return prism(rounded_rectangle(forward_at(0, -6.8, 0), 235.4, 125.4, 3.8), gp_Vec(0, 1.5, 0));
}

}  // namespace cockpit
