// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace papilla::app {

/// --config FILE.json: options of the verb by their long names, with - or _, and its positionals by theirs:
///     {"chord": 0.05, "keep-copies": true, "inside": [0, 350, 900], "unwrap": {"method": "best"}}
/// An object under the name of a verb holds for that verb and goes before what stands outside. What the command line
/// says goes before the file. Must be added before all other options, which then find their values there.
/// Errors while parsing: IoError, InvalidInput naming the file and the JSON pointer.
void add_config(CLI::App& verb);

}  // namespace papilla::app
