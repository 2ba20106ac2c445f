// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "verb.hpp"

namespace papilla::app {

/// Writes the page of a baked file: the scene as it was written, and the report of bake with small photographs of the
/// grain pictures that it names. A picture that can't be read any more is left out.
/// @throws IoError, InvalidInput as read_gltf() and write_page().
void write_report_page(const std::filesystem::path& glb, Json report, const std::filesystem::path& page,
                       const ProgressCallback& progress);

}  // namespace papilla::app
