// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_output.hpp"

#include "papilla/io/scene_file.hpp"
#include "shown_format.hpp"

namespace papilla::app {

void print_notes(const Scene& scene, const Console& console) {
  for (const std::string& warning : scene.warnings) console.print(shown_format("warning: {}\n", warning));
  for (const std::string& loss : scene.losses) console.print(shown_format("left out: {}\n", loss));
}

void write_output(Scene& scene, const std::string& path, const Console& console) {
  for (const std::string& loss : write_scene(scene, path)) scene.losses.push_back(loss);
  print_notes(scene, console);
}

}  // namespace papilla::app
