// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Trsf.hxx>

namespace cockpit {

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

}  // namespace cockpit
