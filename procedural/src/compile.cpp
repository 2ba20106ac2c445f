// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>

#include "formula.hpp"
#include "papilla/core/error.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr std::size_t k_deepest = 32;
constexpr std::size_t k_most_nodes = 1024;
constexpr double k_most_evaluations = 1e5;

/// What a texture hands to those within it.
struct Heritage {
  double seed = 0, time = 0;
  bool seamless = false;
};

struct Bound {
  Piece name, value;
  const Origin* origin;
};

class Compiler;

/// The parameters of one texture.
class Arguments final : public TypeArguments {
 public:
  Arguments(Compiler& compiler, const TypeInfo& type, std::vector<Bound> bound, Heritage heritage);
  double number(std::string_view name) const override;
  std::string text(std::string_view name) const override;
  Program formula(std::string_view name) override;
  std::vector<int> textures(std::string_view name) override;
  std::vector<int> matching_textures(std::size_t most) override;
  bool mentions(std::string_view word) const override;
  RecipePicture picture(const std::string& path) const override;
  const Graph& graph() const override;
  double time() const override { return time_; }
  [[noreturn]] void refuse(std::string_view name, const std::string& reason) const override;

  bool given(std::string_view name) const { return bound_.contains(name); }
  std::array<double, 3> vector(std::string_view name) const;
  std::vector<Rgb> colours(std::string_view name) const;
  Program colour_formula(std::string_view name);
  Heritage handed_down() const { return {seed_, time_, number("seamless") != 0 || heritage_.seamless}; }
  void check_all();
  void use_textures(const std::vector<int>& nodes);
  FormulaScope& scope() { return scope_; }

 private:
  Bound of(std::string_view name) const;
  const ParameterInfo& info(std::string_view name) const;
  double constant(Piece text, const Origin& origin, double time) const;
  double checked(const ParameterInfo& p, double value, std::string_view name) const;
  void read_time_modifiers();

  Compiler& compiler_;
  const TypeInfo& type_;
  std::map<std::string_view, Bound> bound_;
  Heritage heritage_;
  double seed_ = 0, time_ = 0;
  std::map<std::string, double, std::less<>> modified_;
  FormulaScope scope_;
};

class Compiler {
 public:
  Compiler(const RecipeLibrary& library, const CompileOptions& options)
      : library_(library), options_(options), graph_(std::make_shared<Graph>()) {}

  std::shared_ptr<const Graph> compile(std::string_view recipe) {
    const Origin& origin = keep({options_.source, recipe});
    const Heritage heritage{static_cast<double>(options_.seed & 0xFFFFFFFFU), options_.time, options_.seamless};
    const auto root = texture(trimmed({recipe, 0}), origin, heritage);
    if (!root) {
      const Piece head = split_recipe(trimmed({recipe, 0}), origin).head;
      fail_at(origin, head.position,
              "unknown texture " + in_quotes(head.text) + did_you_mean(head.text, known_names()));
    }
    graph_->root = *root;
    return graph_;
  }

  /// Nothing when neither a type nor a recipe has the name of the head.
  std::optional<int> texture(Piece recipe, const Origin& origin, const Heritage& heritage) {
    const RecipeSyntax syntax = split_recipe(recipe, origin);
    if (!find_type(syntax.head.text) && !library_.find(syntax.head.text)) return std::nullopt;
    const std::string key = std::string(recipe.text) + '\n' + std::to_string(heritage.seed) + '/' +
                            std::to_string(heritage.time) + (heritage.seamless ? 's' : '-');
    if (const auto it = made_.find(key); it != made_.end()) return it->second;
    if (depth_ >= k_deepest)
      fail_at(origin, recipe.position, "textures are nested more than " + std::to_string(k_deepest) + " deep");
    ++depth_;
    const std::size_t open = open_.size();
    std::vector<Bound> bound;
    const TypeInfo& type = expand(syntax, origin, bound);
    const int node = build(type, std::move(bound), heritage, origin, recipe.position);
    open_.resize(open);
    --depth_;
    made_.emplace(key, node);
    return node;
  }

