// SPDX-License-Identifier: MIT
#include "papilla/pipeline/recipe_source.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/procedural/reference.hpp"

namespace papilla {

RecipeLibrary load_recipes(const std::vector<std::string>& files) {
  RecipeLibrary library = RecipeLibrary::builtin();
  for (const std::string& file : files) library.read_file(file);
  return library;
}

CompileOptions recipe_options(const std::filesystem::path& folder) {
  CompileOptions options;
  options.read_picture = [folder](const std::string& path) {
    const auto file = resolve_reference({folder, "picture", path});
    if (!file) throw InvalidInput("'" + shown(path) + "' does not exist");
    const ColorImage image = read_color_image(*file, 3 + 3 * sizeof(float));
    RecipePicture picture{image.width, image.height, {}};
    picture.rgb.reserve(image.pixels.size());
    for (const unsigned char byte : image.pixels) picture.rgb.push_back(static_cast<float>(byte) / 255.0F);
    return picture;
  };
  return options;
}

bool looks_like_recipe(const std::string& text, const RecipeLibrary& library) {
  std::string head = text.substr(0, text.find('|'));
  head.erase(head.find_last_not_of(' ') + 1);
  return find_type(head) != nullptr || library.find(head) != nullptr;
}

ColorImage to_color_image(const std::vector<float>& rgb, int width, int height) {
  ColorImage image{width, height, {}};
  image.pixels.reserve(rgb.size());
  for (const float v : rgb)
    image.pixels.push_back(static_cast<unsigned char>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255.0F)));
  return image;
}

}  // namespace papilla
