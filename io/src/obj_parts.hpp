// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "obj_content.hpp"

namespace papilla::io_detail {

/// Adds a part for every object, or for every group of a file without objects, in the order of first use, and the
/// materials that they use, those of the libraries first. The same for any number of threads.
/// @param path  of the file: libraries are found from there.
/// @throws InvalidInput naming file and line: of a polygon that can't be cut, or of a library.
void assemble_obj_parts(ObjContent content, const std::filesystem::path& path, Scene& scene);

}  // namespace papilla::io_detail
