// SPDX-License-Identifier: MIT
#include "papilla/pipeline/contact_sheet.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "html_text.hpp"
#include "papilla/core/error.hpp"
#include "papilla/procedural/reference.hpp"

namespace papilla {
namespace {

constexpr int k_gap = 4;
constexpr unsigned k_looks = 1U << static_cast<unsigned>(Channel::color) | 1U << static_cast<unsigned>(Channel::bump);

std::size_t index_of(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// Largest step across the borders over the 99th percentile of the steps within.
double seam_of(const std::vector<float>& height, int width, int rows) {
  std::vector<float> within;
  float across = 0;
  const auto at = [&](int x, int y) { return height[index_of(x, y, width)]; };
  for (int y = 0; y < rows; ++y) {
    for (int x = 1; x < width; ++x) within.push_back(std::abs(at(x, y) - at(x - 1, y)));
    across = std::max(across, std::abs(at(0, y) - at(width - 1, y)));
  }
  for (int x = 0; x < width; ++x) {
    for (int y = 1; y < rows; ++y) within.push_back(std::abs(at(x, y) - at(x, y - 1)));
    across = std::max(across, std::abs(at(x, 0) - at(x, rows - 1)));
  }
  if (within.empty()) return 1;
  const auto largest = *std::max_element(within.begin(), within.end());
  return largest > 0 ? static_cast<double>(across / largest) : (across > 0 ? 1e6 : 1);
}

}  // namespace

ColorImage shaded(const RenderedTexture& texture, double relief) {
  const auto& color = texture.values[Channel::color];
  const auto& bump = texture.values[Channel::bump];
  std::vector<unsigned char> pixels;
  pixels.reserve(color.size());
  const auto height = [&](int x, int y) {
    return static_cast<double>(
        bump[index_of(std::clamp(x, 0, texture.width - 1), std::clamp(y, 0, texture.height - 1), texture.width)]);
  };
  for (int y = 0; y < texture.height; ++y)
    for (int x = 0; x < texture.width; ++x) {
      const double sx = relief * (height(x + 1, y) - height(x - 1, y)) / 2,
                   sy = relief * (height(x, y + 1) - height(x, y - 1)) / 2;
      const double light = (1 + sx * 0.6 + sy * 0.6) / std::sqrt(1 + sx * sx + sy * sy) / 1.05;
      for (std::size_t k = 0; k < 3; ++k) {
        const double c = static_cast<double>(color[3 * index_of(x, y, texture.width) + k]);
        pixels.push_back(
            static_cast<unsigned char>(std::lround(255 * std::clamp(c * std::clamp(light, 0.15, 1.8), 0.0, 1.0))));
      }
    }
  return {texture.width, texture.height, std::move(pixels)};
}

ContactSheet make_contact_sheet(const std::vector<std::pair<std::string, std::string>>& recipes,
                                const RecipeLibrary& library, const CompileOptions& options, int side) {
  ContactSheet sheet;
  sheet.columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(recipes.size())))));
  const int rows = (static_cast<int>(recipes.size()) + sheet.columns - 1) / sheet.columns, pitch = side + k_gap;
  sheet.picture = {sheet.columns * pitch + k_gap, rows * pitch + k_gap, {}};
  sheet.picture.pixels.assign(
      3 * static_cast<std::size_t>(sheet.picture.width) * static_cast<std::size_t>(sheet.picture.height), 255);
  int place = 0;
  for (const auto& [name, recipe] : recipes) {
    const std::string* entry_text = library.find(name);
    SheetEntry entry{name, recipe, entry_text ? *entry_text : recipe, {}, 0, 0, 0, 0, ""};
    const int left = k_gap + place % sheet.columns * pitch, top = k_gap + place / sheet.columns * pitch;
    ++place;
    try {
      const ProceduralTexture texture = compile_texture(recipe, library, options);
      RenderOptions render;
      render.width = render.height = side, render.channels = k_looks;
      const RenderedTexture picture = render_texture(texture, render);
      const auto& bump = picture.values[Channel::bump];
      const auto [low, high] = std::minmax_element(bump.begin(), bump.end());
      entry.uses = texture.recipes_used();
      entry.low = static_cast<double>(*low), entry.high = static_cast<double>(*high);
      entry.mean = std::accumulate(bump.begin(), bump.end(), 0.0) / static_cast<double>(bump.size());
      entry.seam = seam_of(bump, side, side);
      const ColorImage tile = shaded(picture, side / 24.0);
      for (int y = 0; y < side; ++y)
        std::copy_n(tile.pixels.begin() + static_cast<std::ptrdiff_t>(3 * index_of(0, y, side)), 3 * side,
                    sheet.picture.pixels.begin() +
                        static_cast<std::ptrdiff_t>(3 * index_of(left, top + y, sheet.picture.width)));
    } catch (const InvalidInput& refusal) {
      entry.error = refusal.what();
    }
    sheet.entries.push_back(std::move(entry));
  }
  return sheet;
}

std::vector<std::pair<std::string, std::string>> examples_of_types() {
  std::vector<std::pair<std::string, std::string>> recipes;
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

std::string sheet_page(const ContactSheet& sheet, const std::string& picture_file) {
  std::string page =
      "<!doctype html><meta charset=\"utf-8\"><title>Recipes</title><style>body{font:14px "
      "sans-serif;margin:2em}td,th{padding:2px 8px;"
      "text-align:left;vertical-align:top;border-bottom:1px solid "
      "#ccc}code{font-size:12px;overflow-wrap:anywhere}</style>\n";
  const int side = (sheet.picture.width - k_gap) / sheet.columns - k_gap;
  page += fmt::format(
      "<style>figure{{display:inline-block;margin:0 6px 10px "
      "0}}figcaption{{font-size:12px;max-width:{0}px}}.t{{width:{0}px;"
      "height:{0}px;background:url({1})}}</style>\n<h1>Recipes</h1>\n<div>",
      side, picture_file);
  for (std::size_t k = 0; k < sheet.entries.size(); ++k) {
    const int column = static_cast<int>(k) % sheet.columns, row = static_cast<int>(k) / sheet.columns;
    const std::string name = html_text(sheet.entries[k].name);
    page += fmt::format(
        "<figure><div class=\"t\" role=\"img\" aria-label=\"{}\" style=\"background-position:-{}px -{}px\"></div>"
        "<figcaption>{}</figcaption></figure>\n",
        name, k_gap + column * (side + k_gap), k_gap + row * (side + k_gap), name);
  }
  page += "</div>\n";
  page += "<table><tr><th>name<th>recipe<th>rests on<th>height<th>mean<th>seam</tr>\n";
  for (const SheetEntry& e : sheet.entries) {
    std::string uses;
    for (const std::string& name : e.uses) uses += (uses.empty() ? "" : ", ") + name;
    page += fmt::format("<tr><td>{}<td><code>{}</code>", html_text(e.name), html_text(e.text));
    if (e.error.empty())
      page += fmt::format("<td>{}<td>{:.3f} to {:.3f}<td>{:.3f}<td>{:.2f}</tr>\n", html_text(uses), e.low, e.high,
                          e.mean, e.seam);
    else
      page += fmt::format("<td colspan=4>{}</tr>\n", html_text(e.error));
  }
  return page +
         "</table>\n<p>Seam: largest step of the height across the border over the largest step within; not above 1 "
         "where the texture tiles. An ageing recipe is shown on a material that it suits.</p>\n";
}

}  // namespace papilla
