// SPDX-License-Identifier: MIT
#include "formula_compiler.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "papilla/core/near_name.hpp"

namespace papilla::procedural_detail {
namespace {

/// The row of a variable, and the first stage that can use it.
struct RowVariable {
  Operand place;
  FormulaStage from = FormulaStage::first;
};

RowVariable frame_row(FrameRow row, FormulaStage from = FormulaStage::first, int offset = 0) {
  return {{Operand::Where::frame, static_cast<int>(row) + offset}, from};
}
RowVariable block_row(BlockRow row) { return {{Operand::Where::block, static_cast<int>(row)}}; }

const std::map<std::string_view, RowVariable>& row_variables() {
  using enum FormulaStage;
  static const std::map<std::string_view, RowVariable> rows = {
      {"x", frame_row(FrameRow::u)},
      {"y", frame_row(FrameRow::v)},
      {"this", frame_row(FrameRow::self, main)},
      {"main", frame_row(FrameRow::main, main)},
      {"a", frame_row(FrameRow::a, second)},
      {"b", frame_row(FrameRow::b, place)},
      {"id", frame_row(FrameRow::id, main)},
      {"normaldot", frame_row(FrameRow::normaldot)},
      {"get0", frame_row(FrameRow::info0)},
      {"get1", frame_row(FrameRow::info0, first, 1)},
      {"infox", block_row(BlockRow::column)},
      {"infoy", block_row(BlockRow::row)},
      {"infowidth", block_row(BlockRow::columns)},
      {"infoheight", block_row(BlockRow::rows)},
      {"infominwh", block_row(BlockRow::shorter)},
      {"octaveadd", block_row(BlockRow::octaveadd)},
      {"posx", block_row(BlockRow::posx)},
      {"posy", block_row(BlockRow::posy)},
      {"posz", block_row(BlockRow::posz)},
      {"sky", block_row(BlockRow::sky)},
      {"flow", block_row(BlockRow::flow)},
      {"lowermain", block_row(BlockRow::lower_main)},
      {"lowerbump", block_row(BlockRow::lower_bump)},
      {"loweralpha", block_row(BlockRow::lower_alpha)},
      {"lowercoloralpha", block_row(BlockRow::lower_coloralpha)},
      {"lowerreflection", block_row(BlockRow::lower_reflection)},
      {"lowerdiffuse", block_row(BlockRow::lower_diffuse)},
      {"lowerspecular", block_row(BlockRow::lower_specular)},
      {"lowerspecularcoeff", block_row(BlockRow::lower_specularcoeff)},
      {"lowerfriction", block_row(BlockRow::lower_friction)},
      {"lowerstiffness", block_row(BlockRow::lower_stiffness)},
      {"lowerdamping", block_row(BlockRow::lower_damping)},
      {"lowerroughness", block_row(BlockRow::lower_roughness)}};
  return rows;
}

const std::map<std::string_view, NearStatistic>& near_functions() {
  static const std::map<std::string_view, NearStatistic> functions = {{"nearmean", NearStatistic::mean},
                                                                      {"nearmin", NearStatistic::least},
                                                                      {"nearmax", NearStatistic::most},
                                                                      {"neardeviation", NearStatistic::deviation},
                                                                      {"nearslope", NearStatistic::slope}};
  return functions;
}

bool needs_a_place(std::string_view name) {
  constexpr std::string_view names[] = {"get",    "set",    "colmap",  "zoom",    "rotate",
                                        "sphere", "texmap", "texmap2", "coldist", "huedist"};
  if (std::find(std::begin(names), std::end(names), name) != std::end(names) || near_functions().contains(name))
    return true;
  const KernelInfo* kernel = find_kernel(name);
  return kernel && !kernel->extra.empty();
}

std::vector<Scalar> numbers(const std::vector<Value>& in) {
  std::vector<Scalar> out;
  for (const Value& v : in) out.push_back(v.part[0]);
  return out;
}

}  // namespace

void FormulaNames::fail(std::size_t position, const std::string& reason) const {
  fail_at(*scope_.origin, position, reason);
}

std::string FormulaNames::suggestion(std::string_view name) const {
  std::vector<std::string_view> known = scope_.known_names();
  for (const FunctionInfo& f : expression_functions()) known.push_back(f.name);
  return did_you_mean(name, known);
}

std::optional<Value> FormulaNames::texture(Piece recipe, std::size_t position) {
  if (!scope_.point) fail(position, "no texture may be named here, only numbers, functions and time");
  const std::optional<int> node = scope_.texture(recipe);
  if (!node) return std::nullopt;
  const Node& within = *scope_.graph->nodes[static_cast<std::size_t>(*node)];
  scope_.cost += within.evaluations;
  scope_.uses_near = scope_.uses_near || within.uses_near;
  Scalar value = writer_.emit(Action::texture, {}, *node);
  value.level = scope_.graph->deepest_near();
  return Value::of(value);
}

Value FormulaNames::resolve_name(std::string_view name, std::size_t position) {
  const FunctionInfo* function = find_function(name);
  if (function && function->arity == 0) return variable(name, position);
  if (scope_.point)
    if (auto value = texture({name, position}, position)) return *value;
  if (const auto colour = scope_.colour(name)) {
    Value v;
    v.colour = true;
    for (std::size_t k = 0; k < 3; ++k) v.part[k].number = (*colour)[k];
    return v;
  }
  if (function)
    fail(position, in_quotes(name) + " expects " + std::to_string(function->arity) + " arguments in brackets");
  fail(position, "unknown name " + in_quotes(name) + suggestion(name));
}

Value FormulaNames::resolve_call(std::string_view name, std::vector<Value> arguments,
                                 const std::vector<std::size_t>& places, std::size_t position) {
  const FunctionInfo* info = find_function(name);
  if (!info) fail(position, "unknown function " + in_quotes(name) + suggestion(name));
  if (static_cast<int>(arguments.size()) != info->arity)
    fail(position, in_quotes(name) + " expects " + std::to_string(info->arity) + " arguments, found " +
                       std::to_string(arguments.size()));
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const bool wants_colour = info->arguments[k] == 'c';
    if (wants_colour && !arguments[k].colour)
      arguments[k].colour = true, arguments[k].part[1] = arguments[k].part[2] = arguments[k].part[0];
    else if (!wants_colour && arguments[k].colour)
      fail(places[k], "expected a number, found a colour");
  }
  return info->arity == 0 ? variable(name, position) : function(name, arguments, position);
}

