// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// The main model of a 3MF package, as XML.
/// @throws InvalidInput when the package has none or it can't be unpacked, without a file's name.
std::string unpack_3mf_model(std::string_view package);

/// Of the model's own attribute `unit`; 1 without one, as 3MF has it.
/// @throws InvalidInput when the unit is none of 3MF's, without a file's name.
double millimetres_of_3mf(std::string_view model);

/// An X3D document as assimp 5.2 reads it: it refuses strings of one word in attributes, url='"a.png"' among them,
/// unless a blank stands before the closing quote, and would open other files for Inline, which becomes a node that it
/// skips.
std::string x3d_for_assimp(std::string_view text);

/// What assimp's readers pass over without a word, one sentence each, found in the file's text: that of the model for
/// 3MF. Meshes: how many were read.
std::vector<std::string> unread_by_assimp(std::string_view extension, std::string_view text, std::size_t meshes);

}  // namespace papilla
