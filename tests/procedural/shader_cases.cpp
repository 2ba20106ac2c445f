// SPDX-License-Identifier: MIT
// Writes shaders and the channels that they must give: shader_cases FOLDER. For every case NAME.frag, NAME.wgsl,
// NAME.f32 (color with alpha, then the ten other channels in the order of u_channel, each row by row), and cases.json.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/procedural/reference.hpp"
#include "papilla/procedural/shader.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

constexpr int k_width = 64, k_height = 48;

struct ShaderCase {
  std::string name, recipe;
};

/// Every type, every recipe of the library, and what types and formulas can do beside their defaults.
std::vector<ShaderCase> shader_cases() {
  std::vector<ShaderCase> cases;
  for (const TypeInfo& type : texture_types())
    cases.push_back({"type_" + std::string(type.name), test::example_of(type.name)});
  const RecipeLibrary library = RecipeLibrary::builtin();
  for (const auto& [name, recipe] : library.recipes())
    cases.push_back({"recipe_" + name,
                     recipe.find("ismodifier=true") == std::string::npos ? name : "multi|textures=plaster," + name});
  const std::vector<std::string> more = {
      "fbm|type=heteroterrain|h=.6",
      "fbm|type=multifractal",
      "fbm|type=hybridmultifractal|zvalue=.7",
      "fbm|type=ridgedmultifractal|seamless=true|scale=.4",
      "fbm|octaves=3.5|weights=1 .5 .9 .2|seed=77",
      "turbulence|absturb=true|scale=.3|rot=.7",
      "turbulence|seamless=true|scale=<.4,.25>",
      "noise|scale=-.2|du=.3",
      "turbulence|zvalue=1.3|scale=.6|seed=9",
      "voronoi|func=f2-f1|rooted=true|scale=.5|octaves=3|cell_initmode=1",
      "voronoi|distmode=1|func=f4-f3*f1|displacemode=3|smooth=.6",
      "voronoi|distmode=2|distmodea=1.7|distmodeb=.8|inversedistance=true|seamless=true|scale=.7",
      "voronoi|random=true|displacemode=6|densityfunc=orig*.5",
      "voronoi|mainfunction=id*.5+get(9)*.2+get(4)",
      "voronoiseamless|points=25|smoothiterations=20|func=f3-f2|mainfunction=this+get(11)",
      "brick|round=.8|mortarthicknessrand=1.5|circle=true|switching=true|offsetrand=true",
      "brick|returnid=true|tiling=true|rows=7|columns=5|seamless=true|scale=.3",
      "brick|mainfunction=get0*.1+get1*.05",
      "block|mainfunction=get(10)*.03",
      "weave|roundthreads=true|rows=2|columns=3|matrix=101010|shadecrossings=false",
      "star|noise=.6|turb=.4|ninja=2|roundjag=1.5|jags=7",
      "mandelbrot|paintmode=1|boundary=16",
      "mandelbrot|julia=true|paintmode=2",
      "mandelbrot|power=3|paintmode=3|max=8",
      "led|displaynumber=123.45|numdigits=6|scale=2",
      "sparkle|amount=60|rays=9|randomness=.8",
      "wood|makerings=true|rings=8",
      "marble|octaves=5|absturb=false|seamless=true|scale=.6",
      "xplo|absturb=true|turbadd=.2",
      "smear|turbulence=2|density=.7",
      "voronoifunky|types=fbm,voronoi|idfilter=o|filter=x",
      "base|mainfunction=smoothpulse(.1,.3,.6,x)+boxstep(.2,.7,y)*pulse(.3,.6,x)-gain(.3,y)*bias(.7,x)",
      "base|mainfunction=linedist(.1,.2,.8,.9)+rectangledist(.2,.3,.4,.6)+ovaldist(.5,.5,2,3)*.2+moddist(.3,.4)",
      "base|mainfunction=s(x*30)*c(y*17)+tan(x)+atan(y*4)*.2+acos(x-y)*.1+log(x+.2)*.1+heartbeat(x*3,.7)",
      "base|mainfunction=noise(x*9)+noise3d(x*5,y*4,x+y)+absturbulence3d(x*4,y*3,.2,4.5)+turbulence(y*6,3)",
      "base|mainfunction=(0-x)^3+x^2.3+mod(x*7,1.3)*.2-sqrt(y)+region(5,7)+random*.3+churn(floor(x*9))",
      "base|afunction=rotate(.5,.4,1.2)|bfunction=zoom(.3,.3,2+a)|mainfunction=noise2d(x*8,y*8)+b",
      "base|afunction=sphere(.5,.5)|perturbx=x+.1*s(y*9)|perturby=y+.05|mainfunction=fbm+.4*[brick|scale=.4]*star",
      "base|mainfunction=set(3,x*y)+get(3)+infox*.01+infominwh*.001+octaveadd*.1+posx-posz+sky+normaldot*.2",
      "base|mainfunction=x|colorfunction=colmix(hsv(x,y,.8),texmap(main),.4)|textures=[noise|cols=red,blue|range=2],"
      "oak,[col]",
      "base|mainfunction=y|textures=leather,[fbm|fade=.3],walnut|bumpfunction=texmappedbump|frictionfunction="
      "texmappedfriction|"
      "colorfunction=texmap2(.3,1,1,x)",
      "base|mainfunction=1.7*x-.4|cols=oak,rust,<.1,.9,.3>|abs=true|invert=true|limitlo=.1|limithi=.8|intensity=1.2|"
      "add=-.1",
      "multi|textures=brick_wall,[multi|textures=[fbm|alphafunction=.6|colorblend=sub|bumpblend=interpolate],[sd|sdkey="
      "hmcolor|"
      "alphafunction=main]|alphafunction=.7],[moss|alphafunction=huedist(.3)+coldist(red)*.2]|bumpscale=1.5|alphascale="
      ".8",
      "multi|seamless=true|scale=.5|textures=[wood|scale=.5],[voronoi|alphafunction=saturation*value|colorfunction="
      "colgamma("
      "colscale(currentcolor,1.2),1.6)]",
  };
  for (std::size_t k = 0; k < more.size(); ++k) cases.push_back({"more_" + std::to_string(k), more[k]});
  return cases;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

std::string write_case(const ShaderCase& one, const std::filesystem::path& folder) {
  CompileOptions compile;
  compile.time = 0.7;
  const ProceduralTexture texture = compile_texture(one.recipe, RecipeLibrary::builtin(), compile);
  std::string entry = "{\"name\": " + quoted(one.name) + ", \"recipe\": " + quoted(one.recipe);
  ShaderOptions options{ShaderLanguage::glsl, k_width, k_height};
  try {
    write_text(folder / (one.name + ".frag"), shader_source(texture, options));
    options.language = ShaderLanguage::wgsl;
    write_text(folder / (one.name + ".wgsl"), shader_source(texture, options));
  } catch (const InvalidInput& refusal) {
    return entry + ", \"refused\": " + quoted(refusal.what()) + "}";
  }
  RenderOptions render;
  render.width = k_width, render.height = k_height, render.channels = (1U << k_channels) - 1;
  const TextureValues values = render_texture(texture, render).values;
  std::vector<float> reference;
  for (std::size_t i = 0; i < std::size_t{k_width} * k_height; ++i) {
    for (std::size_t k = 0; k < 3; ++k) reference.push_back(values[Channel::color][3 * i + k]);
    reference.push_back(values[Channel::alpha][i]);
  }
  for (int c = 0; c + 1 < k_channels; ++c)
    reference.insert(reference.end(), values.channels[static_cast<std::size_t>(c)].begin(),
                     values.channels[static_cast<std::size_t>(c)].end());
  std::ofstream(folder / (one.name + ".f32"), std::ios::binary)
      .write(reinterpret_cast<const char*>(reference.data()),
             static_cast<std::streamsize>(reference.size() * sizeof(float)));
  return entry + "}";
}

}  // namespace
}  // namespace papilla

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  std::string json;
  for (const papilla::ShaderCase& one : papilla::shader_cases())
    json += (json.empty() ? "" : ",\n  ") + papilla::write_case(one, folder);
  papilla::write_text(folder / "cases.json", "{\"width\": " + std::to_string(papilla::k_width) +
                                                 ", \"height\": " + std::to_string(papilla::k_height) +
                                                 ", \"cases\": [\n  " + json + "]}\n");
  return 0;
}