  std::vector<std::string_view> known_names() const {
    std::vector<std::string_view> names;
    for (const TypeInfo& type : texture_types()) names.push_back(type.name);
    for (const auto& [name, recipe] : library_.recipes()) names.push_back(name);
    return names;
  }
  std::optional<std::vector<Rgb>> colour_list(std::string_view name, int depth = 0) const {
    if (const auto rgb = named_colour(name)) return std::vector<Rgb>{*rgb};
    const std::string* list = library_.find_colours(name);
    if (!list || depth > 16) return std::nullopt;
    return parse_colours({*list, 0}, {"colour '" + std::string(name) + "'", *list}, depth + 1);
  }
  std::vector<Rgb> parse_colours(Piece text, const Origin& origin, int depth = 0) const;

  const RecipeLibrary& library() const { return library_; }
  const CompileOptions& options() const { return options_; }
  Graph& graph() { return *graph_; }
  const Graph& graph() const { return *graph_; }
  const Origin& keep(Origin origin) { return origins_.emplace_back(std::move(origin)); }
  bool is_open(std::string_view name) const { return std::find(open_.begin(), open_.end(), name) != open_.end(); }
  /// The type at the bottom of a named recipe.
  std::string_view bottom_type(std::string_view name) const {
    for (int step = 0; step < 64; ++step) {
      if (find_type(name)) return find_type(name)->name;
      const std::string* recipe = library_.find(name);
      if (!recipe) return "";
      name = trimmed({std::string_view(*recipe).substr(0, recipe->find('|')), 0}).text;
    }
    return "";
  }

 private:
  /// Follows names down to the type; outer parameters come behind inner ones.
  const TypeInfo& expand(const RecipeSyntax& syntax, const Origin& origin, std::vector<Bound>& bound) {
    const std::string_view head = syntax.head.text;
    const TypeInfo* type = find_type(head);
    if (!type) {
      const auto found = library_.recipes().find(head);
      if (found == library_.recipes().end())
        fail_at(origin, syntax.head.position, "unknown texture " + in_quotes(head) + did_you_mean(head, known_names()));
      if (is_open(head)) {
        std::string way;
        for (const std::string& name : open_) way += name + " > ";
        fail_at(origin, syntax.head.position,
                "recipe " + in_quotes(head) + " uses itself: " + way.substr(way.find(head)) + std::string(head));
      }
      open_.emplace_back(head);
      if (open_.size() > 4 * k_deepest)
        fail_at(origin, syntax.head.position, "recipes refer to each other more than 128 deep");
      graph_->recipes.emplace(head);
      const Origin& inner = keep({"recipe '" + std::string(head) + "'", found->second});
      type = &expand(split_recipe(trimmed({inner.whole, 0}), inner), inner, bound);
    }
    for (const Assignment& a : syntax.parameters) bound.push_back({a.name, a.value, &origin});
    return *type;
  }

  int build(const TypeInfo& type, std::vector<Bound> bound, const Heritage& heritage, const Origin& origin,
            std::size_t position);
  void place_and_limits(Node& node, Arguments& arguments) const;
  void formulas(Node& node, Arguments& arguments) const;

  const RecipeLibrary& library_;
  const CompileOptions& options_;
  std::shared_ptr<Graph> graph_;
  std::deque<Origin> origins_;
  std::vector<std::string> open_;
  std::map<std::string, int> made_;
  std::size_t depth_ = 0;
};

