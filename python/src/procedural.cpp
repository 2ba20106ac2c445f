// SPDX-License-Identifier: MIT
#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/pipeline/texture_files.hpp"
#include "papilla/procedural/ageing.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/texture.hpp"
#include "pictures.hpp"

namespace papilla::python {
namespace {

unsigned channel_bits(const std::vector<Channel>& channels) {
  unsigned bits = 0;
  for (const Channel channel : channels) bits |= 1U << static_cast<unsigned>(channel);
  return bits;
}

struct Channels {
  RenderedTexture rendered;
};

/// The channels that were asked for, by name: (height, width), the colour (height, width, 3).
py::object into_python(Channels&& channels) {
  RenderedTexture& rendered = channels.rendered;
  py::dict arrays;
  for (int c = 0; c < k_channels; ++c) {
    auto& values = rendered.values.channels[static_cast<std::size_t>(c)];
    if (values.empty()) continue;
    std::vector<py::ssize_t> shape{rendered.height, rendered.width};
    if (static_cast<Channel>(c) == Channel::color) shape.push_back(3);
    arrays[py::str(name_of(static_cast<Channel>(c)))] = take(std::move(values)).attr("reshape")(shape);
  }
  return arrays;
}

void add_library(py::module_& module) {
  py::class_<RecipeLibrary> type(module, "RecipeLibrary",
                                 "Recipes by name, and lists of colours by name: by default those that come with the "
                                 "program. The form of library files is in docs/procedural.md.");
  type.def(py::init([] { return RecipeLibrary::builtin(); }));
  type.def("add", &RecipeLibrary::add, py::arg("name"), py::arg("recipe"),
           "Raises InvalidInput when the name is none or taken.");
  type.def("add_colours", &RecipeLibrary::add_colours, py::arg("name"), py::arg("colours"),
           "colours: as a recipe's cols would have them. Raises InvalidInput when the name is none.");
  type.def("read_file", py::overload_cast<const std::filesystem::path&>(&RecipeLibrary::read_file), py::arg("path"),
           "Reads a library file and what it includes. Raises IoError; InvalidInput naming file and line.");
  type.def_property_readonly(
      "recipes",
      [](const RecipeLibrary& library) {
        py::dict recipes;
        for (const auto& [name, recipe] : library.recipes()) recipes[py::str(name)] = recipe;
        return recipes;
      },
      "Recipes by name, a copy.");
}

void add_compiled(py::module_& module) {
  py::class_<ProceduralTexture> type(
      module, "ProceduralTexture",
      "A recipe, compiled: formulas are bytecode with constants folded, names are resolved.");
  type.def_property_readonly("depends_on_normal", &ProceduralTexture::depends_on_normal);
  type.def_property_readonly("depends_on_position", &ProceduralTexture::depends_on_position);
  type.def_property_readonly("depends_on_sky", &ProceduralTexture::depends_on_sky);
  type.def_property_readonly("depends_on_time", &ProceduralTexture::depends_on_time);
  type.def_property_readonly("depends_on_neighbours", &ProceduralTexture::depends_on_neighbours);
  type.def_property_readonly("recipes_used", &ProceduralTexture::recipes_used, "Names from the library, sorted.");
}

}  // namespace

void add_recipe_classes(py::module_& module) {
  add_library(module);
  add_compiled(module);
}

void add_procedural(py::module_& module) {
  define<CompileOptions>(
      module,
      "compile_texture(recipe: str, library: RecipeLibrary | None = None, folder: str | os.PathLike[str] = '.') -> "
      "ProceduralTexture",
      docs::compile_texture,
      [](const std::string& recipe, const std::optional<RecipeLibrary>& library, const std::filesystem::path& folder,
         CompileOptions& options) {
        options.read_picture = recipe_options(folder).read_picture;
        return compile_texture(recipe, library ? *library : RecipeLibrary::builtin(), options);
      });
  define<RenderOptions>(
      module,
      "render_texture(texture: ProceduralTexture, channels: list[Channel] = ['main']) -> dict[Channel, "
      "NDArray[np.float32]]",
      docs::render_texture,
      [](const ProceduralTexture& texture, const std::vector<Channel>& channels, RenderOptions& options,
         const ProgressCallback& progress) {
        options.channels = channel_bits(channels);
        options.progress = progress;
        return Channels{render_texture(texture, options)};
      });
  define(module,
         "render_relief(texture: ProceduralTexture, width: int, height: int, size_mm_x: float, size_mm_y: float, "
         "depth_mm: float) -> HeightMap",
         docs::render_relief,
         [](const ProceduralTexture& texture, int width, int height, double size_mm_x, double size_mm_y,
            double depth_mm) { return render_relief(texture, width, height, size_mm_x, size_mm_y, depth_mm); });
  define<TextureFileOptions>(
      module,
      "write_texture_files(recipe: str, folder: str | os.PathLike[str], library: RecipeLibrary | None = None) -> "
      "TextureFiles",
      docs::write_texture_files,
      [](const std::string& recipe, const std::filesystem::path& folder, const std::optional<RecipeLibrary>& library,
         TextureFileOptions& options, const ProgressCallback& progress) {
        options.progress = progress;
        return write_texture_files(recipe, library ? *library : RecipeLibrary::builtin(), folder, options);
      });
  define(module, "mutate_recipe(recipe: str, seed: int, strength: float, library: RecipeLibrary | None = None) -> str",
         docs::mutate_recipe,
         [](const std::string& recipe, unsigned seed, double strength, const std::optional<RecipeLibrary>& library) {
           return mutate_recipe(recipe, library ? *library : RecipeLibrary::builtin(), seed, strength);
         });
  define(module, "suggest_recipes(material: str, library: RecipeLibrary | None = None) -> list[str]",
         docs::suggest_recipes, [](const std::string& material, const std::optional<RecipeLibrary>& library) {
           return suggest_recipes(material, library ? *library : RecipeLibrary::builtin());
         });
  define(
      module, "aged_recipe(recipe: str, words: str) -> str",
      "The recipe with the layers that words such as \"very rusty and dusty 0.4\" ask for, English or German. Raises "
      "InvalidInput naming a word that is unknown.",
      [](const std::string& recipe, const std::string& words) { return aged_recipe(recipe, ageing_layers(words)); });
}

}  // namespace papilla::python
