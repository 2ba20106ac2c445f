// SPDX-License-Identifier: MIT
#include "papilla/pipeline/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/preview.hpp"
#include "papilla/procedural/reference.hpp"

namespace papilla {
namespace {

std::size_t index_of(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// Largest step of the height across the borders over the largest step within.
double seam_ratio(const std::vector<float>& height, int width, int rows) {
  float within = 0, across = 0;
  const auto at = [&](int x, int y) { return height[index_of(x, y, width)]; };
  for (int y = 0; y < rows; ++y) {
    for (int x = 1; x < width; ++x) within = std::max(within, std::abs(at(x, y) - at(x - 1, y)));
    across = std::max(across, std::abs(at(0, y) - at(width - 1, y)));
  }
  for (int x = 0; x < width; ++x) {
    for (int y = 1; y < rows; ++y) within = std::max(within, std::abs(at(x, y) - at(x, y - 1)));
    across = std::max(across, std::abs(at(x, 0) - at(x, rows - 1)));
  }
  return within > 0 ? static_cast<double>(across / within) : (across > 0 ? 1e6 : 1);
}

/// What makes a dark picture as bright as others: its brightest texels, but for 2 %, become 0.7, of 1.
double exposure_of(const std::vector<float>& rgb) {
  constexpr double k_bright = 0.7, k_most = 3, k_share = 0.98;
  std::vector<float> brightest(rgb.size() / 3);
  for (std::size_t i = 0; i < brightest.size(); ++i)
    brightest[i] = std::max({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
  const auto place = brightest.begin() + static_cast<std::ptrdiff_t>(k_share * static_cast<double>(brightest.size()));
  std::nth_element(brightest.begin(), place, brightest.end());
  return std::clamp(k_bright / std::max(static_cast<double>(*place), k_bright / k_most), 1.0, k_most);
}

/// The value after `key` in a recipe; empty without it.
std::string value_of(const std::string& recipe, std::string_view key) {
  const std::size_t start = recipe.find(key);
  if (start == std::string::npos) return "";
  const std::size_t from = start + key.size();
  return recipe.substr(from, std::min(recipe.size(), recipe.find_first_of("| \n", from)) - from);
}

bool is_modifier(const std::string& recipe) { return recipe.find("ismodifier=true") != std::string::npos; }

/// A recipe that an ageing recipe can be shown on: one for its idmaterial, else plaster.
std::string base_for(const std::string& recipe, const RecipeLibrary& library) {
  std::string material = value_of(recipe, "idmaterial=");
  if (material.empty()) material = value_of(recipe, "matid=");
  if (!material.empty()) {
    for (const std::string& name : suggest_recipes(material, library))
      if (!is_modifier(*library.find(name)) && library.find(name)->find("idtype=aged") == std::string::npos)
        return name;
  }
  return "plaster";
}

}  // namespace

ContactSheet make_contact_sheet(const std::vector<NamedRecipe>& recipes, const RecipeLibrary& library,
                                const CompileOptions& options, int side, const ProgressCallback& progress) {
  ContactSheet sheet;
  sheet.columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(recipes.size())))));
  const int rows = (static_cast<int>(recipes.size()) + sheet.columns - 1) / sheet.columns,
            pitch = side + k_sheet_gap_px;
  sheet.picture = {sheet.columns * pitch + k_sheet_gap_px, rows * pitch + k_sheet_gap_px, {}};
  sheet.picture.pixels.assign(
      3 * static_cast<std::size_t>(sheet.picture.width) * static_cast<std::size_t>(sheet.picture.height), 255);
  int place = 0;
  for (const auto& [name, recipe] : recipes) {
    const std::string* entry_text = library.find(name);
    SheetEntry entry;
    entry.name = name, entry.recipe = recipe, entry.text = entry_text ? *entry_text : recipe;
    const int left = k_sheet_gap_px + place % sheet.columns * pitch,
              top = k_sheet_gap_px + place / sheet.columns * pitch;
    ++place;
    try {
      const ProceduralTexture texture = compile_texture(recipe, library, options);
      RenderOptions render;
      render.width = render.height = side, render.channels = k_preview_channels;
      const RenderedTexture picture = render_texture(texture, render);
      const auto& bump = picture.values[Channel::bump];
      const auto [low, high] = std::minmax_element(bump.begin(), bump.end());
      entry.uses = texture.recipes_used();
      entry.low = static_cast<double>(*low), entry.high = static_cast<double>(*high);
      entry.mean = std::accumulate(bump.begin(), bump.end(), 0.0) / static_cast<double>(bump.size());
      entry.seam = seam_ratio(bump, side, side);
      std::vector<float> lit = light_texture(texture, picture, side / 24.0);
      entry.exposure = exposure_of(lit);
      for (float& value : lit) value = std::min(1.0F, value * static_cast<float>(entry.exposure));
      const ColorImage tile = to_color_image(lit, side, side);
      for (int y = 0; y < side; ++y)
        std::copy_n(tile.pixels.begin() + static_cast<std::ptrdiff_t>(3 * index_of(0, y, side)), 3 * side,
                    sheet.picture.pixels.begin() +
                        static_cast<std::ptrdiff_t>(3 * index_of(left, top + y, sheet.picture.width)));
    } catch (const InvalidInput& refusal) {
      entry.error = refusal.what();
    }
    sheet.entries.push_back(std::move(entry));
    report_progress(progress, "contact sheet", static_cast<double>(place) / static_cast<double>(recipes.size()));
  }
  return sheet;
}

std::vector<NamedRecipe> examples_of_types() {
  std::vector<NamedRecipe> recipes;
  for (const TypeInfo& type : texture_types()) {
    std::string recipe(type.name);
    if (type.name == "multi") recipe += "|textures=brick_wall,[moss|fixtime=true|time=.6]";
    if (type.name == "base" || type.name == "texture")
      recipe += "|mainfunction=.5+.5*s(x*20+4*noise2d(x*4,y*4))*s(y*20)";
    if (type.name == "image") recipe += "|basetexture=[star|jags=5]";
    if (type.name == "sd") recipe = "multi|textures=oak,[sd|invert=true|cols=black,orange]";
    recipes.emplace_back(type.name, recipe);
  }
  return recipes;
}

std::vector<NamedRecipe> examples_of_library(const RecipeLibrary& library) {
  std::vector<NamedRecipe> recipes;
  for (const auto& [name, recipe] : library.recipes())
    recipes.emplace_back(name, is_modifier(recipe) ? "multi|textures=" + base_for(recipe, library) + "," + name : name);
  return recipes;
}

std::map<std::string, std::vector<std::string>> recipes_by_category(const RecipeLibrary& library) {
  std::map<std::string, std::vector<std::string>> categories;
  for (const auto& [name, recipe] : library.recipes()) {
    const std::string category = value_of(recipe, "idtype=");
    categories[category.empty() ? "none" : category].push_back(name);
  }
  return categories;
}

}  // namespace papilla
