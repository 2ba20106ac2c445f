// SPDX-License-Identifier: MIT
#include <oneapi/tbb/global_control.h>
#include <pybind11/pybind11.h>

#include <memory>

#include "errors.hpp"
#include "fields_of_work.hpp"
#include "papilla/core/error.hpp"
#include "storage.hpp"

namespace {

/// At most so many threads work from now on; 0: as many as there are processors.
void set_threads(std::size_t count) {
  using oneapi::tbb::global_control;
  static auto* limit = new std::unique_ptr<global_control>;  // TBB may be gone when statics are destroyed.
  limit->reset();
  if (count > 0) *limit = std::make_unique<global_control>(global_control::max_allowed_parallelism, count);
}

}  // namespace

PYBIND11_MODULE(_papilla, module) {
  using namespace papilla::python;
  // Classes and functions belong to the package, wherever they are compiled.
  const pybind11::object own_name = module.attr("__name__");
  module.attr("__name__") = "papilla";
  module.attr("__version__") = papilla::version();
  module.attr("choices") = pybind11::dict();
  for (const char* list : {"_choice_docs", "_records", "_functions"}) module.attr(list) = pybind11::dict();
  module.def(
      "set_threads", &set_threads, pybind11::arg("count"),
      "At most so many threads work from now on; 0: as many as there are processors. Results do not depend on it.");
  add_errors(module);
  add_storage(module);
  // Records first: functions and classes name them.
  add_pictures(module);
  add_corner_attributes(module);
  add_recipe_classes(module);
  add_scenes_records(module);
  add_meshing_records(module);
  add_param_records(module);
  add_texture_records(module);
  add_procedural_records(module);
  add_sourced_values(module);
  add_pipeline_records(module);
  add_haptic_records(module);
  add_scenes(module);
  add_meshing(module);
  add_param(module);
  add_texture(module);
  add_procedural(module);
  add_materials(module);
  add_pipeline(module);
  add_haptic(module);
  module.attr("__name__") = own_name;
}
