// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "file_options.hpp"

namespace papilla::app {

/// --environment: the picture that lights the scene.
inline CLI::Option* add_environment(CLI::App& verb, std::string& picture) {
  return reads(verb.add_option("--environment", picture,
                               "Equirectangular picture (HDR, EXR or 8 bits, twice as wide as high) that lights the "
                               "scene and is mirrored in it, on the page and in pictures"))
      ->type_name("PICTURE");
}

}  // namespace papilla::app
