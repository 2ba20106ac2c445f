// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler.hpp"
#include "papilla/core/near_name.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr std::size_t k_deepest = 32;
constexpr std::size_t k_most_nodes = 1024;
constexpr double k_most_evaluations = 1e5;

void place_and_limits(Node& node, const Arguments& arguments) {
  const auto scale = arguments.vector("scale"), shift = arguments.vector("shift");
  const double sx = scale[0] * arguments.number("sx") * arguments.number("privatescalex");
  const double sy = (scale[1] == 0 && scale[2] == 0 ? scale[0] : scale[1]) * arguments.number("sy") *
                    arguments.number("privatescaley");
  if (!(std::abs(sx) >= 1e-9 && std::abs(sy) >= 1e-9 && std::abs(sx) <= 1e9 && std::abs(sy) <= 1e9))
    arguments.refuse("scale", "the scale must be between 1e-9 and 1e9");
  node.inverse_scale_x = 1 / sx, node.inverse_scale_y = 1 / sy;
  node.du = arguments.number("du") + shift[0], node.dv = arguments.number("dv") + shift[1];
  const double turn = arguments.number("rot");
  node.cos_rot = std::cos(turn), node.sin_rot = turn == 0 ? 0 : std::sin(turn);
  node.stretch = arguments.flag("stretch") || arguments.flag("strech");
  node.seamless = arguments.settings_for_inner().seamless;
  node.absolute = arguments.flag("abs"), node.invert = arguments.flag("invert");
  node.limit_low = arguments.number("limitlo"), node.limit_high = arguments.number("limithi");
  if (node.limit_low > node.limit_high) arguments.refuse("limitlo", "limitlo exceeds limithi");
  node.intensity = arguments.number("intensity"), node.add = arguments.number("add");
  const auto unit = [&](const char* name) {
    auto v = arguments.vector(name);
    const double length = std::hypot(v[0], v[1], v[2]);
    if (!(length > 0 && std::isfinite(length))) arguments.refuse(name, "expected a direction <x,y,z>");
    for (double& c : v) c /= length;
    return v;
  };
  node.normal = unit("normal"), node.dirt = unit("dirtdirection");
  node.range = arguments.number("range"), node.fade = arguments.number("fade");
  node.colours = arguments.colours("cols");
}

PreviewLight light_of(const Arguments& arguments) {
  PreviewLight light{arguments.flag("shade"), arguments.flag("pointlight"), arguments.flag("lightdist"),
                     arguments.flag("quickshade")};
  light.x = arguments.number("lightx"), light.y = arguments.number("lighty"), light.z = arguments.number("lightz");
  light.scale = arguments.number("lightscale"), light.ambient = arguments.number("ambient");
  if (light.falls && !light.at_a_point)
    arguments.refuse("lightdist", "a light without a place is at no distance; add pointlight=true");
  return light;
}

Blend blend_named(const std::string& name) {
  return name == "off" ? Blend::off : name == "add" ? Blend::add : name == "sub" ? Blend::subtract : Blend::interpolate;
}