std::vector<Rgb> Compiler::parse_colours(Piece text, const Origin& origin, int depth) const {
  std::vector<Rgb> out;
  std::size_t at = 0;
  const std::string_view s = text.text;
  while (at < s.size()) {
    if (s[at] == ' ' || s[at] == ',' || s[at] == '\t' || s[at] == '\n' || s[at] == '\r') {
      ++at;
      continue;
    }
    const std::size_t start = at;
    if (s[at] == '<') {
      Rgb rgb{};
      ++at;
      for (std::size_t k = 0; k < 3; ++k) {
        while (at < s.size() && s[at] == ' ') ++at;
        const auto [stop, error] = std::from_chars(s.data() + at, s.data() + s.size(), rgb[k]);
        if (error != std::errc() || !std::isfinite(rgb[k]))
          fail_at(origin, text.position + at, "expected a number of a colour <r,g,b>");
        at = static_cast<std::size_t>(stop - s.data());
        while (at < s.size() && s[at] == ' ') ++at;
        if (at >= s.size() || s[at] != (k < 2 ? ',' : '>'))
          fail_at(origin, text.position + at, std::string("expected '") + (k < 2 ? ',' : '>') + "' in the colour");
        ++at;
        rgb[k] = std::clamp(rgb[k], 0.0, 1.0);
      }
      out.push_back(rgb);
    } else {
      while (at < s.size() && s[at] != ',' && s[at] != ' ' && s[at] != '<') ++at;
      const auto list = colour_list(s.substr(start, at - start), depth);
      if (!list)
        fail_at(origin, text.position + start,
                "unknown colour " + in_quotes(s.substr(start, at - start)) + "; expected a name or <r,g,b>");
      out.insert(out.end(), list->begin(), list->end());
    }
    if (out.size() > 4096) fail_at(origin, text.position, "more than 4096 colours");
  }
  if (out.empty()) fail_at(origin, text.position, "expected colours");
  return out;
}

Arguments::Arguments(Compiler& compiler, const TypeInfo& type, std::vector<Bound> bound, Heritage heritage)
    : compiler_(compiler), type_(type), heritage_(heritage) {
  for (const Bound& b : bound) {
    const ParameterInfo* p = find_parameter(type, b.name.text);
    if (!p) {
      std::vector<std::string_view> known;
      for (const auto& own : type.parameters) known.push_back(own.name);
      for (const auto& common : common_parameters()) known.push_back(common.name);
      fail_at(*b.origin, b.name.position,
              "unknown parameter " + in_quotes(b.name.text) + " of " + in_quotes(type.name) +
                  did_you_mean(b.name.text, known));
    }
    bound_.insert_or_assign(p->name, b);
  }
  scope_.graph = &compiler.graph();
  scope_.globaltime = compiler.options().time;
  scope_.realtime = compiler.options().realtime_s;
  scope_.colour = [this](std::string_view name) -> std::optional<Rgb> {
    const auto list = compiler_.colour_list(name);
    return list ? std::optional(list->front()) : std::nullopt;
  };
  scope_.known_names = [this] { return compiler_.known_names(); };
  scope_.texture = [this](Piece recipe) { return compiler_.texture(recipe, *scope_.origin, handed_down()); };
  time_ = heritage.time;
  if (number("fixtime") != 0) time_ = number("time");
  scope_.time = time_;
  read_time_modifiers();
  seed_ = heritage.seed + number("seed");
  scope_.seed = seed_;
  scope_.du = number("du"), scope_.dv = number("dv");
  scope_.privatescalex = number("privatescalex"), scope_.privatescaley = number("privatescaley");
}

const Graph& Arguments::graph() const { return compiler_.graph(); }
const ParameterInfo& Arguments::info(std::string_view name) const { return *find_parameter(type_, name); }

Bound Arguments::of(std::string_view name) const {
  if (const auto it = bound_.find(name); it != bound_.end()) return it->second;
  const ParameterInfo& p = info(name);
  return {{p.name, 0}, {p.preset, 0}, &compiler_.keep({"default of " + std::string(name), p.preset})};
}

void Arguments::refuse(std::string_view name, const std::string& reason) const {
  const Bound b = of(name);
  fail_at(*b.origin, b.value.position, std::string(name) + ": " + reason);
}

double Arguments::constant(Piece text, const Origin& origin, double time) const {
  FormulaScope scope = scope_;
  scope.origin = &origin;
  scope.time = time;
  scope.point = scope.distances = scope.density = false;
  const Program program = compile_formula(text, false, scope);
  return program.value[0];
}

double Arguments::checked(const ParameterInfo& p, double value, std::string_view name) const {
  if (p.kind == ParameterKind::integer) value = std::round(value);
  if (value >= p.low && value <= p.high) return value;
  const auto plain = [](double v) {
    char text[32];
    const auto [stop, error] = std::to_chars(text, text + sizeof text, v);
    return std::string(text, stop);
  };
  refuse(name, "the value " + plain(value) + " is outside [" + plain(p.low) + ", " + plain(p.high) + "]");
}

