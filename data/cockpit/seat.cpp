// SPDX-License-Identifier: MIT
#include "cockpit/parts.hpp"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "cockpit/shapes.hpp"

namespace cockpit {
namespace {

constexpr double k_cushion_length = 480;

/// Diamonds of 80 mm, 8 mm deep, running out towards the rim.
double quilt(double x, double y, double rim) {
  const double a = std::sin(std::numbers::pi * (x + y) / 80), b = std::sin(std::numbers::pi * (x - y) / 80);
  return 8 * a * a * b * b * rim;
}

double smooth_step(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// How far from the rim: 0 on it, 1 from 40 mm on.
double rim_of(double x, double y, double length) {
  const double side = k_panel_half_width - std::abs(x), end = std::min(y, length - y);
  return smooth_step(side / 40) * smooth_step(end / 40);
}

double cushion_height(double x, double y) {
  const double along = y / k_cushion_length;
  const double hollow = -22 * std::cos(std::numbers::pi * x / (2 * k_panel_half_width));
  const double rise = 34 * along * along;
  const double roll = -60 * smooth_step((along - 0.86) / 0.14);
  return hollow * (1 - along * 0.5) + rise + roll;
}

double backrest_height(double x, double y) {
  const double along = y / k_backrest_length;
  const double hollow = -20 * std::cos(std::numbers::pi * x / (2 * k_panel_half_width));
  const double lumbar = 26 * std::exp(-std::pow((along - 0.25) / 0.2, 2));
  const double roll = -16 * smooth_step((along - 0.9) / 0.1);
  return hollow + lumbar + roll;
}

using Height = std::function<double(double, double)>;

TopoDS_Shape quilted_panel(double length, const Height& height) {
  constexpr double k_step = 7.5;
  const int rows = static_cast<int>(2 * k_panel_half_width / k_step) + 1;
  const int columns = static_cast<int>(length / k_step) + 1;
  return face_of(surface_through(rows, columns, [&](int i, int j) {
    const double x = -k_panel_half_width + k_step * i, y = k_step * j;
    return gp_Pnt(x, y, height(x, y) + quilt(x, y, rim_of(x, y, length)));
  }));
}

/// A roll along Y with round ends.
TopoDS_Shape bolster(double length, double radius) {
  const TopoDS_Shape roll =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, radius, 0), gp::DY()), radius, length - 2 * radius);
  const auto end = [&](double y, const gp_Dir& outward) {
    return BRepPrimAPI_MakeSphere(gp_Ax2(gp_Pnt(0, y, 0), outward), radius, 0, std::numbers::pi / 2).Shape();
  };
  return fused(fused(roll, end(radius, -gp::DY())), end(length - radius, gp::DY()));
}

TopoDS_Shape piping(double length, const Height& height) {
  std::vector<gp_Pnt> path;
  for (int i = 0; i <= 8; ++i) {
    const double y = length * i / 8;
    path.emplace_back(0, y, height(k_panel_half_width, y) + 1);
  }
  const gp_Ax2 start(path[0], gp_Dir(gp_Vec(path[0], path[1])), gp::DX());
  const TopoDS_Wire spine = BRepBuilderAPI_MakeWire(curve_through(path)).Wire();
  return BRepOffsetAPI_MakePipe(spine, BRepBuilderAPI_MakeFace(ellipse(start, 4, 4), true).Face()).Shape();
}

}  // namespace

gp_Trsf backrest_place() { return turned(turned(at(0, 42, 14), gp::OX(), 112), gp::OY(), 180); }

TopoDS_Shape cushion_panel() { return quilted_panel(k_cushion_length, cushion_height); }
TopoDS_Shape backrest_panel() { return quilted_panel(k_backrest_length, backrest_height); }
TopoDS_Shape cushion_bolster() { return bolster(k_cushion_length, 46); }
TopoDS_Shape backrest_bolster() { return bolster(k_backrest_length - 10, 46); }
/// Ends where the cushion rolls down at the front.
TopoDS_Shape seat_piping() { return piping(0.88 * k_cushion_length, cushion_height); }

TopoDS_Shape headrest() { return rounded_box(230, 140, 84, 34); }

TopoDS_Shape headrest_post() { return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 0), gp::DY()), 6.5, 110).Shape(); }

TopoDS_Shape seat_base() {
  const auto block = [](double z, double width, double depth, double height) {
    return prism(rounded_rectangle(gp_Ax2(gp_Pnt(0, 225, z), gp::DZ(), gp::DX()), width, depth, 40),
                 gp_Vec(0, 0, height));
  };
  return fused(block(-255, 400, 400, 190), block(-65, 470, 440, 34));
}

TopoDS_Shape backrest_shell() { return moved(rounded_box(440, 560, 44, 20), at(0, 285, -60)); }

}  // namespace cockpit
