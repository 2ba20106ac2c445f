// SPDX-License-Identifier: MIT
#include "papilla/pipeline/materials.hpp"
#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/library_material.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/material_suggestion.hpp"
#include "pictures.hpp"
#include "sourced.hpp"

namespace papilla::python {
namespace {

void add_library(py::module_& module) {
  py::class_<MaterialLibrary> type(module, "MaterialLibrary",
                                   "A folder of materials of interiors, a JSON file each. Without a folder: the one "
                                   "that PAPILLA_MATERIAL_LIBRARY names, or that was installed.");
  type.def(py::init([](const std::optional<std::filesystem::path>& folder) {
             return MaterialLibrary(folder ? *folder : find_material_library());
           }),
           py::arg("folder") = py::none(), "Raises IoError when there is no such folder.");
  type.def_property_readonly("folder", &MaterialLibrary::folder);
  type.def_property_readonly("ids", &MaterialLibrary::ids, "Of all files, ascending.");
  type.def("material", &MaterialLibrary::material, py::arg("id"),
           "Raises InvalidInput for an id that there is not, naming near ones, and for a file that is no material.");
  type.def("materials", &MaterialLibrary::materials, py::call_guard<py::gil_scoped_release>(),
           "All materials in the order of ids.");
}

}  // namespace

void add_sourced_values(py::module_& module) {
  Record<Sourced<double>>(module, "SourcedNumber", "A number of a material and where it comes from.")
      .field<&Sourced<double>::value>("value", "float", "")
      .field<&Sourced<double>::source>("source", "str", "A key of LibraryMaterial.sources; empty: estimated.")
      .field<&Sourced<double>::note>("note", "str", "Which table, what was measured, how it follows; may be empty.")
      .done();
  Record<Sourced<std::string>>(module, "SourcedText", "A text of a material and where it comes from.")
      .field<&Sourced<std::string>::value>("value", "str", "")
      .field<&Sourced<std::string>::source>("source", "str", "A key of LibraryMaterial.sources; empty: estimated.")
      .field<&Sourced<std::string>::note>("note", "str",
                                          "Which table, what was measured, how it follows; may be empty.")
      .done();
}

void add_materials(py::module_& module) {
  add_library(module);
  define(module, "read_materials(path: str | os.PathLike[str], library: str | os.PathLike[str] = '') -> Materials",
         docs::read_materials, [](const std::filesystem::path& path, const std::filesystem::path& library) {
           return read_materials(path, library);
         });
  define(module, "find_material_library() -> str", docs::find_material_library,
         [] { return find_material_library().string(); });
  define(module, "search_materials(materials: list[LibraryMaterial], words: str) -> list[MaterialHit]",
         docs::search_materials, [](const std::vector<LibraryMaterial>& materials, const std::string& words) {
           return search_materials(materials, words);
         });
  define(module, "rule_of(material: LibraryMaterial, name: str) -> MaterialRule", docs::rule_of,
         [](const LibraryMaterial& material, const std::string& name) { return rule_of(material, name); });
  define(module,
         "suggest_materials(scene: Scene, surfaces: list[PartSurface], library: list[LibraryMaterial], most: int = 3) "
         "-> list[MaterialSuggestion]",
         docs::suggest_materials,
         [](const Scene& scene, const std::vector<PartSurface>& surfaces, const std::vector<LibraryMaterial>& library,
            std::size_t most) { return suggest_materials(scene, surfaces, library, most); });
  define(module, "make_grain(rule: MaterialRule) -> Grain", docs::make_grain,
         [](const MaterialRule& rule) { return make_grain(rule); });
}

}  // namespace papilla::python