double Arguments::number(std::string_view name) const {
  const ParameterInfo& p = info(name);
  if (name == "seed" && seed_ != 0) return std::fmod(seed_, 4294967296.0);
  if (const auto it = modified_.find(name); it != modified_.end()) return checked(p, it->second, name);
  const Bound b = of(name);
  if (p.kind == ParameterKind::flag) {
    if (b.value.text == "true" || b.value.text == "1") return 1;
    if (b.value.text == "false" || b.value.text == "0") return 0;
    refuse(name, "expected true or false, found " + in_quotes(b.value.text));
  }
  return checked(p, constant(b.value, *b.origin, scope_.time), name);
}

std::string Arguments::text(std::string_view name) const {
  const ParameterInfo& p = info(name);
  const Bound b = of(name);
  if (p.kind == ParameterKind::choice) {
    std::string_view rest = p.note;
    while (!rest.empty()) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      if (word == b.value.text) return std::string(word);
      rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    }
    refuse(name, "expected one of " + std::string(p.note) + ", found " + in_quotes(b.value.text));
  }
  return std::string(b.value.text);
}

std::array<double, 3> Arguments::vector(std::string_view name) const {
  const Bound b = of(name);
  Piece value = b.value;
  std::array<double, 3> out{};
  if (value.text.empty() || value.text.front() != '<') {
    out.fill(constant(value, *b.origin, scope_.time));
    return out;
  }
  if (value.text.back() != '>') refuse(name, "expected '>' behind the last number");
  const std::vector<Piece> parts =
      split_outside({value.text.substr(1, value.text.size() - 2), value.position + 1}, ',', *b.origin);
  if (parts.size() > 3) refuse(name, "expected at most three numbers");
  for (std::size_t k = 0; k < 3; ++k) out[k] = k < parts.size() ? constant(parts[k], *b.origin, scope_.time) : 0;
  return out;
}

std::vector<Rgb> Arguments::colours(std::string_view name) const {
  const Bound b = of(name);
  return compiler_.parse_colours(b.value, *b.origin);
}

Program Arguments::formula(std::string_view name) {
  const Bound b = of(name);
  if (b.value.text.empty()) return {};
  scope_.origin = b.origin;
  scope_.distances = name == "func";
  scope_.density = name == "densityfunc";
  scope_.point = !scope_.distances && !scope_.density && name != "ipolfunc" && name != "displaynumber";
  return compile_formula(b.value, false, scope_);
}

Program Arguments::colour_formula(std::string_view name) {
  const Bound b = of(name);
  scope_.origin = b.origin;
  scope_.point = true;
  scope_.distances = scope_.density = false;
  return compile_formula(b.value, true, scope_);
}

std::vector<int> Arguments::textures(std::string_view name) {
  const Bound b = of(name);
  std::vector<int> nodes;
  if (b.value.text.empty()) return nodes;
  scope_.origin = b.origin;
  for (Piece piece : split_outside(b.value, ',', *b.origin)) {
    if (!piece.text.empty() && piece.text.front() == '[' && piece.text.back() == ']')
      piece = trimmed({piece.text.substr(1, piece.text.size() - 2), piece.position + 1});
    if (piece.text.empty()) fail_at(*b.origin, piece.position, "expected a texture");
    const std::optional<int> node = compiler_.texture(piece, *b.origin, handed_down());
    if (!node)
      fail_at(*b.origin, piece.position,
              "unknown texture " + in_quotes(piece.text) + did_you_mean(piece.text, compiler_.known_names()));
    scope_.cost += compiler_.graph().nodes[static_cast<std::size_t>(*node)]->evaluations;
    nodes.push_back(*node);
  }
  return nodes;
}

