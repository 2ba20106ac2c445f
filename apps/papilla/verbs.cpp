// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs.hpp"

namespace papilla::app {

void add_verbs(CLI::App& program) {
  add_inspect(program);
  add_tessellate(program);
  add_repair(program);
  add_simplify(program);
  add_unwrap(program);
  add_measure(program);
  add_analyze(program);
  add_prepare(program);
  add_synthesize(program);
  add_height(program);
  add_texture(program);
  add_weather(program);
  add_materials(program);
  add_fit(program);
  add_study(program);
  add_plan(program);
  add_bake(program);
  add_split(program);
  add_merge(program);
  add_batch(program);
  add_view(program);
  add_studio(program);
  add_demo(program);
  add_cache(program);
  add_evaluate(program);
}

}  // namespace papilla::app