/// The formulas of a texture, in the order of their evaluation.
/// @returns whether mainfunction asks for a neighbourhood.
bool formulas(Node& node, Arguments& arguments) {
  FormulaScope& scope = arguments.scope();
  scope.lower_level = scope.graph->deepest_near();
  const auto unless_zero = [&](const char* name, FormulaStage stage) {
    scope.stage = stage;
    return arguments.given(name) ? arguments.formula(name) : Program{};
  };
  node.a = unless_zero("afunction", FormulaStage::first), node.b = unless_zero("bfunction", FormulaStage::second);
  if (arguments.flag("pertube")) {
    node.perturb_x = unless_zero(arguments.given("perturbx") ? "perturbx" : "pertubex", FormulaStage::place);
    node.perturb_y = unless_zero(arguments.given("perturby") ? "perturby" : "pertubey", FormulaStage::place);
  }
  const bool before = std::exchange(scope.uses_near, false);
  scope.stage = FormulaStage::main;
  node.main = arguments.formula("mainfunction");
  const bool main_uses_near = std::exchange(scope.uses_near, before || scope.uses_near);
  scope.stage = FormulaStage::channel;
  node.blend.fill(Blend::interpolate);
  node.channel_scale.fill(1);
  for (std::size_t c = 1; c < k_channels; ++c) {
    const auto channel = static_cast<Channel>(c);
    const std::string base = std::string(to_string(channel)), name = base + "function";
    const bool from_below = node.layered >> c & 1U;
    if (arguments.given(name) || channel == Channel::alpha || (!from_below && channel != Channel::roughness))
      node.channels[c] = channel == Channel::color ? arguments.colour_formula(name) : arguments.formula(name);
    if (channel != Channel::alpha && channel != Channel::coloralpha)
      node.blend[c] = blend_named(arguments.text(base + "blend"));
    if (node.multi && find_parameter(*node.type, base + "scale") && channel != Channel::color)
      node.channel_scale[c] = arguments.number(base + "scale");
  }
  const auto changes = [&](Channel c) {
    return node.channels[static_cast<std::size_t>(c)].present || node.channel_scale[static_cast<std::size_t>(c)] != 1;
  };
  node.own_highlight = !node.channels[static_cast<std::size_t>(Channel::roughness)].present &&
                       (!(node.layered >> static_cast<std::size_t>(Channel::roughness) & 1U) ||
                        changes(Channel::specular) || changes(Channel::specularcoeff));
  node.cuts = arguments.text("alphablend") == "cut";
  return main_uses_near;
}

}  // namespace

std::shared_ptr<const Graph> Compiler::compile(std::string_view recipe) {
  const Origin& origin = keep({options_.source, recipe});
  const InheritedSettings inherited{static_cast<double>(options_.seed & 0xFFFFFFFFU), options_.time, options_.seamless};
  const auto root = texture(trimmed({recipe, 0}), origin, inherited);
  if (!root) {
    const Piece head = split_recipe(trimmed({recipe, 0}), origin).head;
    fail_at(origin, head.position, "unknown texture " + in_quotes(head.text) + did_you_mean(head.text, known_names()));
  }
  graph_->root = *root;
  return graph_;
}

std::optional<int> Compiler::texture(Piece recipe, const Origin& origin, const InheritedSettings& inherited) {
  const RecipeSyntax syntax = split_recipe(recipe, origin);
  if (!find_type(syntax.head.text) && !library_.find(syntax.head.text)) return std::nullopt;
  const std::string key = std::string(recipe.text) + '\n' + std::to_string(inherited.seed) + '/' +
                          std::to_string(inherited.time) + (inherited.seamless ? 's' : '-');
  if (const auto it = made_.find(key); it != made_.end()) return it->second;
  if (depth_ >= k_deepest)
    fail_at(origin, recipe.position, "textures are nested more than " + std::to_string(k_deepest) + " deep");
  ++depth_;
  const std::size_t open_before = open_.size();
  std::vector<Bound> bound;
  const TypeInfo& type = expand(syntax, origin, bound);
  const int made = build(type, std::move(bound), inherited, origin, recipe.position);
  open_.resize(open_before);
  --depth_;
  // A texture with a neighbourhood is compiled for every use, because each use has requests of its own.
  if (!node(made).uses_near) made_.emplace(key, made);
  return made;
}

std::vector<std::string_view> Compiler::known_names() const {
  std::vector<std::string_view> names;
  for (const TypeInfo& type : texture_types()) names.push_back(type.name);
  for (const auto& [name, recipe] : library_.recipes()) names.push_back(name);
  return names;
}

bool Compiler::is_open(std::string_view name) const {
  return std::find(open_.begin(), open_.end(), name) != open_.end();
}

std::string_view bottom_type(std::string_view name, const RecipeLibrary& library) {
  for (int step = 0; step < 64; ++step) {
    if (find_type(name)) return find_type(name)->name;
    const std::string* recipe = library.find(name);
    if (!recipe) return "";
    name = trimmed({std::string_view(*recipe).substr(0, recipe->find('|')), 0}).text;
  }
  return "";
}

void Compiler::open(std::string_view name, Piece place, const Origin& origin) {
  if (is_open(name)) {
    std::string way;
    for (const std::string& other : open_) way += other + " > ";
    fail_at(origin, place.position,
            "recipe " + in_quotes(name) + " uses itself: " + way.substr(way.find(name)) + std::string(name));
  }
  open_.emplace_back(name);
  if (open_.size() > 4 * k_deepest) fail_at(origin, place.position, "recipes refer to each other more than 128 deep");
}

