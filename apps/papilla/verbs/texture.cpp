// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>

#include "papilla/pipeline/contact_sheet.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/animation_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/procedural/reference.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

constexpr double k_pictures_a_second = 10;

struct Arguments {
  std::string recipe, output, list, sheet, suggest;
  std::string channels = "color,bump";
  std::vector<std::string> libraries;
  std::vector<int> size{512};
  double time = 0, size_mm = 40, depth_mm = 0.3, mutate = 0;
  int steps = 1, bits = 8, tile = 128;
  bool normal = false, seamless = false, normalize = false, video = false;
};

std::vector<Channel> channels_of(const std::string& list) {
  std::vector<Channel> channels;
  if (list == "all") {
    for (int c = 0; c < k_channels; ++c) channels.push_back(static_cast<Channel>(c));
    return channels;
  }
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    channels.push_back(channel_named(list.substr(start, end - start)));
    start = end + 1;
  }
  return channels;
}

/// min, max, mean of a channel, and the file it goes to.
Json write_channel(const Arguments& a, const RenderedTexture& texture, Channel channel, const std::string& suffix) {
  const std::vector<float>& values = texture.values[channel];
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const std::string file = std::string(to_string(channel)) + suffix + (a.bits == 32 ? ".exr" : ".png");
  const auto path = std::filesystem::path(a.output) / file;
  if (channel == Channel::color) {
    write_color_image(path, to_color_image(values, texture.width, texture.height));
  } else {
    GreyImage image{texture.width, texture.height, values, a.size_mm / texture.width, a.bits};
    if (a.normalize && *high > *low) {
      const float base = *low, range = *high - *low;
      for (float& v : image.pixels) v = (v - base) / range;
    }
    write_grey_image(path, image, a.bits);
  }
  return {{"name", to_string(channel)}, {"file", file}, {"min", *low}, {"max", *high}, {"mean", mean}};
}

void write_normal_map(const Arguments& a, const RenderedTexture& rendered, const std::string& suffix, Json& json) {
  HeightMap map{rendered.width,
                rendered.height,
                rendered.values[Channel::bump],
                a.size_mm / rendered.width,
                a.size_mm / rendered.width,
                a.seamless};
  for (float& h : map.mm) h *= static_cast<float>(a.depth_mm);
  const std::string file = "normal" + suffix + ".png";
  write_color_image(std::filesystem::path(a.output) / file, normal_map(map));
  json["normal_maps"].push_back(file);
}

/// What --video shows of one time: the colours, lit by the relief.
ColorImage lit(const RenderedTexture& rendered, const Arguments& a) {
  return shaded(rendered, a.depth_mm / (a.size_mm / rendered.width));
}

Json run_recipe(const Arguments& a, const RecipeLibrary& library, VerbContext& context) {
  const std::vector<Channel> channels = channels_of(a.channels);
  RenderOptions render;
  render.width = a.size[0], render.height = a.size.size() > 1 ? a.size[1] : a.size[0];
  render.channels = a.normal ? 1U << static_cast<unsigned>(Channel::bump) : 0;
  if (a.video)
    render.channels |= 1U << static_cast<unsigned>(Channel::color) | 1U << static_cast<unsigned>(Channel::bump);
  for (const Channel c : channels) render.channels |= 1U << static_cast<unsigned>(c);
  std::filesystem::create_directories(a.output);
  const std::string recipe =
      a.mutate > 0 ? mutate_recipe(a.recipe, library, static_cast<unsigned>(context.seed), a.mutate) : a.recipe;
  Json json{{"recipe", recipe}, {"size", {render.width, render.height}}, {"channels", Json::array()}};
  if (a.normal) json["normal_maps"] = Json::array();
  double seconds = 0;
  std::vector<ColorImage> frames;
  for (int step = 0; step < a.steps; ++step) {
    CompileOptions options = recipe_options(".");
    options.time = a.steps > 1 ? static_cast<double>(step) / (a.steps - 1) : a.time;
    options.seamless = a.seamless;
    options.seed = static_cast<std::uint32_t>(context.seed - 1);
    const Stopwatch clock;
    const ProceduralTexture texture = compile_texture(recipe, library, options);
    const RenderedTexture rendered = render_texture(texture, render);
    seconds += clock.seconds();
    const std::string suffix = a.steps > 1 ? fmt::format(".{:04}", step) : "";
    for (const Channel c : channels) {
      Json entry = write_channel(a, rendered, c, suffix);
      if (a.steps > 1) entry["time"] = options.time;
      context.console.print(fmt::format("{:<24} {:.4f} to {:.4f}, mean {:.4f}\n", entry["file"].get<std::string>(),
                                        entry["min"].get<double>(), entry["max"].get<double>(),
                                        entry["mean"].get<double>()));
      json["channels"].push_back(std::move(entry));
    }
    if (a.normal) write_normal_map(a, rendered, suffix, json);
    if (a.video) frames.push_back(lit(rendered, a));
    json["uses"] = texture.recipes_used();
    json["depends_on"] = {{"time", texture.depends_on_time()},
                          {"normal", texture.depends_on_normal()},
                          {"position", texture.depends_on_position()},
                          {"sky", texture.depends_on_sky()},
                          {"neighbours", texture.depends_on_neighbours()}};
    report_progress(context.progress, "texture", (step + 1.0) / a.steps);
  }
  json["seconds"] = seconds;
  if (a.video) {
    write_animation(std::filesystem::path(a.output) / "series.gif", frames, k_pictures_a_second);
    json["video"] = "series.gif";
  }
  return json;
}

