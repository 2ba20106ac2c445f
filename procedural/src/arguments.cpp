// SPDX-License-Identifier: MIT
#include "compiler.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "colours.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"

namespace papilla::procedural_detail {

namespace {

/// Lists of colours that name each other, at most.
constexpr int k_deepest_colours = 16;

std::vector<Rgb> parse_colours(Piece text, const Origin& origin, const RecipeLibrary& library, int depth = 0);

/// The colour of that name, or the library's list; nothing when there is none.
std::optional<std::vector<Rgb>> colours_named(std::string_view name, const RecipeLibrary& library, int depth = 0) {
  if (const auto rgb = named_colour(name)) return std::vector<Rgb>{*rgb};
  const std::string* list = library.find_colours(name);
  if (!list || depth > k_deepest_colours) return std::nullopt;
  return parse_colours({*list, 0}, {"colour '" + std::string(name) + "'", *list}, library, depth + 1);
}

/// Colours by name and as <r,g,b>, separated by commas or blanks; lists of the library by their names.
/// @throws InvalidInput naming the position of what is no colour.
std::vector<Rgb> parse_colours(Piece text, const Origin& origin, const RecipeLibrary& library, int depth) {
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
      const auto list = colours_named(s.substr(start, at - start), library, depth);
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

}  // namespace

Arguments::Arguments(Compiler& compiler, const TypeInfo& type, std::vector<Bound> bound, InheritedSettings inherited)
    : compiler_(compiler), type_(type), inherited_(inherited) {
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
    const auto list = colours_named(name, compiler_.library());
    return list ? std::optional(list->front()) : std::nullopt;
  };
  scope_.known_names = [this] { return compiler_.known_names(); };
  scope_.texture = [this](Piece recipe) { return compiler_.texture(recipe, *scope_.origin, settings_for_inner()); };
  time_ = inherited.time;
  if (number("fixtime") != 0) time_ = number("time");
  scope_.time = time_;
  read_time_modifiers();
  seed_ = inherited.seed + number("seed");
  scope_.seed = seed_;
  scope_.du = number("du"), scope_.dv = number("dv");
  scope_.privatescalex = number("privatescalex"), scope_.privatescaley = number("privatescaley");
}

const Graph& Arguments::graph() const { return compiler_.graph(); }
int Arguments::target_px() const { return compiler_.options().target_px; }
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
  return parse_colours(b.value, *b.origin, compiler_.library());
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

/// A texture that is evaluated once a point.
void Arguments::use(int node) {
  scope_.cost += compiler_.node(node).evaluations;
  scope_.uses_near = scope_.uses_near || compiler_.node(node).uses_near;
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
    const std::optional<int> node = compiler_.texture(piece, *b.origin, settings_for_inner());
    if (!node)
      fail_at(*b.origin, piece.position,
              "unknown texture " + in_quotes(piece.text) + did_you_mean(piece.text, compiler_.known_names()));
    use(*node);
    nodes.push_back(*node);
  }
  return nodes;
}

std::vector<int> Arguments::matching_textures(std::size_t most) {
  const std::string types = "," + text("types") + ",", part = text("idfilter"), content = text("filter");
  const bool by_time = flag("onlytimedependant"), by_normal = flag("onlynormaldependant");
  std::vector<int> nodes;
  for (const auto& [name, recipe] : compiler_.library().recipes()) {
    const std::string_view bottom = bottom_type(name, compiler_.library());
    if (nodes.size() >= most || compiler_.is_open(name) || bottom == "brickfunky" || bottom == "voronoifunky") continue;
    if (types != ",," && types.find("," + std::string(bottom) + ",") == std::string::npos) continue;
    if (name.find(part) == std::string::npos || recipe.find(content) == std::string::npos) continue;
    if (by_time && recipe.find("time") == std::string::npos) continue;
    if (by_normal && recipe.find("normaldot") == std::string::npos) continue;
    const Origin& origin = compiler_.keep({"recipe '" + name + "'", name});
    nodes.push_back(*compiler_.texture({origin.whole, 0}, origin, settings_for_inner()));
    use(nodes.back());
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
  RecipePicture picture;
  try {
    picture = compiler_.options().read_picture(path);
  } catch (const InvalidInput& error) {
    refuse("picpath", error.what());
  } catch (const IoError& error) {
    refuse("picpath", error.what());
  }
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

/// Refuses what would change nothing.
void Arguments::refuse_idle(const ParameterInfo& p) const {
  const auto is_default = [&] {
    if (p.kind == ParameterKind::text) return of(p.name).value.text == p.preset;
    if (p.kind == ParameterKind::flag) return (number(p.name) != 0) == (p.preset == "true");
    double preset = 0;
    std::from_chars(p.preset.data(), p.preset.data() + p.preset.size(), preset);
    return number(p.name) == preset;
  };
  if (!p.refusal.empty() && !is_default()) refuse(p.name, std::string(p.refusal));
  constexpr std::string_view k_of_octaves[] = {"dynamicoctaves", "minimumoctaves", "maximumoctaves"};
  if (std::find(std::begin(k_of_octaves), std::end(k_of_octaves), p.name) != std::end(k_of_octaves) &&
      type_.name != "fbm" && type_.name != "turbulence" && !is_default())
    refuse(p.name, "only fbm and turbulence choose their octaves by the texel, not " + in_quotes(type_.name) +
                       "; write it where those are");
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
    refuse_idle(info(name));
  }
}

void Arguments::use_textures(const std::vector<int>& nodes) {
  scope_.textures = nodes.size();
  for (const int node : nodes) {
    scope_.texture_costs.push_back(compiler_.node(node).evaluations);
    scope_.textures_use_near = scope_.textures_use_near || compiler_.node(node).uses_near;
  }
}

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
