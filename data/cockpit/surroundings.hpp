// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>

namespace cockpit {

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