std::vector<int> Arguments::matching_textures(std::size_t most) {
  const std::string types = "," + text("types") + ",", part = text("idfilter"), content = text("filter");
  const bool by_time = flag("onlytimedependant"), by_normal = flag("onlynormaldependant");
  std::vector<int> nodes;
  for (const auto& [name, recipe] : compiler_.library().recipes()) {
    const std::string_view bottom = compiler_.bottom_type(name);
    if (nodes.size() >= most || compiler_.is_open(name) || bottom == "brickfunky" || bottom == "voronoifunky") continue;
    if (types != ",," && types.find("," + std::string(bottom) + ",") == std::string::npos) continue;
    if (name.find(part) == std::string::npos || recipe.find(content) == std::string::npos) continue;
    if (by_time && recipe.find("time") == std::string::npos) continue;
    if (by_normal && recipe.find("normaldot") == std::string::npos) continue;
    const Origin& origin = compiler_.keep({"recipe '" + name + "'", name});
    nodes.push_back(*compiler_.texture({origin.whole, 0}, origin, handed_down()));
    scope_.cost += compiler_.graph().nodes[static_cast<std::size_t>(nodes.back())]->evaluations;
  }
  if (nodes.empty()) refuse("types", "no named recipe passes the filters");
  return nodes;
}

bool Arguments::mentions(std::string_view word) const {
  const auto in_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  };
  for (const auto& [name, b] : bound_) {
    const std::string_view s = b.value.text;
    for (std::size_t at = s.find(word); at != std::string_view::npos; at = s.find(word, at + 1)) {
      const bool starts = at == 0 || !in_word(s[at - 1]),
                 ends = at + word.size() == s.size() || !in_word(s[at + word.size()]);
      if (starts && ends) return true;
    }
  }
  return false;
}

RecipePicture Arguments::picture(const std::string& path) const {
  if (!compiler_.options().read_picture) refuse("picpath", "pictures can't be read here");
  RecipePicture picture = compiler_.options().read_picture(path);
  if (picture.width < 1 || picture.height < 1 ||
      picture.rgb.size() != 3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height))
    refuse("picpath", "the picture is empty");
  return picture;
}

/// parameter:formula;… ; periodicmod lets every formula f end where it begins: (1 - t) f(t) + t f(t - 1).
void Arguments::read_time_modifiers() {
  const Bound b = of("timemodifiers");
  if (b.value.text.empty() || number("usetimemodifiers") == 0) return;
  const bool periodic = number("periodicmod") != 0;
  compiler_.graph().uses_time = true;
  std::map<std::string, double, std::less<>> modified;
  for (const Piece& piece : split_outside(b.value, ';', *b.origin)) {
    const std::size_t colon = piece.text.find(':');
    if (colon == std::string_view::npos)
      fail_at(*b.origin, piece.position, "expected parameter:formula, found " + in_quotes(piece.text));
    const Piece name = trimmed({piece.text.substr(0, colon), piece.position}),
                text = trimmed({piece.text.substr(colon + 1), piece.position + colon + 1});
    const ParameterInfo* p = find_parameter(type_, name.text);
    if (!p || (p->kind != ParameterKind::number && p->kind != ParameterKind::integer))
      fail_at(*b.origin, name.position, in_quotes(name.text) + " is no numeric parameter of " + in_quotes(type_.name));
    const double now = constant(text, *b.origin, time_);
    modified[std::string(name.text)] =
        periodic ? (1 - time_) * now + time_ * constant(text, *b.origin, time_ - 1) : now;
  }
  modified_ = std::move(modified);
}

/// Parameters that the type does not read are checked all the same.
void Arguments::check_all() {
  for (const auto& [name, b] : bound_) {
    switch (info(name).kind) {
      case ParameterKind::number:
      case ParameterKind::integer:
      case ParameterKind::flag: number(name); break;
      case ParameterKind::choice: text(name); break;
      case ParameterKind::vector: vector(name); break;
      case ParameterKind::colours: colours(name); break;
      case ParameterKind::expression:
      case ParameterKind::colour:
      case ParameterKind::textures:
      case ParameterKind::text: break;
    }
  }
}

void Arguments::use_textures(const std::vector<int>& nodes) {
  scope_.textures = nodes.size();
  for (const int node : nodes)
    scope_.texture_costs.push_back(compiler_.graph().nodes[static_cast<std::size_t>(node)]->evaluations);
}

