// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include "papilla/io/read_options.hpp"

namespace papilla::app {

/// Adds the options of every verb that reads a scene, --unit and --up, bound to `options`, which must outlive the verb.
void add_read_flags(CLI::App& verb, ReadOptions& options);

}  // namespace papilla::app
