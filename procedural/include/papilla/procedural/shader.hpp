// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "papilla/procedural/texture.hpp"

namespace papilla {

enum class ShaderLanguage { glsl, wgsl };  ///< GLSL ES 3.00 (WebGL 2), WGSL (WebGPU).

struct ShaderOptions {
  ShaderLanguage language = ShaderLanguage::glsl;
  int width = 512, height = 512;  ///< Of the picture, whose texels choose the octaves and soften edges.
};

/// A fragment shader that gives the channels of a texture.
///
/// It holds `Channels papilla_texture(vec2 place)`, for use in shaders of your own; (0, 0) is the top left of the
/// picture, its shorter side spans 1 as in render_texture(). Its entry fills a viewport of width x height: u_channel 0
/// is the colour with alpha, 1 to 12 are main, bump, alpha, coloralpha, reflection, diffuse, specular, specularcoeff,
/// friction, stiffness, damping and roughness as grey.
///
/// Hashes and lattices are those of render_texture(), in unsigned integers of 32 bits: exact. Places, noise and
/// formulas are float where render_texture() has double, sines and arc tangents are computed here because those of a
/// GPU may be off by 1/1000. The channels in [0, 1] agree within 1/255 but where a formula jumps (step, floor, >=,
/// cells' borders) and a texel lies within float's rounding of the jump; and with octaves of more than 2^14 cells
/// across, which dynamicoctaves leaves out. The point has no scene: normaldot is that of the parameter `normal`, sky
/// and flow are 1, the position is the place. Cost: O(graph), every texture once for every size of texel that it is
/// seen at.
/// @throws InvalidInput naming the texture and the reason: neighbourhood statistics; image, ifs and txt, which are
/// rasters; churn() of a number that is not whole, which depends on all bits of a double; more than 1024
/// textures or 8 MiB.
std::string shader_source(const ProceduralTexture& texture, const ShaderOptions& options = {});

/// What a type becomes.
struct ShaderSupport {
  std::string_view type;
  std::string reason;  ///< Why it can't be exported; empty when it can.
};
/// Of every type, found by exporting its plainest recipe.
std::vector<ShaderSupport> shader_support();

}  // namespace papilla
