// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <tuple>

#include "exit_code.hpp"
#include "json/scene_json.hpp"
#include "json/texture_json.hpp"
#include "options/texture_option.hpp"
#include "page/sheet_page.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/pipeline/texture_on_scene.hpp"
#include "papilla/procedural/ageing.hpp"
#include "papilla/procedural/reference.hpp"
#include "shown_format.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

Json write_sheet(const TextureOption& options, const RecipeLibrary& library, VerbContext& context) {
  const bool shows_types = options.sheet == "types";
  const std::filesystem::path folder = options.output;
  make_folder(folder);
  CompileOptions compile = recipe_options(".");
  compile.time = options.files.time > 0 || shows_types ? options.files.time : 0.7;  // Ageing recipes show nothing at 0.
  compile.seamless = options.files.seamless;
  const ContactSheet sheet = make_contact_sheet(shows_types ? examples_of_types() : examples_of_library(library),
                                                library, compile, options.tile_px, context.progress);
  write_color_image(folder / "sheet.png", sheet.picture);
  write_atomically(folder / "sheet.html", sheet_page(sheet, "sheet.png"));
  for (const SheetEntry& entry : sheet.entries)
    if (!entry.error.empty()) context.console.print(shown_format("{}: {}\n", entry.name, entry.error));
  context.console.print(shown_format("{} recipes on {}/sheet.html\n", sheet.entries.size(), options.output));
  return sheet_json(sheet);
}

Json write_on_scene(const TextureOption& options, const std::string& recipe, const RecipeLibrary& library,
                    const VerbContext& context) {
  const TextureFileOptions files = options.options(context.seed, context.progress);
  const TextureOnScene made =
      write_texture_on_scene(recipe, library, read_scene(options.on, {}, context.progress), options.output, files);
  context.console.print(shown_format("{}/{}, with {} pictures\n", options.output, made.scene, made.pictures.size()));
  for (const BakedAtlas& atlas : made.baked.atlases)
    context.console.print(shown_format("atlas of {} x {}: {} charts, a texel for every {:.2g} mm\n", atlas.width,
                                       atlas.height, atlas.charts, atlas.mm_per_texel));
  return {{"scene", made.scene},
          {"pictures", made.pictures},
          {"atlases", atlases_json(made.baked.atlases)},
          {"losses", made.baked.scene.losses},
          {"warnings", made.baked.scene.warnings}};
}

Json print_list(const std::string& what, const RecipeLibrary& library, const Console& console) {
  Json json{{what, Json::array()}};
  const auto add = [&](std::string_view name, std::string_view note) {
    console.print(shown_format("{:<20} {}\n", name, note));
    json[what].push_back({{"name", name}, {"note", note}});
  };
  if (what == "categories") {
    for (const auto& [category, names] : recipes_by_category(library))
      add(category, fmt::format("{} ", fmt::join(names, " ")));
  } else if (what == "reference") {
    console.print(reference_markdown());
  } else if (what == "ageing") {
    for (const AgeingWord& word : ageing_words()) add(word.word, word.layers);
  } else if (what == "glsl") {
    for (const ShaderSupport& type : shader_support()) add(type.type, type.reason.empty() ? "exported" : type.reason);
  } else if (what == "types") {
    for (const TypeInfo& type : texture_types()) add(type.name, type.note);
  } else if (what == "functions") {
    for (const FunctionInfo& f : expression_functions()) add(f.name, f.note);
  } else if (what == "recipes") {
    for (const auto& [name, recipe] : library.recipes()) add(name, recipe);
  } else {
    const TypeInfo* type = find_type(what);
    if (!type) {
      std::vector<std::string_view> known = {"types",  "functions", "recipes",  "categories",
                                             "ageing", "glsl",      "reference"};
      for (const TypeInfo& other : texture_types()) known.emplace_back(other.name);
      throw UsageError("--list: there is no type '" + what + "'" + did_you_mean(what, known));
    }
    for (const auto& parameters : {type->parameters, common_parameters()})
      for (const ParameterInfo& p : parameters) add(p.name, std::string(p.preset) + "  " + std::string(p.note));
  }
  return json;
}

