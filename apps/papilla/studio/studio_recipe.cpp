// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_recipe.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/pipeline/studio/recipe_look.hpp"
#include "papilla/procedural/recipe_completion.hpp"
#include "papilla/procedural/recipe_error.hpp"
#include "papilla/procedural/recipe_outline.hpp"
#include "studio/studio_answers.hpp"

namespace papilla::app {
namespace {

constexpr int k_most_picture_side = 256;
constexpr std::size_t k_most_pictures = 64;
constexpr std::size_t k_most_completions = 200;

/// Places of a UTF-8 text in UTF-16 units, and back.
class Places {
 public:
  explicit Places(std::string_view text) {
    std::size_t units = 0;
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      const bool goes_on = (byte & 0xc0U) == 0x80U;
      units_.push_back(goes_on ? units - 1 : units);
      if (!goes_on) units += byte >= 0xf0U ? 2 : 1;
    }
    units_.push_back(units);
  }
  std::size_t units(std::size_t byte) const { return units_[std::min(byte, units_.size() - 1)]; }
  std::size_t byte(std::size_t units) const {
    const auto found = std::lower_bound(units_.begin(), units_.end(), units);
    return static_cast<std::size_t>(std::min(found, units_.end() - 1) - units_.begin());
  }
  Json span(TextSpan span) const { return {units(span.begin), units(span.end)}; }

