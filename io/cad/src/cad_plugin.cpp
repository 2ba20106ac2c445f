// SPDX-License-Identifier: MIT
#include "cad_plugin.hpp"

#include "papilla/core/error.hpp"

extern "C" __attribute__((visibility("default")))
const papilla::cad::Plugin papilla_cad{{papilla::version()}, papilla::cad::read_file, papilla::cad::sample_solids_text};
