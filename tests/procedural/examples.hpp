// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "papilla/procedural/texture.hpp"

namespace papilla::test {

/// The plainest recipe of a type that shows something.
inline std::string example_of(std::string_view type) {
  if (type == "multi") return "multi|textures=[brick|cols=grey,red],[fbm|alphafunction=main]";
  if (type == "base" || type == "texture") return std::string(type) + "|mainfunction=.5+.5*noise2d(x*8,y*8)";
  if (type == "image") return "image|basetexture=[star|jags=5]";
  if (type == "sd") return "multi|textures=[brick|tiling=true|rows=4|columns=3],[sd|invert=true]";
  return std::string(type);
}

inline CompileOptions at_time(double time) {
  CompileOptions options;
  options.time = time;
  return options;
}

inline RenderedTexture rendered(const std::string& recipe, int size, const RecipeLibrary& library,
                                CompileOptions options = {},
                                unsigned channels = 1U << static_cast<unsigned>(Channel::main)) {
  RenderOptions render;
  render.width = render.height = size, render.channels = channels;
  return render_texture(compile_texture(recipe, library, options), render);
}

}  // namespace papilla::test