/// Follows names down to the type; outer parameters come behind inner ones.
const TypeInfo& Compiler::expand(const RecipeSyntax& syntax, const Origin& origin, std::vector<Bound>& bound) {
  const std::string_view head = syntax.head.text;
  const TypeInfo* type = find_type(head);
  if (!type) {
    const auto found = library_.recipes().find(head);
    if (found == library_.recipes().end())
      fail_at(origin, syntax.head.position, "unknown texture " + in_quotes(head) + did_you_mean(head, known_names()));
    open(head, syntax.head, origin);
    graph_->recipes.emplace(head);
    const Origin& inner = keep({"recipe '" + std::string(head) + "'", found->second});
    type = &expand(split_recipe(trimmed({inner.whole, 0}), inner), inner, bound);
  }
  for (const Assignment& a : syntax.parameters) bound.push_back({a.name, a.value, &origin});
  return *type;
}

int Compiler::build(const TypeInfo& type, std::vector<Bound> bound, const InheritedSettings& inherited,
                    const Origin& origin, std::size_t position) {
  Arguments arguments(*this, type, std::move(bound), inherited);
  auto made = std::make_unique<Node>();
  made->type = &type;
  made->multi = type.name == "multi";
  arguments.check_all();
  place_and_limits(*made, arguments);
  made->light = light_of(arguments);
  made->textures = arguments.textures(arguments.given("texes") ? "texes" : "textures");
  if (made->multi && made->textures.empty()) fail_at(origin, position, "'multi' needs the parameter 'textures'");
  arguments.use_textures(made->textures);
  for (const int child : made->textures) {
    made->ranges.push_back(node(child).range);
    made->fades.push_back(node(child).fade);
  }
  made->pattern = make_pattern(type.name, arguments);
  made->layered = made->multi ? k_all_channels : made->pattern ? made->pattern->given_channels() : 0;
  const bool four_corners = made->seamless && type.seamless == Seamless::four_corner;
  if (formulas(*made, arguments) && four_corners)
    arguments.refuse("mainfunction",
                     "neighbourhoods are not known where four corners are blended; use afunction or a channel");
  const FormulaScope& scope = arguments.scope();
  made->uses_normal = scope.uses_normal, made->uses_infos = scope.uses_infos, made->uses_near = scope.uses_near;
  if (made->uses_normal) graph_->dirt_directions.insert(made->dirt);
  if (type.name == "checker3d") graph_->uses_position = true;
  made->evaluations = (four_corners ? 4 : 1) * (1 + scope.cost);
  if (made->evaluations > k_most_evaluations)
    fail_at(origin, position, "the recipe evaluates more than 100000 textures a point");
  if (graph_->nodes.size() >= k_most_nodes)
    fail_at(origin, position, "the recipe holds more than " + std::to_string(k_most_nodes) + " textures");
  graph_->nodes.push_back(std::move(made));
  return static_cast<int>(graph_->nodes.size()) - 1;
}

}  // namespace papilla::procedural_detail

namespace papilla {

ProceduralTexture compile_texture(std::string_view recipe, const RecipeLibrary& library,
                                  const CompileOptions& options) {
  return ProceduralTexture(procedural_detail::Compiler(library, options).compile(recipe));
}

bool ProceduralTexture::depends_on_normal() const noexcept { return graph_->uses_normal; }
bool ProceduralTexture::depends_on_position() const noexcept { return graph_->uses_position; }
bool ProceduralTexture::depends_on_sky() const noexcept { return graph_->uses_sky; }
bool ProceduralTexture::depends_on_flow() const noexcept { return graph_->uses_flow; }
bool ProceduralTexture::depends_on_time() const noexcept { return graph_->uses_time; }
bool ProceduralTexture::depends_on_neighbours() const noexcept { return !graph_->near.empty(); }
std::vector<std::array<double, 3>> ProceduralTexture::dirt_directions() const {
  return {graph_->dirt_directions.begin(), graph_->dirt_directions.end()};
}
std::vector<std::string> ProceduralTexture::recipes_used() const {
  return {graph_->recipes.begin(), graph_->recipes.end()};
}

}  // namespace papilla
