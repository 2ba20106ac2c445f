// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace papilla {

/// A path that stands in a file and names another one. Files come from anywhere, so what they name must lie beside or
/// below them: docs/security.md.
struct Reference {
  std::filesystem::path folder;  ///< Of the file in which the path stands; relative paths start here.
  std::string place;             ///< File and place in it, as messages begin: "a.gltf: at /images/3/uri".
  std::string value;             ///< The path as it stands there, percent encoding undone.
};

/// What a referenced file must hold.
enum class ReferenceContent {
  any,
  picture,  ///< Begins as PNG, JPEG, WebP, KTX2, AVIF or DDS do: what glTF carries as it is.
  png
};

/// The file that a reference names, with all symbolic links resolved: a regular file in the folder or below it.
/// Empty when there is no such file.
/// @throws InvalidInput beginning with the place and quoting the value when the path, or a link on it, leads out of the
///         folder, or to something that is no regular file.
std::optional<std::filesystem::path> resolve_reference(const Reference& reference);

/// The bytes of the file that resolve_reference() finds; empty when there is none.
/// @throws InvalidInput as resolve_reference(), and when the content is not what it must be; IoError as read_file().
std::optional<std::string> read_reference(const Reference& reference, ReferenceContent content);

/// "image/png" and the like by the first bytes; empty when they are of none of the formats of
/// ReferenceContent::picture.
std::string_view picture_mime_type(std::string_view bytes) noexcept;

/// A URI's path with %20 and the like resolved.
std::string percent_decoded(std::string_view uri);

}  // namespace papilla
