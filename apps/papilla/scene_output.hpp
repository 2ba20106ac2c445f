// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/io/scene.hpp"
#include "verb.hpp"

namespace papilla::app {

/// Writes a verb's result in the format of the extension, adds what that format has no place for to Scene::losses, and
/// prints all losses, a line each. The verb puts them into its JSON as "losses".
/// @throws InvalidInput, IoError as write_scene().
void write_output(Scene& scene, const std::string& path, const Console& console);

}  // namespace papilla::app
