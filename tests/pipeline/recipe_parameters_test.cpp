// SPDX-License-Identifier: MIT
// Every parameter of every type of the table changes something that is written, or is refused with a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/contact_sheet.hpp"
#include "papilla/procedural/preview.hpp"
#include "papilla/procedural/reference.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

/// What else a recipe needs before a parameter can show: by "type.parameter", else by "parameter".
const std::map<std::string, std::string>& contexts() {
  static const std::map<std::string, std::string> all = {
      {"brickfunky.onlytimedependant", "types=fbm,base"},
      {"brickfunky.onlynormaldependant", "types=fbm,noise"},
      {"voronoifunky.onlytimedependant", "types=fbm,base"},
      {"voronoifunky.onlynormaldependant", "types=fbm,noise"},
      {"brick.rows", "tiling=true"},
      {"brick.columns", "tiling=true"},
      {"brick.mortarthicknessrandscale", "mortarthicknessrand=2"},
      {"fbm.offset", "type=multifractal"},
      {"ifs.ipolfuncindex", "ipolfunc=.5"},
      {"ifs.one", "usestyle=false|four=.5 0 0 .5 .1 .2 .5"},
      {"ifs.two", "usestyle=false|one=.5 0 0 .5 .1 .2 .5"},
      {"ifs.three", "usestyle=false|one=.5 0 0 .5 .1 .2 .5"},
      {"ifs.four", "usestyle=false|one=.5 0 0 .5 .1 .2 .5"},
      {"ifs.usestyle", "one=.5 0 0 .5 .1 .2 .5"},
      {"image.width", "fit2screen=false"},
      {"image.height", "fit2screen=false"},
      {"image.repeat", "scale=.3"},
      {"led.exponent", "displaynumber=3.25"},
      {"led.numdecimals", "displaynumber=3.25"},
      {"mandelbrot.rr", "julia=true"},
      {"mandelbrot.ii", "julia=true"},
      {"mandelbrot.forceintegerpow", "power=2.4"},
      {"mandelbrot.boundary", "paintmode=1"},
      {"marble.absturb", "octaves=3"},
      {"sparkle.rays", "amount=50"},
      {"star.repeat", "scale=.3"},
      {"txt.centerx", "txt=longer\\nx"},
      {"txt.spacingy", "txt=a\\nb"},
      {"voronoi.distmodea", "distmode=2"},
      {"voronoi.distmodeb", "distmode=2"},
      {"voronoiseamless.distmodea", "distmode=2"},
      {"voronoiseamless.distmodeb", "distmode=2"},
      {"voronoi.displace", "displacemode=3"},
      {"voronoi.lacunarity", "octaves=3"},
      {"voronoi.weights", "octaves=3"},
      {"voronoi.cell_initmode", "octaves=3"},
      {"voronoi.initpower", "octaves=3|cell_initmode=2"},
      // Of every type.
      {"abs", "mainfunction=this-1.2"},
      {"afunction", "mainfunction=a"},
      {"bfunction", "mainfunction=b"},
      {"cols", "colorfunction=colmap(x)"},
      {"dirtdirection", "normal=<.3,.4,.5>|mainfunction=normaldot"},
      {"normal", "mainfunction=normaldot"},
      {"fixtime", "time=.9|mainfunction=this+time"},
      {"time", "fixtime=true|mainfunction=this+time"},
      {"periodicmod", "timemodifiers=intensity:1+time"},
      {"usetimemodifiers", "timemodifiers=intensity:1+time"},
      {"lightdist", "pointlight=true"},
      {"limitlo", "mainfunction=x"},
      {"lightx", "bumpfunction=x"},
      {"lighty", "bumpfunction=y"},
      {"quickshade", "bumpfunction=.3*s(x*40)"},
      {"fbm.minimumoctaves", "octaves=7|scale=.02"},
      {"fbm.dynamicoctaves", "octaves=9|scale=.1"},
      {"turbulence.minimumoctaves", "octaves=7|scale=.02"},
      {"turbulence.dynamicoctaves", "octaves=9|scale=.1"},
      {"pertube", "perturbx=x*.4+.2"},
      {"textures", "textures=[noise],[checker]|colorfunction=texmap(x)"},
      {"texes", "textures=[noise],[checker]|colorfunction=texmap(x)"},
      {"seamless", "scale=.37|mainfunction=this+x"},
      {"seed", "mainfunction=this+[noise|scale=.3]"},
      {"stretch", "mainfunction=this+x"},
      {"strech", "mainfunction=this+x"},
  };
  return all;
}