/// Recipes for a material, and the layers for what the words say about its age, over the best of them.
Json print_suggestions(const std::string& words, const RecipeLibrary& library, const Console& console) {
  const AgeingInText ageing = find_ageing(words);
  const std::vector<std::string> names = suggest_recipes(ageing.layers.empty() ? words : ageing.rest, library);
  Json json{{"suggestions", names}};
  if (!ageing.layers.empty()) {
    const auto fresh = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return library.find(name)->find("ismodifier=true") == std::string::npos;
    });
    json["ageing"] = Json::array();
    for (const AgeingLayer& layer : ageing.layers) {
      json["ageing"].push_back({{"recipe", layer.recipe}, {"strength", layer.strength}, {"layer", layer.text()}});
      if (fresh == names.end()) console.print(shown_format("{}\n", layer.text()));
    }
    if (fresh != names.end()) {
      json["aged"] = aged_recipe(*fresh, ageing.layers);
      console.print(shown_format("{}\n", aged_recipe(*fresh, ageing.layers)));
    }
  }
  for (const std::string& name : names) console.print(shown_format("{}\n", name));
  return json;
}

/// The files of --glsl and --wgsl.
Json write_shaders(const TextureOption& options, const std::string& recipe, const RecipeLibrary& library,
                   const TextureFileOptions& wanted, const Console& console) {
  Json json{{"recipe", recipe}};
  for (const auto& [key, file, language] : {std::tuple("glsl", &options.glsl, ShaderLanguage::glsl),
                                            std::tuple("wgsl", &options.wgsl, ShaderLanguage::wgsl)}) {
    if (file->empty()) continue;
    const std::string text = texture_shader(recipe, library, language, wanted);
    write_atomically(*file, text);
    json[key] = {{"file", *file}, {"bytes", text.size()}};
    console.print(shown_format("{}: {} bytes\n", *file, text.size()));
  }
  return json;
}

Json run(const TextureOption& options, VerbContext& context) {
  const RecipeLibrary library = load_recipes(options.libraries);
  if (!options.list.empty()) return print_list(options.list, library, context.console);
  if (!options.suggest.empty()) return print_suggestions(options.suggest, library, context.console);
  const bool only_shaders = options.output.empty() && options.has_shaders();
  if (options.output.empty() && !only_shaders) throw InvalidInput("texture: -o DIR is missing");
  if (!options.sheet.empty()) return write_sheet(options, library, context);
  if (options.recipe.empty()) throw InvalidInput("texture: a recipe, --sheet, --list or --suggest is missing");
  const std::string recipe = options.aged_recipe();
  if (!options.on.empty()) return write_on_scene(options, recipe, library, context);
  const TextureFileOptions wanted = options.options(context.seed, context.progress);
  Json json = write_shaders(options, recipe, library, wanted, context.console);
  if (only_shaders) return json;
  if (const auto side = options.wang_side()) {
    const WangFiles files = write_wang_files(recipe, library, options.output, *side, wanted);
    context.console.print(wang_text(files));
    json.update(wang_json(files));
  } else {
    const TextureFiles files = write_texture_files(recipe, library, options.output, wanted);
    context.console.print(texture_text(files));
    json.update(texture_json(files));
  }
  return json;
}

}  // namespace

void add_texture(CLI::App& program) {
  auto options = std::make_shared<TextureOption>();
  CLI::App* verb =
      add_verb(program,
               {"texture", "Computes procedural textures: colour, height, friction and the other channels as pictures",
                "papilla texture 'brick|scale=.5|switching=true|cols=grey,red' -o brick --size 256 --normal"},
               [options](VerbContext& context) { return run(*options, context); });
  options->add_to(*verb);
}

}  // namespace papilla::app
