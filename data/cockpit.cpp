// SPDX-License-Identifier: MIT
// papilla-make-cockpit OUT.step: models a car cockpit with OpenCASCADE. X right, Y forward, Z up, millimetres.
#include <Standard_Failure.hxx>
#include <cstdio>
#include <exception>

#include "cockpit/model.hpp"
#include "cockpit/parts.hpp"
#include "cockpit/shapes.hpp"

namespace {

using namespace cockpit;

// Colours, sRGB. Materials are assigned by them or by part name.
constexpr unsigned k_black_skin = 0x202020, k_black_lid = 0x2B2B2E, k_black_gloss = 0x0A0A0C,
                   k_black_plastic = 0x161618, k_dial = 0x101418, k_glass = 0x5C7488, k_screen = 0x18242E,
                   k_rim_leather = 0x2A2320, k_satin = 0xB8BCC2, k_chrome = 0xD9DCE0, k_hub = 0x303034,
                   k_frame = 0x8A8D91, k_slat = 0x38383A, k_knurl = 0xC9CCD1, k_wood = 0x7A5230,
                   k_seat_leather = 0x6B4A33, k_bolster_leather = 0x4A3324, k_piping = 0xC8A878, k_base = 0x1C1C1C,
                   k_door = 0x3A3530, k_grille = 0x55585C, k_console = 0x242428, k_boot = 0x2E2622, k_key = 0x4A4E52,
                   k_carpet = 0x3C3C40;

const gp_Trsf k_here;

void add_dashboard(Model& model, const TDF_Label& car) {
  const TDF_Label dash = model.add_assembly("dashboard");
  const auto put = [&](const char* name, const TopoDS_Shape& shape, unsigned colour, double alpha = 1) {
    model.place(dash, model.add_part(name, shape, colour, alpha), k_here, name);
  };
  put("dash_skin", dash_skin(), k_black_skin);
  put("glove_box_lid", glove_box_lid(), k_black_lid);
  put("trim_strip", trim_strip(), k_wood);
  put("instrument_hood", instrument_hood(), k_black_plastic);
  put("instrument_dials", instrument_dials(), k_dial);
  put("instrument_glass", instrument_glass(), k_glass, 0.25);
  model.place(dash, model.add_part("glove_box_latch", latch(), k_chrome), fascia_place(370, 660, 3), "glove_box_latch");
  const gp_Trsf display = turned(at(0, 796, 968), gp::OX(), -10);
  model.place(dash, model.add_part("display_frame", display_frame(), k_black_gloss), display, "display_frame");
  model.place(dash, model.add_part("display_glass", display_glass(), k_screen), display, "display_glass");
  model.place(car, dash, k_here, "dashboard");
}

void add_vents(Model& model, const TDF_Label& car) {
  const TDF_Label vent = model.add_assembly("air_vent");
  model.place(vent, model.add_part("vent_frame", vent_frame(), k_frame), k_here, "vent_frame");
  const TDF_Label slat = model.add_part("vent_slat", vent_slat(), k_slat);
  for (int i = 0; i < k_slats; ++i) {
    const double z = -19.25 + 5.5 * i;
    model.place(vent, slat, at(0, 12, z), "vent_slat_" + std::to_string(i + 1));
  }
  model.place(vent, model.add_part("vent_slider", vent_slider(), k_chrome), at(0, 3, 2.75), "vent_slider");
  for (std::size_t i = 0; i < k_vent_x.size(); ++i)
    model.place(car, vent, fascia_place(k_vent_x[i], k_vent_z, 3), "air_vent_" + std::to_string(i + 1));
}

void add_knobs(Model& model, const TDF_Label& car) {
  const TDF_Label knob = model.add_assembly("rotary_knob");
  model.place(knob, model.add_part("knob_grip", knob_grip(), k_knurl), k_here, "knob_grip");
  model.place(knob, model.add_part("knob_cap", knob_cap(), k_black_gloss), k_here, "knob_cap");
  int number = 0;
  for (const double x : {-62.0, 0.0, 62.0})
    model.place(car, knob, fascia_place(x, 630, -3), "rotary_knob_" + std::to_string(++number));
  const TDF_Label key = model.add_part("button", button(), k_key);
  number = 0;
  for (const double x : {-70.0, -35.0, 0.0, 35.0, 70.0})
    model.place(car, key, fascia_place(x, 700, -2), "button_" + std::to_string(++number));
}

void add_steering(Model& model, const TDF_Label& car) {
  const TDF_Label wheel = model.add_assembly("steering_wheel");
  model.place(wheel, model.add_part("rim", steering_rim(), k_rim_leather), k_here, "rim");
  const TDF_Label spoke = model.add_part("spoke", steering_spoke(), k_satin);
  int number = 0;
  for (const double degrees : {0.0, 180.0, 270.0})
    model.place(wheel, spoke, turned(k_here, gp::OZ(), degrees), "spoke_" + std::to_string(++number));
  model.place(wheel, model.add_part("hub", steering_hub(), k_hub), k_here, "hub");
  model.place(wheel, model.add_part("emblem", steering_emblem(), k_chrome), k_here, "emblem");
  const TDF_Label lever = model.add_part("stalk", stalk(), k_black_gloss);
  model.place(wheel, lever, turned(k_here, gp::OZ(), 8), "stalk_right");
  model.place(wheel, lever, turned(k_here, gp::OZ(), 172), "stalk_left");
  model.place(car, wheel, steering_wheel_place(), "steering_wheel");
  model.place(car, model.add_part("steering_column", steering_column(), k_black_plastic), k_here, "steering_column");
}

/// Both sides of the seat, mirrored by position only.
void place_pair(Model& model, const TDF_Label& seat, const TDF_Label& part, const gp_Trsf& place, double x,
                const std::string& name) {
  model.place(seat, part, place * at(-x, 0, 0), name + "_left");
  model.place(seat, part, place * at(x, 0, 0), name + "_right");
}

void add_seats(Model& model, const TDF_Label& car) {
  const TDF_Label seat = model.add_assembly("seat");
  const gp_Trsf back = backrest_place();
  const auto put = [&](const char* name, const TopoDS_Shape& shape, unsigned colour, const gp_Trsf& where) {
    model.place(seat, model.add_part(name, shape, colour), where, name);
  };
  put("seat_cushion", cushion_panel(), k_seat_leather, k_here);
  put("seat_backrest", backrest_panel(), k_seat_leather, back);
  put("seat_base", seat_base(), k_base, k_here);
  put("seat_backrest_shell", backrest_shell(), k_base, back);
  put("headrest", headrest(), k_seat_leather, back * at(0, k_backrest_length + 95, -40));
  place_pair(model, seat, model.add_part("seat_bolster", cushion_bolster(), k_bolster_leather), at(0, 0, 4),
             k_bolster_x, "seat_bolster");
  place_pair(model, seat, model.add_part("backrest_bolster", backrest_bolster(), k_bolster_leather), back, -k_bolster_x,
             "backrest_bolster");
  place_pair(model, seat, model.add_part("seat_piping", seat_piping(), k_piping), k_here, k_panel_half_width,
             "seat_piping");
  place_pair(model, seat, model.add_part("headrest_post", headrest_post(), k_chrome),
             back * at(0, k_backrest_length - 50, -45), 60, "headrest_post");
  model.place(car, seat, at(k_driver_x, -330, 320), "driver_seat");
  model.place(car, seat, at(-k_driver_x, -330, 320), "passenger_seat");
}

void add_doors(Model& model, const TDF_Label& car) {
  const TopoDS_Shape panel = door_panel();
  model.place(car, model.add_part("door_panel_left", panel, k_door), k_here, "door_panel_left");
  model.place(car, model.add_part("door_panel_right", mirrored_in_x(panel), k_door), k_here, "door_panel_right");
  const TDF_Label handle = model.add_assembly("door_handle");
  model.place(handle, model.add_part("door_handle_pull", door_handle(), k_satin), k_here, "door_handle_pull");
  model.place(handle, model.add_part("door_handle_plate", door_handle_plate(), k_frame), k_here, "door_handle_plate");
  const TDF_Label grille = model.add_part("speaker_grille", speaker_grille(), k_grille);
  for (const double side : {-1.0, 1.0}) {
    const std::string suffix = side < 0 ? "_left" : "_right";
    const auto on_door = [&](double y, double z, double off) {
      const gp_Trsf place = at(-side * (door_x(y, z) + off), y, z);
      return side < 0 ? place : turned(place, gp::OZ(), 180);
    };
    model.place(car, handle, on_door(330, 660, 3), "door_handle" + suffix);
    model.place(car, grille, turned(on_door(520, 300, 9), gp::OY(), 90), "speaker_grille" + suffix);
  }
}

void add_middle(Model& model, const TDF_Label& car) {
  const auto put = [&](const char* name, const TopoDS_Shape& shape, unsigned colour) {
    model.place(car, model.add_part(name, shape, colour), k_here, name);
  };
  put("console", console(), k_console);
  put("shifter_boot", shifter_boot(), k_boot);
  put("shifter_knob", shifter_knob(), k_chrome);
  put("floor_carpet", floor_carpet(), k_carpet);
}

void make(const char* path) {
  Model model;
  const TDF_Label car = model.add_assembly("cockpit");
  add_dashboard(model, car);
  add_vents(model, car);
  add_knobs(model, car);
  add_steering(model, car);
  add_seats(model, car);
  add_doors(model, car);
  add_middle(model, car);
  model.write(path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: papilla-make-cockpit OUT.step\n");
    return 2;
  }
  try {
    make(argv[1]);
    return 0;
  } catch (const Standard_Failure& failure) {
    std::fprintf(stderr, "papilla-make-cockpit: error: %s %s\n", failure.DynamicType()->Name(),
                 failure.GetMessageString());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "papilla-make-cockpit: error: %s\n", error.what());
  }
  return 3;
}