// --- variables ---

Value FormulaNames::variable(std::string_view name, std::size_t position) {
  if (const auto value = constant_variable(name)) return *value;
  constexpr std::string_view distances[] = {"f1", "f2", "f3", "f4", "orig", "index"};
  if (std::find(std::begin(distances), std::end(distances), name) != std::end(distances))
    return distance_variable(name, position);
  if (!scope_.point) fail(position, in_quotes(name) + " depends on the place and is not known here");
  return point_variable(name, position);
}

/// Variables that are one number for the whole texture.
std::optional<Value> FormulaNames::constant_variable(std::string_view name) const {
  if (name == "pi") return Value::of(std::numbers::pi);
  if (name == "time" || name == "globaltime") {
    scope_.graph->uses_time = true;
    return Value::of(name == "time" ? scope_.time : scope_.globaltime);
  }
  if (name == "realtime") return Value::of(scope_.realtime);
  if (name == "seed") return Value::of(scope_.seed);
  if (name == "du") return Value::of(scope_.du);
  if (name == "dv") return Value::of(scope_.dv);
  if (name == "privatescalex") return Value::of(scope_.privatescalex);
  if (name == "privatescaley") return Value::of(scope_.privatescaley);
  return std::nullopt;
}

Value FormulaNames::distance_variable(std::string_view name, std::size_t position) const {
  const bool density = name == "orig" || name == "index";
  if (density && !scope_.density) fail(position, in_quotes(name) + " is known within densityfunc only");
  if (!density && !scope_.distances) fail(position, in_quotes(name) + " is known within func only");
  const int number = density ? (name == "orig" ? 0 : 1) : name[1] - '1';
  return Value::of(Scalar{false, 0, frame_row(FrameRow::f1, FormulaStage::first, number).place, 0});
}

void FormulaNames::refuse_early(std::string_view name, std::size_t position) const {
  fail(position, in_quotes(name) +
                     " is not known yet: afunction comes first, then bfunction, perturbx and perturby, the type and "
                     "mainfunction, and last the channels");
}

