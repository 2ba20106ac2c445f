// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/io/scene.hpp"
#include "verb.hpp"

namespace papilla::app {

/// Prints the scene's warnings and losses, a line each.
void print_notes(const Scene& scene, const Console& console);

/// Writes a verb's result in the format of the extension, adds what that format has no place for to Scene::losses, and
/// prints the notes. The verb puts them into its JSON as "losses" and "warnings".
/// @throws InvalidInput, IoError as write_scene().
void write_output(Scene& scene, const std::string& path, const Console& console);

}  // namespace papilla::app
