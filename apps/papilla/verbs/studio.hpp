// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace papilla::app {

void add_studio(CLI::App& program);

}  // namespace papilla::app