/// What stands behind `key` in a recipe, or nothing.
std::string value_in(const std::string& recipe, std::string_view key) {
  const std::size_t start = recipe.find(key);
  if (start == std::string::npos) return "";
  const std::size_t from = start + key.size();
  return recipe.substr(from, std::min(recipe.size(), recipe.find_first_of("| \n", from)) - from);
}

bool is_modifier(const std::string& recipe) { return recipe.find("ismodifier=true") != std::string::npos; }

/// A recipe that an ageing recipe can be shown on: one for its idmaterial, else plaster.
std::string ground_of(const std::string& recipe, const RecipeLibrary& library) {
  if (const std::string material = value_in(recipe, "idmaterial="); !material.empty()) {
    for (const std::string& name : suggest_recipes(material, library))
      if (!is_modifier(*library.find(name)) && library.find(name)->find("idtype=aged") == std::string::npos)
        return name;
  }
  return "plaster";
}

Json run_sheet(const Arguments& a, const RecipeLibrary& library, VerbContext& context) {
  std::vector<std::pair<std::string, std::string>> recipes;
  if (a.sheet == "types") {
    recipes = examples_of_types();
  } else {
    for (const auto& [name, recipe] : library.recipes())
      recipes.emplace_back(name,
                           is_modifier(recipe) ? "multi|textures=" + ground_of(recipe, library) + "," + name : name);
  }
  std::filesystem::create_directories(a.output);
  CompileOptions options = recipe_options(".");
  options.time = a.time > 0 || a.sheet == "types" ? a.time : 0.7;
  options.seamless = a.seamless;
  const ContactSheet sheet = make_contact_sheet(recipes, library, options, a.tile);
  write_color_image(std::filesystem::path(a.output) / "sheet.png", sheet.picture);
  write_atomically(std::filesystem::path(a.output) / "sheet.html", sheet_page(sheet, "sheet.png"));
  Json json{{"sheet", "sheet.png"}, {"page", "sheet.html"}, {"columns", sheet.columns}, {"entries", Json::array()}};
  for (const SheetEntry& e : sheet.entries) {
    json["entries"].push_back({{"name", e.name},
                               {"recipe", e.recipe},
                               {"uses", e.uses},
                               {"min", e.low},
                               {"max", e.high},
                               {"mean", e.mean},
                               {"seam", e.seam},
                               {"error", e.error}});
    if (!e.error.empty()) context.console.print(e.name + ": " + e.error + "\n");
  }
  context.console.print(fmt::format("{} recipes on {}/sheet.html\n", sheet.entries.size(), a.output));
  return json;
}