/// Values of texts and formulas, for which no rule makes one.
const std::map<std::string, std::vector<std::string>>& own_values() {
  static const std::map<std::string, std::vector<std::string>> all = {
      {"weights", {"1 .2 .7 .1"}},
      {"picpath", {"picture.png"}},
      {"one", {".4 .1 -.1 .4 .3 .1 .6"}},
      {"two", {".4 .1 -.1 .4 .3 .1 .6"}},
      {"three", {".4 .1 -.1 .4 .3 .1 .6"}},
      {"four", {".4 .1 -.1 .4 .3 .1 .6"}},
      {"posandscale", {"0 .1 .6 .7"}},
      {"txt", {"Hey"}},
      {"txtstyle", {"Serif"}},
      {"types", {"brick,fbm"}},
      {"idfilter", {"rust"}},
      {"filter", {"polish"}},
      {"matrix", {"1000010000100001"}},
      {"idmaterial", {"zirconium"}},
      {"matid", {"zirconium"}},
      {"idtype", {"zirconium"}},
      {"timemodifiers", {"intensity:2+time"}},
      {"func", {"f2-f1"}},
      {"densityfunc", {"3"}},
      {"ipolfunc", {".5"}},
      {"displaynumber", {"12.5"}},
      {"type", {}},
  };
  return all;
}

/// Where refusals are expected; the types are all, or those named.
bool may_be_refused(const TypeInfo& type, std::string_view parameter) {
  const std::set<std::string_view> always = {"u",         "v",         "uORIG",          "vORIG",
                                             "usetables", "shadethem", "shadethempoint", "txtstyle"};
  const std::set<std::string_view> of_octaves = {"dynamicoctaves", "minimumoctaves", "maximumoctaves"};
  return always.contains(parameter) ||
         (of_octaves.contains(parameter) && type.name != "fbm" && type.name != "turbulence");
}

std::string number_text(double v, bool whole) {
  return whole ? std::to_string(static_cast<long>(std::lround(v))) : std::to_string(v);
}

std::vector<std::string> values_of(const ParameterInfo& p) {
  if (const auto it = own_values().find(std::string(p.name)); it != own_values().end() && !it->second.empty())
    return it->second;
  std::vector<std::string> values;
  switch (p.kind) {
    case ParameterKind::number:
    case ParameterKind::integer: {
      const double preset = std::stod(std::string(p.preset));
      for (const double v : {1.5 * preset + 0.3, preset / 2, 0.55, preset + 1, preset + 2, preset - 1, p.low, p.high})
        if (v >= p.low && v <= p.high && std::abs(v) <= 1e4)
          values.push_back(number_text(v, p.kind == ParameterKind::integer));
      break;
    }
    case ParameterKind::flag: values = {p.preset == "true" ? "false" : "true"}; break;
    case ParameterKind::choice:
      for (std::string_view rest = p.note; !rest.empty();) {
        const std::string_view word = rest.substr(0, rest.find(' '));
        values.emplace_back(word);
        rest.remove_prefix(std::min(rest.size(), word.size() + 1));
      }
      break;
    case ParameterKind::vector: values = {"<.3,.5,.7>"}; break;
    case ParameterKind::colours: values = {"red,green,blue"}; break;
    case ParameterKind::colour: values = {"<.1,x,.7>"}; break;
    case ParameterKind::expression: values = {"x*.7+.1", "y*.3"}; break;
    case ParameterKind::textures: values = {"[star|jags=4]"}; break;
    case ParameterKind::text: break;
  }
  return values;
}