Value FormulaNames::point_variable(std::string_view name, std::size_t position) {
  if (name == "normaldot") scope_.uses_normal = scope_.graph->uses_normal = true;
  if (name == "posx" || name == "posy" || name == "posz") scope_.graph->uses_position = true;
  if (name == "sky") scope_.graph->uses_sky = true;
  if (name == "flow") scope_.graph->uses_flow = true;
  if (name == "get0" || name == "get1") scope_.uses_infos = true;
  if (const auto it = row_variables().find(name); it != row_variables().end()) {
    if (scope_.stage < it->second.from) refuse_early(name, position);
    const int level = name == "x" || name == "y"  ? 0
                      : name.starts_with("lower") ? scope_.lower_level
                                                  : scope_.graph->deepest_near();
    return Value::of(Scalar{false, 0, it->second.place, level});
  }
  if (name == "random")
    return Value::of(writer_.apply("random", {{false, 0, block_row(BlockRow::column).place, 0},
                                              {false, 0, block_row(BlockRow::row).place, 0},
                                              {true, scope_.seed, {}, 0}}));
  if (name == "currentcolor") return current_colour();
  if (name == "hue") return function("gethsvhue", {current_colour()}, position);
  if (name == "saturation") return function("gethsvsaturation", {current_colour()}, position);
  if (name == "value") return function("gethsvvalue", {current_colour()}, position);
  return texmapped(name, position);  // The remaining names begin with texmapped.
}

Value FormulaNames::current_colour() const {
  Value v;
  v.colour = true;
  for (std::size_t k = 0; k < 3; ++k)
    v.part[k] = {false,
                 0,
                 {Operand::Where::block, static_cast<int>(BlockRow::lower_red) + static_cast<int>(k)},
                 scope_.lower_level};
  return v;
}

void FormulaNames::require_textures(std::string_view name, std::size_t position) {
  if (scope_.textures == 0) fail(position, in_quotes(name) + " needs the parameter 'textures'");
  for (const double cost : scope_.texture_costs) scope_.cost += cost;
  scope_.uses_near = scope_.uses_near || scope_.textures_use_near;
}

Value FormulaNames::texmapped(std::string_view name, std::size_t position) {
  require_textures(name, position);
  if (scope_.stage < FormulaStage::main) refuse_early(name, position);
  const std::string_view channel = name.substr(std::string_view("texmapped").size());
  const Scalar main{false, 0, frame_row(FrameRow::main).place, scope_.graph->deepest_near()};
  if (channel == "color") return writer_.emit_colour(Action::texmap_color, {main}, 0);
  return Value::of(writer_.emit(Action::texmap_channel, {main}, static_cast<int>(channel_named(channel))));
}

// --- functions ---

int FormulaNames::fixed_integer(const Value& v, int most, std::string_view what, std::size_t position) const {
  if (!v.part[0].fixed || v.part[0].number < 0 || v.part[0].number > most)
    fail(position, std::string(what) + " must be a constant from 0 to " + std::to_string(most));
  return static_cast<int>(v.part[0].number);
}

Value FormulaNames::function(std::string_view name, const std::vector<Value>& in, std::size_t position) {
  if (!scope_.point && needs_a_place(name))
    fail(position, in_quotes(name) + " depends on the place and is not known here");
  if (const auto value = colour_function(name, in)) return *value;
  if (const auto value = info_function(name, in, position)) return *value;
  if (const auto value = place_function(name, in)) return *value;
  if (const auto value = neighbourhood(name, in, position)) return *value;
  if (const auto value = colour_map(name, in, position)) return *value;
  if (name == "preparemapping") return Value::of(0);
  return Value::of(writer_.apply(name, numbers(in)));
}

/// Functions that take colours apart, put them together or compare them.
std::optional<Value> FormulaNames::colour_function(std::string_view name, const std::vector<Value>& in) {
  Value v;
  v.colour = true;
  if (name == "rgb") {
    for (std::size_t k = 0; k < 3; ++k) v.part[k] = in[k].part[0];
    return v;
  }
  if (name == "hsv") {
    constexpr std::string_view kernels[3] = {"hsv_red", "hsv_green", "hsv_blue"};
    for (std::size_t k = 0; k < 3; ++k) v.part[k] = writer_.apply(kernels[k], numbers(in), true);
    return v;
  }
  if (name == "colmix" || name == "colscale" || name == "colgamma") {
    for (std::size_t k = 0; k < 3; ++k) {
      if (name == "colmix")
        v.part[k] = writer_.apply("interpolate", {in[0].part[k], in[1].part[k], in[2].part[0]}, true);
      else if (name == "colscale")
        v.part[k] = writer_.apply("*", {in[0].part[k], in[1].part[0]}, true);
      else
        v.part[k] =
            writer_.apply("^", {in[0].part[k], writer_.apply("/", {{true, 1, {}, 0}, in[1].part[0]}, true)}, true);
    }
    return v;
  }
  if (name == "getred") return Value::of(in[0].part[0]);
  if (name == "getgreen") return Value::of(in[0].part[1]);
  if (name == "getblue") return Value::of(in[0].part[2]);
  if (name == "gethsvhue" || name == "gethsvsaturation" || name == "gethsvvalue")
    return Value::of(writer_.apply(name, {in[0].part[0], in[0].part[1], in[0].part[2]}));
  if (name == "coldist") {
    const Value current = current_colour();
    return Value::of(writer_.apply(
        "coldist", {in[0].part[0], in[0].part[1], in[0].part[2], current.part[0], current.part[1], current.part[2]}));
  }
  if (name == "huedist") {
    const Value current = current_colour();
    const Scalar hue = writer_.apply("gethsvhue", {current.part[0], current.part[1], current.part[2]});
    return Value::of(writer_.apply("huedist", {hue, in[0].part[0]}));
  }
  return std::nullopt;
}

