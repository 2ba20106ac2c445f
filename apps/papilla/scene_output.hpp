// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "json/json.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "verb.hpp"

namespace papilla::app {

/// Prints the scene's warnings and losses, a line each.
void print_notes(const Scene& scene, const Console& console);

/// How the data of a written glTF file are stored, and what they take in bytes: {meshes{coding, bytes, uncompressed},
/// images{coding, bytes, uncompressed}, height_maps{count, bytes, tags}}.
Json storage_json(const WriteOptions& options, const GlbSizes& sizes);

/// The same in a line or two; empty when nothing was compressed and no tag has a height map.
std::string storage_text(const WriteOptions& options, const GlbSizes& sizes);

/// Writes a verb's result in the format of the extension, adds what that format has no place for to Scene::losses, and
/// prints the notes. The verb puts them into its JSON as "losses" and "warnings".
/// @returns storage_json(), null for other formats than glTF.
/// @throws InvalidInput, IoError as write_scene().
Json write_output(Scene& scene, const std::string& path, const WriteOptions& options, const Console& console);

/// The result of `work`, with the file's name in front of what it throws about the file's content.
template <class Work>
auto named_by(const std::string& file, Work&& work) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    throw InvalidInput(file + ": " + error.what());
  } catch (const SolverFailure& error) {
    throw SolverFailure(file + ": " + error.what());
  }
}

}  // namespace papilla::app