void Compiler::place_and_limits(Node& node, Arguments& arguments) const {
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
  node.seamless = arguments.handed_down().seamless;
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

Blend blend_named(const std::string& name) {
  return name == "off" ? Blend::off : name == "add" ? Blend::add : name == "sub" ? Blend::subtract : Blend::interpolate;
}

void Compiler::formulas(Node& node, Arguments& arguments) const {
  const auto unless_zero = [&](const char* name) {
    return arguments.given(name) ? arguments.formula(name) : Program{};
  };
  node.a = unless_zero("afunction"), node.b = unless_zero("bfunction");
  node.perturb_x = unless_zero(arguments.given("perturbx") ? "perturbx" : "pertubex");
  node.perturb_y = unless_zero(arguments.given("perturby") ? "perturby" : "pertubey");
  node.main = arguments.formula("mainfunction");
  node.blend.fill(Blend::interpolate);
  node.channel_scale.fill(1);
  for (std::size_t c = 1; c < k_channels; ++c) {
    const auto channel = static_cast<Channel>(c);
    const std::string base = std::string(to_string(channel)), name = base + "function";
    if (!node.multi || arguments.given(name) || channel == Channel::alpha)
      node.channels[c] = channel == Channel::color ? arguments.colour_formula(name) : arguments.formula(name);
    if (channel != Channel::alpha && channel != Channel::coloralpha)
      node.blend[c] = blend_named(arguments.text(base + "blend"));
    if (node.multi && find_parameter(*node.type, base + "scale") && channel != Channel::color)
      node.channel_scale[c] = arguments.number(base + "scale");
  }
}

int Compiler::build(const TypeInfo& type, std::vector<Bound> bound, const Heritage& heritage, const Origin& origin,
                    std::size_t position) {
  Arguments arguments(*this, type, std::move(bound), heritage);
  auto node = std::make_unique<Node>();
  node->type = &type;
  node->multi = type.name == "multi";
  arguments.check_all();
  place_and_limits(*node, arguments);
  node->textures = arguments.textures(arguments.given("texes") ? "texes" : "textures");
  if (node->multi && node->textures.empty()) fail_at(origin, position, "'multi' needs the parameter 'textures'");
  arguments.use_textures(node->textures);
  for (const int child : node->textures) {
    node->ranges.push_back(graph_->nodes[static_cast<std::size_t>(child)]->range);
    node->fades.push_back(graph_->nodes[static_cast<std::size_t>(child)]->fade);
  }
  node->pattern = make_pattern(type.name, arguments);
  formulas(*node, arguments);
  node->uses_normal = arguments.scope().uses_normal;
  node->uses_infos = arguments.scope().uses_infos;
  if (node->uses_normal) graph_->dirt_directions.insert(node->dirt);
  if (type.name == "checker3d") graph_->uses_position = true;
  node->evaluations = (node->seamless && type.seamless == Seamless::four_corner ? 4 : 1) * (1 + arguments.scope().cost);
  if (node->evaluations > k_most_evaluations)
    fail_at(origin, position, "the recipe evaluates more than 100000 textures a point");
  if (graph_->nodes.size() >= k_most_nodes)
    fail_at(origin, position, "the recipe holds more than " + std::to_string(k_most_nodes) + " textures");
  graph_->nodes.push_back(std::move(node));
  return static_cast<int>(graph_->nodes.size()) - 1;
}

}  // namespace

std::vector<double> numbers_of(const TypeArguments& arguments, std::string_view name) {
  const std::string text = arguments.text(name);
  std::vector<double> out;
  const char *at = text.data(), *end = text.data() + text.size();
  while (at != end) {
    if (*at == ' ' || *at == ',' || *at == ';') {
      ++at;
      continue;
    }
    double v = 0;
    const auto [stop, error] = std::from_chars(at, end, v);
    if (error != std::errc() || !std::isfinite(v))
      arguments.refuse(
          name, "expected numbers separated by blanks, found " + in_quotes({at, static_cast<std::size_t>(end - at)}));
    out.push_back(v);
    at = stop;
    if (out.size() > 64) arguments.refuse(name, "expected at most 64 numbers");
  }
  return out;
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
bool ProceduralTexture::depends_on_time() const noexcept { return graph_->uses_time; }
std::vector<std::array<double, 3>> ProceduralTexture::dirt_directions() const {
  return {graph_->dirt_directions.begin(), graph_->dirt_directions.end()};
}
std::vector<std::string> ProceduralTexture::recipes_used() const {
  return {graph_->recipes.begin(), graph_->recipes.end()};
}

}  // namespace papilla