/// Everything that is written of a recipe: channels, the lit picture, what it is suggested for and shown on.
struct Outputs {
  TextureValues values;
  std::vector<float> lit;
  std::vector<std::string> names;
};

Outputs outputs_of(const std::string& recipe) {
  RecipeLibrary library = RecipeLibrary::builtin();
  CompileOptions options;
  options.time = 0.5, options.target_px = 40;
  options.read_picture = [](const std::string&) { return RecipePicture{2, 1, {1, 0, 0, 0, 1, 0}}; };
  const ProceduralTexture texture = compile_texture(recipe, library, options);
  RenderOptions render;
  render.width = 30, render.height = 20, render.channels = (1U << k_channels) - 1;
  RenderedTexture rendered = render_texture(texture, render);
  Outputs out{{}, light_texture(texture, rendered, 2), {}};
  out.values = std::move(rendered.values);
  library.add("probe", recipe);
  out.names = suggest_recipes("zirconium", library);
  for (const auto& [name, shown] : examples_of_library(library))
    if (name == "probe") out.names.push_back(shown.substr(0, shown.find(',')));
  return out;
}

bool same(const Outputs& a, const Outputs& b) {
  const bool names = a.names.size() == b.names.size() && (a.names == b.names);
  return names && a.lit == b.lit && a.values.channels == b.values.channels;
}

/// The recipe of a type with a context, as parameters of textures within others need it.
std::string recipe_for(const TypeInfo& type, std::string_view parameter, const std::string& more) {
  std::string recipe = test::example_of(type.name);
  if (type.name == "sd") recipe = "sd";
  const auto& all = contexts();
  auto context = all.find(std::string(type.name) + "." + std::string(parameter));
  if (context == all.end()) context = all.find(std::string(parameter));
  if (context != all.end() && !context->second.empty()) recipe += "|" + context->second;
  recipe += more;
  if (parameter == "range" || parameter == "fade")
    return "base|colorfunction=texmap(x)|textures=[" + recipe + "],[col|colorfunction=red]";
  if (parameter.ends_with("blend") || parameter == "sdkey")
    return "multi|textures=[leather|reflectionfunction=.4],[" + recipe + "|" +
           (parameter == "alphafunction" ? "" : "alphafunction=.5|") + "reflectionfunction=.7|bumpfunction=.2]";
  return recipe;
}

class ParameterOfType : public testing::TestWithParam<std::string> {};

TEST_P(ParameterOfType, ChangesSomethingOrIsRefusedWithAReason) {
  const TypeInfo& type = *find_type(GetParam());
  std::vector<ParameterInfo> parameters(type.parameters.begin(), type.parameters.end());
  for (const ParameterInfo& common : common_parameters())
    if (find_parameter(type, common.name) == &common) parameters.push_back(common);
  for (const ParameterInfo& p : parameters) {
    // Types without a pattern of their own over the place get one by their formulas.
    bool changed = false;
    std::string refusal;
    for (const std::string& formula : {std::string(), std::string("|mainfunction=this+.3*x+.2*y|bumpfunction=main"),
                                       std::string("|textures=[noise],[checker]|colorfunction=texmap(x)")}) {
      if (type.name == "multi" && formula.find("textures") != std::string::npos) continue;
      const std::string name(p.name);
      // A parameter stands once, and aliases of one that stands would hide it.
      if (formula.find(name + "=") != std::string::npos || (name == "texes" && !formula.empty())) continue;
      const auto plain = [&](const std::string& more) { return recipe_for(type, p.name, formula + more); };
      const Outputs before = outputs_of(plain(""));
      for (const std::string& value : values_of(p)) {
        if (changed) break;
        try {
          changed = !same(before, outputs_of(plain("|" + name + "=" + value)));
        } catch (const InvalidInput& error) {
          refusal = error.what();
        }
      }
      if (changed) break;
    }
    if (may_be_refused(type, p.name)) {
      EXPECT_FALSE(changed) << type.name << "." << p.name << " is no longer refused";
      EXPECT_NE(refusal.find(std::string(p.name)), std::string::npos) << type.name << "." << p.name << ": " << refusal;
    } else {
      EXPECT_TRUE(changed) << type.name << "." << p.name << " changes nothing " << refusal;
    }
  }
}

