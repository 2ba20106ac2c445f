// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>

namespace cockpit {

// Controls. Each is modelled around its own origin, its outside towards -Y (on the fascia) or +Z.

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

/// Positions on the dashboard. X right, Y forward, Z up; the driver sits at x < 0.
inline constexpr double k_driver_x = -370;
inline constexpr double k_instrument_z = 802;
inline constexpr double k_vent_z = 800;
inline constexpr double k_vent_width = 120, k_vent_height = 62;

/// The point of the fascia (the side that faces the passengers) at a given x and z.
gp_Pnt on_fascia(double x, double z);
/// The frame of something that stands `off` mm proud of the fascia: -Y outward, Z up.
gp_Trsf fascia_place(double x, double z, double off);

/// Double-curved skin with openings for instruments, vents, steering column and glove box.
TopoDS_Shape dash_skin();
/// The piece of the same surface that closes the glove box.
TopoDS_Shape glove_box_lid();
/// A strip along the fascia with edges rounded by 0.4 mm.
TopoDS_Shape trim_strip();

// One seat around the point where its cushion meets its backrest: X right, Y forward, Z up.

/// From the frame of a cushion (length along Y, outside +Z) to the backrest. Left and right change sides.
gp_Trsf backrest_place();

/// Quilted panels, double-curved skins.
TopoDS_Shape cushion_panel();
TopoDS_Shape backrest_panel();
/// Side rolls, at x = 0.
TopoDS_Shape cushion_bolster();
TopoDS_Shape backrest_bolster();
/// The piping along the cushion's sides, at x = 0.
TopoDS_Shape seat_piping();
TopoDS_Shape headrest();
TopoDS_Shape headrest_post();
TopoDS_Shape seat_base();
TopoDS_Shape backrest_shell();

inline constexpr double k_panel_half_width = 150;
inline constexpr double k_bolster_x = 202;
inline constexpr double k_backrest_length = 585;

// Doors, middle console and floor. In the car's frame unless said otherwise.

/// The left door's double-curved skin.
TopoDS_Shape door_panel();
/// A swept pull on a plate, symmetric; stands on the plane x = 0, outside +X, length along Y.
TopoDS_Shape door_handle();
TopoDS_Shape door_handle_plate();
/// A disc with 217 holes in a ring; outside +Z.
TopoDS_Shape speaker_grille();

TopoDS_Shape console();
TopoDS_Shape shifter_boot();
TopoDS_Shape shifter_knob();
TopoDS_Shape floor_carpet();

/// X of the left door's skin.
double door_x(double y, double z);

}  // namespace cockpit