Json run_list(const Arguments& a, const RecipeLibrary& library, VerbContext& context) {
  Json json{{a.list, Json::array()}};
  const auto line = [&](std::string_view name, std::string_view note) {
    context.console.print(fmt::format("{:<20} {}\n", name, note));
    json[a.list].push_back({{"name", name}, {"note", note}});
  };
  if (a.list == "categories") {
    std::map<std::string, std::string> members;
    for (const auto& [name, recipe] : library.recipes()) {
      const std::string category = value_in(recipe, "idtype=");
      members[category.empty() ? "none" : category] += name + " ";
    }
    for (const auto& [category, names] : members) line(category, names);
  } else if (a.list == "reference") {
    context.console.print(reference_markdown());
  } else if (a.list == "types") {
    for (const TypeInfo& type : texture_types()) line(type.name, type.note);
  } else if (a.list == "functions") {
    for (const FunctionInfo& f : expression_functions()) line(f.name, f.note);
  } else if (a.list == "recipes") {
    for (const auto& [name, recipe] : library.recipes()) line(name, recipe);
  } else {
    const TypeInfo* type = find_type(a.list);
    if (!type) throw InvalidInput("texture --list: there is no type '" + a.list + "'");
    for (const ParameterInfo& p : type->parameters) line(p.name, std::string(p.preset) + "  " + std::string(p.note));
    for (const ParameterInfo& p : common_parameters()) line(p.name, std::string(p.preset) + "  " + std::string(p.note));
  }
  return json;
}

Json run(const Arguments& a, VerbContext& context) {
  const RecipeLibrary library = load_recipes(a.libraries);
  if (!a.list.empty()) return run_list(a, library, context);
  if (!a.suggest.empty()) {
    const std::vector<std::string> names = suggest_recipes(a.suggest, library);
    for (const std::string& name : names) context.console.print(name + "\n");
    return {{"suggestions", names}};
  }
  if (a.output.empty()) throw InvalidInput("texture: -o DIR is missing");
  if (!a.sheet.empty()) return run_sheet(a, library, context);
  if (a.recipe.empty()) throw InvalidInput("texture: a recipe, --sheet, --list or --suggest is missing");
  return run_recipe(a, library, context);
}

}  // namespace

void add_texture(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(program,
               {"texture", "Computes procedural textures: colour, height, friction and the other channels as pictures",
                "papilla texture 'brick|scale=.5|switching=true|cols=grey,red' -o brick --size 256 --normal"},
               [a](VerbContext& context) { return run(*a, context); });
  verb->add_option("recipe", a->recipe, "Recipe: type|parameter=value|..., or the name of one")->type_name("RECIPE");
  verb->add_option("-o,--output", a->output, "Folder of the pictures")->type_name("DIR");
  verb->add_option("--size", a->size, "Texels a side, or width and height")
      ->expected(1, 2)
      ->delimiter('x')
      ->check(CLI::Range(1, 65536))
      ->type_name("N[xN]");
  verb->add_option("--channels", a->channels, "Channels separated by commas, or all")
      ->type_name("LIST")
      ->capture_default_str();
  verb->add_option("--bits", a->bits, "8 or 16 (PNG), 32 (EXR); colours have 8")
      ->check(CLI::IsMember({8, 16, 32}))
      ->capture_default_str();
  verb->add_flag("--normalize", a->normalize, "Stretch every channel to its full range");
  verb->add_flag("--normal", a->normal, "Write the glTF normal map of the height too");
  verb->add_option("--size-mm", a->size_mm, "Side of the picture, for the normal map")
      ->check(CLI::PositiveNumber)
      ->type_name("MM")
      ->capture_default_str();
  verb->add_option("--depth-mm", a->depth_mm, "Height of 1, for the normal map")
      ->check(CLI::PositiveNumber)
      ->type_name("MM")
      ->capture_default_str();
  verb->add_option("--time", a->time, "0 new to 1 worn")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("T")
      ->capture_default_str();
  CLI::Option* steps = verb->add_option("--steps", a->steps, "A series of pictures from time 0 to 1")
                           ->check(CLI::Range(1, 9999))
                           ->type_name("N");
  verb->add_flag("--video", a->video, "The series as an animated GIF, lit, too")->needs(steps);
  verb->add_flag("--seamless", a->seamless, "The pictures tile");
  verb->add_option("--library", a->libraries, "Files of named recipes, on top of the built-in ones")->type_name("FILE");
  verb->add_option("--sheet", a->sheet, "A contact sheet: of all types, or of the library")
      ->check(CLI::IsMember({"types", "library"}));
  verb->add_option("--tile", a->tile, "Texels a side of a picture on the sheet")
      ->check(CLI::Range(8, 1024))
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--list", a->list,
                   "Print types, functions, recipes, categories of recipes, reference, or the parameters of a type")
      ->type_name("WHAT")
      ->expected(0, 1)
      ->default_str("types");
  verb->add_option("--suggest", a->suggest, "Print recipes that suit a material of this name")->type_name("NAME");
  verb->add_option("--mutate", a->mutate, "Change the recipe's numbers by up to this share; --seed chooses")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE");
}

}  // namespace papilla::app
