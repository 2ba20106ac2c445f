// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "file_options.hpp"

namespace papilla::app {

/// --material-library of the verbs that read MATERIALS.json.
inline void add_material_library(CLI::App& verb, std::string& folder) {
  reads(
      verb.add_option("--material-library", folder,
                      "Folder of the materials that \"library:\" names; default $PAPILLA_MATERIAL_LIBRARY, or that of "
                      "the program"))
      ->type_name("DIR");
}

}  // namespace papilla::app
