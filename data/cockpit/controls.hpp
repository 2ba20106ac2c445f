// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <gp_Trsf.hxx>

namespace cockpit {

// Things for hands. Each is modelled around its own origin, its outside towards -Y (on the fascia) or +Z.

inline constexpr std::array<double, 4> k_vent_x = {-610, -72, 72, 610};
inline constexpr int k_slats = 8;

/// The wheel's frame: Z towards the driver, Y up.
gp_Trsf steering_wheel_place();
TopoDS_Shape steering_rim();
TopoDS_Shape steering_spoke();
TopoDS_Shape steering_hub();
TopoDS_Shape steering_emblem();
/// In the car's frame.
TopoDS_Shape steering_column();
TopoDS_Shape steering_column_space();
TopoDS_Shape stalk();

TopoDS_Shape vent_frame();
TopoDS_Shape vent_slat();
TopoDS_Shape vent_slider();

/// 60 V ridges around, domed top. Axis -Y.
TopoDS_Shape knob_grip();
TopoDS_Shape knob_cap();
TopoDS_Shape button();
TopoDS_Shape latch();

/// In the car's frame.
TopoDS_Shape instrument_hood();
TopoDS_Shape instrument_dials();
TopoDS_Shape instrument_glass();

TopoDS_Shape display_frame();
TopoDS_Shape display_glass();

}  // namespace cockpit