std::vector<std::string> all_types() {
  std::vector<std::string> names;
  for (const TypeInfo& type : texture_types()) names.emplace_back(type.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Types, ParameterOfType, testing::ValuesIn(all_types()),
                         [](const auto& type) { return type.param; });

TEST(ParameterTable, PromisesNoEffectThatThereIsNot) {
  EXPECT_EQ(reference_markdown().find("without effect"), std::string::npos);
}

TEST(Preview, IsThePhongModelOfTheChannels) {
  // A plane that rises by a half of its width, in 1 texel of relief a unit of height: N = (-s, 0, 1) / |.|.
  const std::string plane =
      "base|bumpfunction=x*20|colorfunction=<.5,.25,.1>|diffusefunction=.8|specularfunction=.6|specularcoefffunction=3";
  const auto at_middle = [&](const std::string& light) {
    const ProceduralTexture texture = compile_texture(plane + light, RecipeLibrary::builtin());
    RenderOptions options;
    options.width = options.height = 21, options.channels = k_preview_channels;
    const std::vector<float> lit = light_texture(texture, render_texture(texture, options), 1);
    return static_cast<double>(lit[3 * (10 * 21 + 10)]);
  };
  const double s = 20.0 / 21, n = std::sqrt(1 + s * s), l = std::sqrt(1.5);
  const double facing = (-s * 0.5 + 1) / n / l, mirrored = 2 * facing / n - 1 / l;
  const double phong = 0.5 * (0.1 + 0.9 * 0.8 * facing) + 0.9 * 0.6 * std::pow(std::max(0.0, mirrored), 3);
  EXPECT_NEAR(at_middle("|ambient=.1|lightscale=.9"), phong, 1e-6);
  EXPECT_NEAR(at_middle("|shade=false"), 0.5, 1e-6);
  // A point light two sides above the middle of a flat picture, where the height is 0.
  const ProceduralTexture flat = compile_texture(
      "base|bumpfunction=0|colorfunction=<.5,.5,.5>|specularfunction=0|pointlight=true|lightdist=true|"
      "lightx=0|lighty=0|lightz=2",
      RecipeLibrary::builtin());
  RenderOptions options;
  options.width = options.height = 21, options.channels = k_preview_channels;
  const std::vector<float> lit = light_texture(flat, render_texture(flat, options), 1);
  EXPECT_NEAR(static_cast<double>(lit[3 * (10 * 21 + 10)]), 0.5 / 4, 1e-6);
  const double d2 = 4 + 2 * std::pow(10.0 / 21, 2);
  EXPECT_NEAR(static_cast<double>(lit[0]), 0.5 / d2 * 2 / std::sqrt(d2), 1e-6);
}

TEST(Image, WithoutHeightShowsThePicturesColours) {
  CompileOptions options;
  options.read_picture = [](const std::string&) { return RecipePicture{1, 1, {0.2F, 0.4F, 0.6F}}; };
  const auto rendered = test::rendered("image|picpath=a.png|calcheight=false", 8, RecipeLibrary::builtin(), options,
                                       (1U << k_channels) - 1);
  EXPECT_FLOAT_EQ(rendered.values[Channel::color][1], 0.4F);
  EXPECT_EQ(rendered.values[Channel::bump][0], 0);
  EXPECT_EQ(rendered.values[Channel::alpha][0], 1);
}

}  // namespace
}  // namespace papilla
