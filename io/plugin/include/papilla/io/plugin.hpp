// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace papilla {

/// The table of functions that papilla_NAME.so exports as the variable `papilla_NAME`: heavy libraries are linked by
/// plug-ins, and loaded when a file needs them. A plug-in is looked for in the folder that the build installs it to,
/// seen from the program or library that holds this function, then where the dynamic linker looks. It stays loaded.
/// Thread-safe; the first call costs the loading of the libraries, tenths of a second, later ones nothing that counts
/// if the caller keeps the result.
///
/// @throws IoError when it is not found, can't be loaded, or is of another version().
const void* load_plugin(const std::string& name);

/// What load_plugin() looks at first in the table.
struct PluginHeader {
  const char* version;  ///< version() of the plug-in.
};

}  // namespace papilla