 private:
  std::vector<std::size_t> units_;  ///< Of every byte, and of the end.
};

Json parameters_json(std::span<const ParameterInfo> parameters) {
  Json list = Json::array();
  for (const ParameterInfo& p : parameters)
    if (p.refusal.empty())
      list.push_back({{"name", p.name},
                      {"kind", to_string(p.kind)},
                      {"low", p.low},
                      {"high", p.high},
                      {"preset", p.preset},
                      {"note", p.note}});
  return list;
}

Json outline_json(const std::vector<OutlineTexture>& outline, std::string_view text, const Places& places) {
  Json list = Json::array();
  for (const OutlineTexture& texture : outline) {
    Json parameters = Json::array();
    for (const OutlineParameter& p : texture.parameters) {
      Json numbers = Json::array(), colours = Json::array();
      for (const OutlineNumber& n : p.numbers) numbers.push_back({{"at", places.span(n.at)}, {"value", n.value}});
      for (const OutlineColour& c : p.colours) colours.push_back({{"at", places.span(c.at)}, {"rgb", c.rgb}});
      parameters.push_back({{"name", p.info ? p.info->name : p.name.of(text)},
                            {"value", places.span(p.value)},
                            {"numbers", numbers},
                            {"colours", colours}});
    }
    list.push_back({{"text", places.span(texture.text)},
                    {"head", texture.head.of(text)},
                    {"type", texture.type},
                    {"parent", texture.parent ? Json(*texture.parent) : Json(nullptr)},
                    {"in_list", texture.in_list},
                    {"parameters", parameters}});
  }
  return list;
}

/// @param text  of the page; a mistake in a recipe that it uses stands at its beginning.
Json problem_json(const InvalidInput& error, const std::string& text, const Places& places) {
  const auto* mistake = dynamic_cast<const RecipeError*>(&error);
  const bool is_here = mistake != nullptr && mistake->source() == "recipe";
  const std::size_t at = is_here ? mistake->position() : 0, before = text.rfind('\n', at == 0 ? 0 : at - 1);
  const std::size_t line_begin = before == std::string::npos || at == 0 ? 0 : before + 1;
  return {{"reason", is_here ? mistake->reason() : error.what()},
          {"position", places.units(at)},
          {"line", 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')},
          {"column", 1 + places.units(at) - places.units(line_begin)}};
}

double time_of(const Json& wanted) {
  const double time = wanted.value("time", 0.0);
  if (!(time >= 0 && time <= 1)) throw InvalidInput("'time' must be between 0 and 1");
  return time;
}

/// Appends pixels and tells where they lie; null without any.
Json placed(const std::vector<unsigned char>& pixels, std::string& all) {
  if (pixels.empty()) return nullptr;
  const Json place = {{"at", all.size()}, {"bytes", pixels.size()}};
  all.append(reinterpret_cast<const char*>(pixels.data()), pixels.size());
  return place;
}

Json recipe_look_json(const RecipeLook& look, std::string& all) {
  Json json = {
      {"width", look.width}, {"height", look.height}, {"roughness", look.roughness}, {"metallic", look.metallic}};
  json["color"] = placed(look.color, all);
  json["normal"] = placed(look.normal, all);
  json["shine"] = placed(look.shine, all);
  return json;
}

int look_side(const Json& wanted) {
  const int side = wanted.at("side").get<int>();
  require_look_side(side);
  return side;
}

int picture_side(const Json& wanted) {
  const int side = wanted.at("side").get<int>();
  if (side > k_most_picture_side) throw InvalidInput("pictures of recipes have at most 256 texels a side");
  return side;
}

/// A picture of a recipe; null where it has a mistake.
Json picture_json(const std::string& text, const StudioRecipe::Handlers& handlers, double time, int side,
                  std::string& all) {
  try {
    return placed(recipe_picture(compile_for_look(text, handlers.library, handlers.folder(), time), side), all);
  } catch (const RecipeError&) {
    return nullptr;
  }
}

}  // namespace

Json StudioRecipe::language() const {
  Json types = Json::object();
  for (const TypeInfo& type : texture_types())
    types[std::string(type.name)] = {{"note", type.note}, {"parameters", parameters_json(type.parameters)}};
  return {{"types", types}, {"common", parameters_json(common_parameters())}, {"recipes", handlers_.library.recipes()}};
}

Json StudioRecipe::recipe_of(const std::string& material) const {
  const auto rule = handlers_.rule(material);
  if (!rule || !looks_like_recipe(rule->recipe, handlers_.library))
    throw InvalidInput("material '" + material + "' has no recipe");
  return {{"text", rule->recipe}, {"time", rule->time}};
}

bool StudioRecipe::has_atlases(const MaterialRule& rule) const {
  try {
    return looks_like_recipe(rule.recipe, handlers_.library) &&
           needs_atlas(compile_for_look(rule.recipe, handlers_.library, handlers_.folder(), rule.time));
  } catch (const InvalidInput&) {
    return false;  // Then nothing of it is shown.
  }
}

Json StudioRecipe::looks_on_surfaces(const Json& wanted, const MaterialRule& rule, const ProceduralTexture& tiling,
                                     Json& answer, const ProgressCallback& progress, std::string& pixels) const {
  const ProceduralTexture texture = compile_for_look(wanted.at("text").get<std::string>(), handlers_.library,
                                                     handlers_.folder(), time_of(wanted), false);
  std::vector<StudioAtlases::Laid> laid = handlers_.atlases.ask(rule.name, texture, look_side(wanted));
  std::size_t under_way = 0;
  Json problems = Json::array();
  for (const StudioAtlases::Laid& one : laid) {
    under_way += one.is_under_way ? 1 : 0;
    if (!one.problem.empty()) problems.push_back(one.problem);
  }
  answer["under_way"] = under_way, answer["surface_problems"] = problems;
  std::erase_if(laid, [](const StudioAtlases::Laid& one) { return !one.atlas; });
  std::vector<std::shared_ptr<const RecipeAtlas>> atlases;
  for (const StudioAtlases::Laid& one : laid) atlases.push_back(one.atlas);
  const std::vector<RecipeLook> looks = recipe_looks(rule, texture, tiling, atlases, progress);
  Json list = Json::array();
  for (std::size_t i = 0; i < looks.size(); ++i) {
    Json& one = list.emplace_back(recipe_look_json(looks[i], pixels));
    one["part"] = laid[i].part, one["slot"] = laid[i].slot, one["use"] = laid[i].use, one["mesh"] = laid[i].name;
  }
  return list;
}

SharedText StudioRecipe::look(const Json& wanted) {
  const std::uint64_t mine = ++newest_;
  const auto text = wanted.at("text").get<std::string>();
  const double time = time_of(wanted);
  const Places places(text);
  Json answer = {{"problem", nullptr},     {"textures", nullptr}, {"uses_time", false},
                 {"needs_atlas", nullptr}, {"cancelled", false},  {"look", nullptr},
                 {"surfaces", nullptr},    {"under_way", 0},      {"surface_problems", Json::array()}};
  std::string pixels;
  try {
    answer["textures"] = outline_json(outline_recipe(text, handlers_.library), text, places);
    const ProceduralTexture texture = compile_for_look(text, handlers_.library, handlers_.folder(), time);
    answer["uses_time"] = texture.depends_on_time();
    answer["needs_atlas"] = needs_atlas(texture);
    const MaterialRule rule = handlers_.rule(wanted.value("material", std::string())).value_or(MaterialRule{});
    const auto is_newest = [&](const Progress&) { return mine == newest_; };
    if (needs_atlas(texture) || has_atlases(rule))
      answer["surfaces"] = looks_on_surfaces(wanted, rule, texture, answer, is_newest, pixels);
    else
      answer["look"] = recipe_look_json(recipe_look(rule, texture, look_side(wanted), is_newest), pixels);
  } catch (const Cancelled&) {
    answer["cancelled"] = true;
  } catch (const InvalidInput& error) {
    answer["problem"] = problem_json(error, text, places);
  }
  return framed(answer, pixels);
}

Json StudioRecipe::completions(const Json& wanted) const {
  const auto text = wanted.at("text").get<std::string>();
  const Places places(text);
  Completions found = complete_recipe(text, places.byte(wanted.at("cursor").get<std::size_t>()), handlers_.library);
  found.all.resize(std::min(found.all.size(), k_most_completions));
  Json list = Json::array();
  for (const Completion& c : found.all)
    list.push_back({{"kind", to_string(c.kind)}, {"name", c.name}, {"insert", c.insert}, {"note", c.note}});
  return {{"word", places.span(found.word)}, {"all", list}};
}

Json StudioRecipe::layers(const Json& wanted) const {
  const auto text = wanted.at("text").get<std::string>();
  const RecipeLibrary& library = handlers_.library;
  const auto number = [&](const char* name) { return wanted.at(name).get<std::size_t>(); };
  const auto changed = [&]() -> std::string {
    const auto kind = wanted.at("kind").get<std::string>();
    if (kind == "remove") return remove_layer(text, library, number("layer"));
    if (kind == "move") return move_layer(text, library, number("layer"), number("other"), wanted.at("behind"));
    if (kind == "insert")
      return insert_layer(text, library, number("other"), wanted.at("behind"), wanted.at("recipe").get<std::string>());
    throw InvalidInput("layers are moved, inserted and removed");
  };
  return {{"text", changed()}};
}

SharedText StudioRecipe::pictures(const Json& wanted) const {
  const auto texts = wanted.at("texts").get<std::vector<std::string>>();
  if (texts.size() > k_most_pictures) throw InvalidInput("at most 64 pictures are made at once");
  const std::scoped_lock lock(picture_mutex_);
  Json list = Json::array();
  std::string pixels;
  for (const std::string& text : texts)
    list.push_back(picture_json(text, handlers_, time_of(wanted), picture_side(wanted), pixels));
  return framed({{"pictures", list}}, pixels);
}

SharedText StudioRecipe::mutations(const Json& wanted) const {
  const auto text = wanted.at("text").get<std::string>();
  const auto seed = wanted.at("seed").get<unsigned>(), count = wanted.at("count").get<unsigned>();
  const double strength = wanted.at("strength").get<double>();
  if (count > k_most_pictures || !(strength > 0 && strength <= 1))
    throw InvalidInput("at most 64 mutations of a strength above 0, at most 1");
  const std::scoped_lock lock(picture_mutex_);
  Json list = Json::array();
  std::string pixels;
  for (unsigned i = 0; i < count; ++i) {
    const std::string mutant = mutate_recipe(text, handlers_.library, seed + i, strength);
    list.push_back({{"text", mutant},
                    {"picture", picture_json(mutant, handlers_, time_of(wanted), picture_side(wanted), pixels)}});
  }
  return framed({{"mutations", list}}, pixels);
}

void add_recipe_routes(StudioRoutes& routes, StudioRecipe& recipe) {
  routes.get["/recipe-language"] = [&recipe](const Query&) { return json_answer(recipe.language()); };
  routes.get["/recipe-of"] = [&recipe](const Query& query) {
    return json_answer(recipe.recipe_of(required(query, "material")));
  };
  const auto add_json = [&](const char* path, Json (StudioRecipe::*make)(const Json&) const) {
    routes.post[path] = [&recipe, make](const Query&, const std::string& body) {
      return json_answer((recipe.*make)(parsed(body)));
    };
  };
  add_json("/recipe-completions", &StudioRecipe::completions);
  add_json("/recipe-layers", &StudioRecipe::layers);
  const auto bytes = [](SharedText all) { return bytes_answer("application/octet-stream", std::move(all)); };
  routes.post["/recipe"] = [&recipe, bytes](const Query&, const std::string& body) {
    return bytes(recipe.look(parsed(body)));
  };
  routes.post["/recipe-pictures"] = [&recipe, bytes](const Query&, const std::string& body) {
    return bytes(recipe.pictures(parsed(body)));
  };
  routes.post["/recipe-mutations"] = [&recipe, bytes](const Query&, const std::string& body) {
    return bytes(recipe.mutations(parsed(body)));
  };
}

}  // namespace papilla::app
