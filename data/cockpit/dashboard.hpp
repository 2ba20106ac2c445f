// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>

namespace cockpit {

/// Where the dashboard carries things. X right, Y forward, Z up; the driver sits at x < 0.
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

}  // namespace cockpit
