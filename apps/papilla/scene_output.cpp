// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_output.hpp"

#include "papilla/io/scene_file.hpp"

namespace papilla::app {

void write_output(Scene& scene, const std::string& path, const Console& console) {
  for (const std::string& loss : write_scene(scene, path)) scene.losses.push_back(loss);
  for (const std::string& loss : scene.losses) console.print("left out: " + loss + "\n");
}

}  // namespace papilla::app
