// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/scene_option.hpp"

#include <map>

#include "file_options.hpp"
#include "option_checks.hpp"
#include "papilla/core/units.hpp"

namespace papilla::app {
namespace {

/// Chord deviation in millimetres of the presets.
const std::map<std::string, double> k_qualities = {
    {"extra-coarse", 1.0}, {"coarse", 0.5}, {"medium", 0.2}, {"fine", 0.1}, {"extra-fine", 0.02}};

const std::map<std::string, double> k_units = {
    {"mm", 1}, {"cm", 10}, {"m", k_mm_per_metre}, {"in", k_mm_per_inch}, {"ft", 12 * k_mm_per_inch}};

}  // namespace

void SceneOptions::add_to(CLI::App& verb) {
  auto* chord = verb.add_option("--chord,--sag", chord_mm, "CAD: largest distance between surface and triangles, mm")
                    ->check(in_range(1e-6, 1e3))
                    ->capture_default_str()
                    ->group("Input");
  verb.add_option("--angle", angle_deg, "CAD: largest angle between neighbouring normals, degrees")
      ->check(in_range(0.1, 90.0))
      ->capture_default_str()
      ->group("Input");
  verb.add_option("--quality", quality,
                  "CAD: chord by name: extra-coarse 1, coarse 0.5, medium 0.2, fine 0.1, extra-fine 0.02 mm")
      ->transform(one_of({"extra-coarse", "coarse", "medium", "fine", "extra-fine"}))
      ->excludes(chord)
      ->group("Input");
  verb.add_option("--max-edge", max_edge_mm, "CAD: longest edge of a triangle, mm; 0: any")
      ->check(not_negative())
      ->capture_default_str()
      ->group("Input");
  verb.add_option("--unit", unit,
                  "Unit of files that carry none (STL, OBJ, PLY, OFF, AC), or instead of the file's own (not glTF)")
      ->transform(one_of({"file", "mm", "cm", "m", "in", "ft"}))
      ->capture_default_str()
      ->group("Input");
  verb.add_option("--up", up, "Upward axis: as the file's format has it, or given")
      ->transform(one_of({"file", "y", "z"}))
      ->capture_default_str()
      ->group("Input");
  reads(verb.add_option("--tags", tags,
                        "glTF: the file as it was before another program changed it; haptic tags that are missing are "
                        "taken from there"))
      ->type_name("FILE")
      ->group("Input");
}

ReadOptions SceneOptions::read_options(const StageCache* cache) const {
  ReadOptions options;
  options.cache = cache;
  options.chord_mm = quality.empty() ? chord_mm : k_qualities.at(quality);
  options.angle_deg = angle_deg;
  options.max_edge_mm = max_edge_mm;
  if (unit != "file") options.millimetres_per_unit = k_units.at(unit);
  if (up != "file") options.up = up == "y" ? UpAxis::y : UpAxis::z;
  options.tags = tags;
  return options;
}

}  // namespace papilla::app
