// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/side_option.hpp"

#include "options/vector_option.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla::app {

void SideOption::add_to(CLI::App& verb, bool turns) {
  auto* const point =
      verb.add_option(
              "--inside", inside,
              "A point where people are, mm in the scene's frame: open parts face it; looked for when not given")
          ->type_name("X,Y,Z")
          ->group("Sides");
  if (turns)
    verb.add_flag("--keep-sides", keep, "Leave open parts as they face, and single sided where they have no side")
        ->excludes(point)
        ->group("Sides");
}

SceneSideOptions SideOption::options(const std::string& output) const {
  SceneSideOptions options;
  options.keep = keep;
  if (!inside.empty()) options.inside = parse_vector("--inside", inside);
  options.add_materials = is_gltf_file(output);
  return options;
}

}  // namespace papilla::app
