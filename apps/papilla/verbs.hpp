// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace papilla::app {

// One function a verb, in the file of its name below verbs/.
void add_inspect(CLI::App& program);
void add_tessellate(CLI::App& program);
void add_repair(CLI::App& program);
void add_simplify(CLI::App& program);
void add_unwrap(CLI::App& program);
void add_measure(CLI::App& program);
void add_analyze(CLI::App& program);
void add_prepare(CLI::App& program);
void add_synthesize(CLI::App& program);
void add_height(CLI::App& program);
void add_texture(CLI::App& program);
void add_weather(CLI::App& program);
void add_materials(CLI::App& program);
void add_fit(CLI::App& program);
void add_study(CLI::App& program);
void add_plan(CLI::App& program);
void add_bake(CLI::App& program);
void add_split(CLI::App& program);
void add_merge(CLI::App& program);
void add_view(CLI::App& program);
void add_studio(CLI::App& program);
void add_demo(CLI::App& program);
void add_cache(CLI::App& program);
void add_evaluate(CLI::App& program);
void add_batch(CLI::App& program);

/// All of them, in the order of the help.
void add_verbs(CLI::App& program);

}  // namespace papilla::app