std::optional<Value> FormulaNames::info_function(std::string_view name, const std::vector<Value>& in,
                                                 std::size_t position) {
  if (name != "get" && name != "set") return std::nullopt;
  const int number = fixed_integer(in[0], k_infos - 1, "the number of an information", position);
  if (name == "set") return Value::of(writer_.emit(Action::set_info, {in[1].part[0]}, number));
  scope_.uses_infos = true;
  return Value::of(
      Scalar{false, 0, frame_row(FrameRow::info0, FormulaStage::first, number).place, scope_.graph->deepest_near()});
}

std::optional<Value> FormulaNames::place_function(std::string_view name, const std::vector<Value>& in) {
  if (name == "zoom") return Value::of(writer_.emit(Action::zoom, numbers(in), 0));
  if (name == "rotate") return Value::of(writer_.emit(Action::rotate, numbers(in), 0));
  if (name == "sphere") return Value::of(writer_.emit(Action::sphere, numbers(in), 0));
  return std::nullopt;
}

/// Statistics of the first argument within a radius.
std::optional<Value> FormulaNames::neighbourhood(std::string_view name, const std::vector<Value>& in,
                                                 std::size_t position) {
  const auto it = near_functions().find(name);
  if (it == near_functions().end()) return std::nullopt;
  const Scalar &value = in[0].part[0], &radius = in[1].part[0];
  if (!radius.fixed || !(radius.number > 0 && radius.number <= k_most_radius))
    fail(position, "the radius of " + in_quotes(name) + " must be a constant above 0, at most 1000");
  auto& requests = scope_.graph->near;
  if (requests.size() >= k_most_near || value.level >= k_deepest_near)
    fail(position, "more than " + std::to_string(k_most_near) + " neighbourhood statistics, or more than " +
                       std::to_string(k_deepest_near) + " that rest on each other");
  scope_.uses_near = true;
  Scalar out = writer_.emit(Action::neighbourhood, {value}, static_cast<int>(requests.size()));
  out.level = value.level + 1;
  requests.push_back({it->second, radius.number, out.level});
  return Value::of(out);
}

std::optional<Value> FormulaNames::colour_map(std::string_view name, const std::vector<Value>& in,
                                              std::size_t position) {
  if (name == "colmap") return writer_.emit_colour(Action::colmap, {in[0].part[0]}, 0);
  if (name == "texmap") {
    require_textures(name, position);
    return writer_.emit_colour(Action::texmap_color, {in[0].part[0]}, 0);
  }
  if (name == "texmap2") return texmap2(in, position);
  return std::nullopt;
}

Value FormulaNames::texmap2(const std::vector<Value>& in, std::size_t position) {
  require_textures("texmap2", position);
  const int texture = fixed_integer(in[1], static_cast<int>(scope_.textures) - 1, "the index of a texture", position);
  const int mode = fixed_integer(in[2], 2, "the mode", position);
  const Value first = writer_.emit_colour(Action::texture_color, {}, texture);
  const Value second = mode == 0   ? writer_.emit_colour(Action::colmap, {in[3].part[0]}, 0)
                       : mode == 1 ? writer_.emit_colour(Action::texmap_color, {in[3].part[0]}, 0)
                                   : current_colour();
  Value v;
  v.colour = true;
  for (std::size_t k = 0; k < 3; ++k)
    v.part[k] = writer_.apply("interpolate", {first.part[k], second.part[k], in[0].part[0]}, true);
  return v;
}

}  // namespace papilla::procedural_detail
