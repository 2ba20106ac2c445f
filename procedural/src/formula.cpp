// SPDX-License-Identifier: MIT
#include "formula.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

namespace papilla::procedural_detail {
namespace {

constexpr int k_deepest = 100;
constexpr std::size_t k_most_instructions = 20000;
constexpr std::size_t k_most_constants = 16384;

/// A number that a formula has at hand: known now, or where it stands.
struct Scalar {
  bool fixed = true;
  double number = 0;
  Operand place;
};

struct Value {
  bool colour = false;
  std::array<Scalar, 3> part{};
  static Value of(double number) {
    Value v;
    v.part[0].number = number;
    return v;
  }
};

Operand frame_operand(FrameRow row, int offset = 0) { return {Operand::Where::frame, static_cast<int>(row) + offset}; }
Operand block_operand(BlockRow row) { return {Operand::Where::block, static_cast<int>(row)}; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

const std::map<std::string_view, Operand>& row_variables() {
  static const std::map<std::string_view, Operand> rows = {
      {"x", frame_operand(FrameRow::u)},
      {"y", frame_operand(FrameRow::v)},
      {"this", frame_operand(FrameRow::self)},
      {"main", frame_operand(FrameRow::main)},
      {"a", frame_operand(FrameRow::a)},
      {"b", frame_operand(FrameRow::b)},
      {"id", frame_operand(FrameRow::id)},
      {"normaldot", frame_operand(FrameRow::normaldot)},
      {"get0", frame_operand(FrameRow::info0)},
      {"get1", frame_operand(FrameRow::info0, 1)},
      {"infox", block_operand(BlockRow::column)},
      {"infoy", block_operand(BlockRow::row)},
      {"infowidth", block_operand(BlockRow::columns)},
      {"infoheight", block_operand(BlockRow::rows)},
      {"infominwh", block_operand(BlockRow::shorter)},
      {"octaveadd", block_operand(BlockRow::octaveadd)},
      {"posx", block_operand(BlockRow::posx)},
      {"posy", block_operand(BlockRow::posy)},
      {"posz", block_operand(BlockRow::posz)},
      {"sky", block_operand(BlockRow::sky)},
      {"lowermain", block_operand(BlockRow::lower_main)},
      {"lowerbump", block_operand(BlockRow::lower_bump)},
      {"lowerreflection", block_operand(BlockRow::lower_reflection)},
      {"lowerdiffuse", block_operand(BlockRow::lower_diffuse)},
      {"lowerspecular", block_operand(BlockRow::lower_specular)},
      {"lowerspecularcoeff", block_operand(BlockRow::lower_specularcoeff)},
      {"lowerfriction", block_operand(BlockRow::lower_friction)},
      {"lowerstiffness", block_operand(BlockRow::lower_stiffness)}};
  return rows;
}

class FormulaCompiler {
 public:
  FormulaCompiler(Piece text, FormulaScope& scope) : text_(text.text), start_(text.position), scope_(scope) {}

  Program compile(bool colour) {
    Value value = sum();
    blanks();
    if (at_ < text_.size()) fail(at_, "expected an operator or the end, found " + in_quotes(text_.substr(at_)));
    if (!colour && value.colour) fail(0, "expected a number, found a colour");
    if (colour && !value.colour) value.colour = true, value.part[1] = value.part[2] = value.part[0];
    program_.present = true;
    program_.colour = colour;
    program_.registers = registers_;
    program_.constant = program_.code.empty();
    for (std::size_t k = 0; k < (colour ? 3U : 1U); ++k) {
      program_.constant = program_.constant && value.part[k].fixed;
      program_.value[k] = std::isfinite(value.part[k].number) ? value.part[k].number : 0;
      program_.result[k] = place_of(value.part[k]);
    }
    return std::move(program_);
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& reason) const {
    fail_at(*scope_.origin, start_ + at, reason);
  }

  // --- registers and instructions ---

  int new_registers(int count) {
    if (count == 1 && !free_.empty()) {
      const int reg = free_.back();
      free_.pop_back();
      return reg;
    }
    registers_ += count;
    return registers_ - count;
  }
  void release(const Scalar& s) {
    if (!s.fixed && s.place.where == Operand::Where::reg) free_.push_back(s.place.index);
  }
  Operand place_of(const Scalar& s) {
    if (!s.fixed) return s.place;
    auto& pool = scope_.graph->constants;
    auto it = std::find(pool.begin(), pool.end(), s.number);
    if (it == pool.end()) {
      if (pool.size() >= k_most_constants)
        fail(at_, "the recipe has more than " + std::to_string(k_most_constants) + " different constants");
      it = pool.insert(pool.end(), std::isfinite(s.number) ? s.number : 0);
    }
    return {Operand::Where::constant, static_cast<int>(it - pool.begin())};
  }
  Instruction& add(Action action, const std::vector<Scalar>& in, int outs) {
    if (program_.code.size() >= k_most_instructions)
      fail(at_, "the formula has more than " + std::to_string(k_most_instructions) + " steps");
    Instruction code;
    code.action = action;
    code.arguments = static_cast<int>(in.size());
    for (std::size_t k = 0; k < in.size(); ++k) code.in[k] = place_of(in[k]);
    code.out = new_registers(outs);
    program_.code.push_back(code);
    return program_.code.back();
  }
  static Scalar in_register(int reg) { return {false, 0, {Operand::Where::reg, reg}}; }

  Scalar apply(std::string_view name, const std::vector<Scalar>& in, bool keep = false) {
    const KernelInfo* info = find_kernel(name);
    std::vector<Scalar> all = in;
    if (info->extra == "uv") {
      all.push_back({false, 0, frame_operand(FrameRow::u)});
      all.push_back({false, 0, frame_operand(FrameRow::v)});
    }
    if (std::all_of(all.begin(), all.end(), [](const Scalar& s) { return s.fixed; }))
      return {true, folded(*info, all), {}};
    Instruction& code = add(Action::kernel, all, 1);
    code.kernel = info->kernel;
    const int out = code.out;
    if (!keep)
      for (const Scalar& s : in) release(s);
    return in_register(out);
  }
  static double folded(const KernelInfo& info, const std::vector<Scalar>& in) {
    std::array<const double*, k_most_arguments> rows{};
    for (std::size_t k = 0; k < in.size(); ++k) rows[k] = &in[k].number;
    double out = 0;
    info.kernel(&out, rows.data(), 1);
    return std::isfinite(out) ? out : 0;
  }
  Value scalar(const Scalar& s) {
    Value v;
    v.part[0] = s;
    return v;
  }
  Value binary(const char* name, const Value& l, const Value& r) { return scalar(apply(name, {l.part[0], r.part[0]})); }

  // --- grammar ---

  void blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
  }
  char peek() {
    blanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  void expect(char c, const char* where) {
    if (peek() != c) fail(at_, std::string("expected '") + c + "' " + where + found());
    ++at_;
  }
  std::string found() { return at_ < text_.size() ? ", found " + in_quotes(text_.substr(at_, 12)) : ", found the end"; }
  Value number_only(const Value& v, std::size_t at) {
    if (v.colour) fail(at, "expected a number, found a colour");
    return v;
  }

  Value sum() {
    if (++depth_ > k_deepest) fail(at_, "more than " + std::to_string(k_deepest) + " levels of brackets");
    const std::size_t first = at_;
    Value left = product();
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      number_only(left, first);
      ++at_;
      const std::size_t second = at_;
      left = binary(c == '+' ? "+" : "-", left, number_only(product(), second));
    }
    --depth_;
    return left;
  }
  Value product() {
    const std::size_t first = at_;
    Value left = signed_value();
    for (char c = peek(); c == '*' || c == '/' || c == '%'; c = peek()) {
      number_only(left, first);
      ++at_;
      const std::size_t second = at_;
      const char name[2] = {c, '\0'};
      left = binary(name, left, number_only(signed_value(), second));
    }
    return left;
  }
  Value signed_value() {
    int minus = 0, steps = 0;
    for (char c = peek(); c == '-' || c == '+'; c = peek()) {
      minus ^= c == '-' ? 1 : 0;
      ++at_;
      if (++steps > k_deepest) fail(at_, "too many signs");
    }
    const std::size_t first = at_;
    Value v = power();
    if (steps > 0) number_only(v, first);
    if (minus) return v.part[0].fixed ? Value::of(-v.part[0].number) : scalar(apply("negate", {v.part[0]}));
    return v;
  }
  Value power() {
    const std::size_t first = at_;
    Value base = atom();
    if (peek() != '^') return base;
    number_only(base, first);
    ++at_;
    if (++depth_ > k_deepest) fail(at_, "more than " + std::to_string(k_deepest) + " levels of powers");
    const std::size_t second = at_;
    const Value exponent = number_only(signed_value(), second);
    --depth_;
    if (exponent.part[0].fixed && exponent.part[0].number == 1) return base;
    if (exponent.part[0].fixed && exponent.part[0].number == 2) return scalar(apply("square", {base.part[0]}));
    if (exponent.part[0].fixed && exponent.part[0].number == 3) return scalar(apply("cube", {base.part[0]}));
    if (exponent.part[0].fixed && exponent.part[0].number == 0.5) return scalar(apply("sqrt", {base.part[0]}));
    return binary("^", base, exponent);
  }

  Value atom() {
    const char c = peek();
    const std::size_t start = at_;
    if (is_digit(c) || c == '.') return literal();
    if (c == '(') {
      ++at_;
      const Value v = sum();
      expect(')', "to close the bracket");
      return v;
    }
    if (c == '<') return colour_literal();
    if (c == '[') return inline_texture();
    if (is_letter(c)) {
      while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
      return named(text_.substr(start, at_ - start), start);
    }
    fail(start, "expected a number, a name, '(', '[' or '<'" + found());
  }
  Value literal() {
    double v = 0;
    const char* end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data() + at_, end, v);
    if (error != std::errc() || !std::isfinite(v)) fail(at_, "expected a number" + found());
    at_ = static_cast<std::size_t>(stop - text_.data());
    return Value::of(v);
  }
  Value colour_literal() {
    ++at_;
    Value v;
    v.colour = true;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0) expect(',', "between the parts of a colour");
      const std::size_t start = at_;
      v.part[k] = number_only(sum(), start).part[0];
    }
    expect('>', "to close the colour");
    return v;
  }
  Value inline_texture() {
    const std::size_t start = at_;
    int open = 0;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '[') ++open;
      if (text_[at_] == ']' && --open == 0) break;
    }
    if (at_ == text_.size()) fail(start, "expected ']' to close the texture");
    const Piece recipe = trimmed({text_.substr(start + 1, at_ - start - 1), start_ + start + 1});
    ++at_;
    const auto value = texture_value(recipe, start);
    if (!value) fail(start, "unknown texture " + in_quotes(recipe.text));
    return *value;
  }
  std::optional<Value> texture_value(Piece recipe, std::size_t start) {
    if (!scope_.point) fail(start, "no texture may be named here, only numbers, functions and time");
    const std::optional<int> node = scope_.texture(recipe);
    if (!node) return std::nullopt;
    scope_.cost += scope_.graph->nodes[static_cast<std::size_t>(*node)]->evaluations;
    Instruction& code = add(Action::texture, {}, 1);
    code.index = *node;
    return scalar(in_register(code.out));
  }

  // --- names ---

  Value named(std::string_view name, std::size_t start) {
    const FunctionInfo* function = find_function(name);
    const bool call = peek() == '(';
    if (function && (call || function->arity == 0))
      return call || function->arity > 0 ? called(*function, start) : variable(name, start);
    if (call) fail(start, "unknown function " + in_quotes(name) + suggestion(name));
    if (scope_.point)
      if (auto value = texture_value({name, start_ + start}, start)) return *value;
    if (const auto colour = scope_.colour(name)) {
      Value v;
      v.colour = true;
      for (std::size_t k = 0; k < 3; ++k) v.part[k].number = (*colour)[k];
      return v;
    }
    if (function)
      fail(start, in_quotes(name) + " expects " + std::to_string(function->arity) + " arguments in brackets");
    fail(start, "unknown name " + in_quotes(name) + suggestion(name));
  }
  std::string suggestion(std::string_view name) const {
    std::vector<std::string_view> known = scope_.known_names();
    for (const FunctionInfo& f : expression_functions()) known.push_back(f.name);
    return did_you_mean(name, known);
  }

  Value called(const FunctionInfo& function, std::size_t start) {
    ++at_;
    std::vector<Value> arguments;
    std::vector<std::size_t> places;
    if (peek() != ')') {
      for (;;) {
        blanks();
        places.push_back(at_);
        arguments.push_back(sum());
        if (peek() != ',') break;
        ++at_;
        if (arguments.size() > 8) break;
      }
    }
    expect(')', "or ',' behind an argument");
    if (static_cast<int>(arguments.size()) != function.arity)
      fail(start, in_quotes(function.name) + " expects " + std::to_string(function.arity) + " arguments, found " +
                      std::to_string(arguments.size()));
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      const bool wants_colour = function.arguments[k] == 'c';
      if (wants_colour && !arguments[k].colour)
        arguments[k].colour = true, arguments[k].part[1] = arguments[k].part[2] = arguments[k].part[0];
      else if (!wants_colour)
        number_only(arguments[k], places[k]);
    }
    if (function.arity == 0) return variable(function.name, start);
    return function_value(function.name, arguments, start);
  }

  Value variable(std::string_view name, std::size_t start) {
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
    for (int k = 0; k < 4; ++k) {
      if (name != "f1" && name != "f2" && name != "f3" && name != "f4") break;
      if (!scope_.distances) fail(start, in_quotes(name) + " is known within func only");
      if (name[1] == '1' + k) return scalar({false, 0, frame_operand(FrameRow::f1, k)});
    }
    if (name == "orig" || name == "index") {
      if (!scope_.density) fail(start, in_quotes(name) + " is known within densityfunc only");
      return scalar({false, 0, frame_operand(FrameRow::f1, name == "orig" ? 0 : 1)});
    }
    if (!scope_.point) fail(start, in_quotes(name) + " depends on the place and is not known here");
    if (name == "normaldot") scope_.uses_normal = scope_.graph->uses_normal = true;
    if (name == "posx" || name == "posy" || name == "posz") scope_.graph->uses_position = true;
    if (name == "sky") scope_.graph->uses_sky = true;
    if (name == "get0" || name == "get1") scope_.uses_infos = true;
    if (const auto it = row_variables().find(name); it != row_variables().end()) return scalar({false, 0, it->second});
    if (name == "random")
      return scalar(apply("random", {{false, 0, block_operand(BlockRow::column)},
                                     {false, 0, block_operand(BlockRow::row)},
                                     {true, scope_.seed, {}}}));
    if (name == "currentcolor") return current_colour();
    if (name == "hue") return function_value("gethsvhue", {current_colour()}, start);
    if (name == "saturation") return function_value("gethsvsaturation", {current_colour()}, start);
    if (name == "value") return function_value("gethsvvalue", {current_colour()}, start);
    return texmapped(name, start);  // What is left are texmapped….
  }
  static Value current_colour() {
    Value v;
    v.colour = true;
    for (std::size_t k = 0; k < 3; ++k)
      v.part[k] = {false, 0, {Operand::Where::block, static_cast<int>(BlockRow::lower_red) + static_cast<int>(k)}};
    return v;
  }

  void need_textures(std::string_view name, std::size_t start) {
    if (scope_.textures == 0) fail(start, in_quotes(name) + " needs the parameter 'textures'");
    for (const double cost : scope_.texture_costs) scope_.cost += cost;
  }
  Value texmapped(std::string_view name, std::size_t start) {
    need_textures(name, start);
    const std::string_view channel = name.substr(std::string_view("texmapped").size());
    const Scalar main{false, 0, frame_operand(FrameRow::main)};
    if (channel == "color") return colour_action(Action::texmap_color, {main}, 0);
    Instruction& code = add(Action::texmap_channel, {main}, 1);
    code.index = static_cast<int>(channel_named(channel));
    return scalar(in_register(code.out));
  }
  Value colour_action(Action action, const std::vector<Scalar>& in, int index) {
    Instruction& code = add(action, in, 3);
    code.index = index;
    Value v;
    v.colour = true;
    for (int k = 0; k < 3; ++k) v.part[static_cast<std::size_t>(k)] = in_register(code.out + k);
    return v;
  }
  int fixed_integer(const Value& v, int most, std::string_view what, std::size_t start) {
    if (!v.part[0].fixed || v.part[0].number < 0 || v.part[0].number > most)
      fail(start, std::string(what) + " must be a constant from 0 to " + std::to_string(most));
    return static_cast<int>(v.part[0].number);
  }

  Value function_value(std::string_view name, const std::vector<Value>& in, std::size_t start) {
    const auto part = [&](std::size_t i, std::size_t k = 0) { return in[i].part[k]; };
    if (name == "rgb") {
      Value v;
      v.colour = true;
      for (std::size_t k = 0; k < 3; ++k) v.part[k] = part(k);
      return v;
    }
    if (name == "hsv") {
      Value v;
      v.colour = true;
      const char* kernels[3] = {"hsv_red", "hsv_green", "hsv_blue"};
      for (std::size_t k = 0; k < 3; ++k) v.part[k] = apply(kernels[k], {part(0), part(1), part(2)}, true);
      return v;
    }
    if (name == "colmix" || name == "colscale" || name == "colgamma") {
      Value v;
      v.colour = true;
      for (std::size_t k = 0; k < 3; ++k) {
        if (name == "colmix")
          v.part[k] = apply("interpolate", {part(0, k), part(1, k), part(2)}, true);
        else if (name == "colscale")
          v.part[k] = apply("*", {part(0, k), part(1)}, true);
        else
          v.part[k] = apply("^", {part(0, k), apply("/", {{true, 1, {}}, part(1)}, true)}, true);
      }
      return v;
    }
    if (name == "getred" || name == "getgreen" || name == "getblue")
      return scalar(part(0, name == "getred" ? 0 : name == "getgreen" ? 1 : 2));
    if (name == "gethsvhue" || name == "gethsvsaturation" || name == "gethsvvalue")
      return scalar(apply(name, {part(0, 0), part(0, 1), part(0, 2)}));
    if (!scope_.point && (name == "get" || name == "set" || name == "colmap" || name == "zoom" || name == "rotate" ||
                          name == "sphere" || name == "texmap" || name == "texmap2" || name == "coldist" ||
                          name == "huedist" || name == "region" || find_kernel_with_place(name)))
      fail(start, in_quotes(name) + " depends on the place and is not known here");
    const Value current = current_colour();
    if (name == "coldist")
      return scalar(
          apply("coldist", {part(0, 0), part(0, 1), part(0, 2), current.part[0], current.part[1], current.part[2]}));
    if (name == "huedist")
      return scalar(apply("huedist", {function_value("gethsvhue", {current}, start).part[0], part(0)}));
    if (name == "get") {
      scope_.uses_infos = true;
      return scalar(
          {false, 0,
           frame_operand(FrameRow::info0, fixed_integer(in[0], k_infos - 1, "the number of an information", start))});
    }
    if (name == "set") {
      Instruction& code = add(Action::set_info, {part(1)}, 1);
      code.index = fixed_integer(in[0], k_infos - 1, "the number of an information", start);
      return scalar(in_register(code.out));
    }
    if (name == "zoom" || name == "rotate" || name == "sphere") {
      std::vector<Scalar> all;
      for (std::size_t k = 0; k < in.size(); ++k) all.push_back(part(k));
      const Instruction& code = add(name == "zoom"     ? Action::zoom
                                    : name == "rotate" ? Action::rotate
                                                       : Action::sphere,
                                    all, 1);
      return scalar(in_register(code.out));
    }
    if (name == "preparemapping") return Value::of(0);
    if (name == "colmap") return colour_action(Action::colmap, {part(0)}, 0);
    if (name == "texmap") {
      need_textures(name, start);
      return colour_action(Action::texmap_color, {part(0)}, 0);
    }
    if (name == "texmap2") return texmap2(in, start);
    std::vector<Scalar> all;
    for (std::size_t k = 0; k < in.size(); ++k) all.push_back(part(k));
    return scalar(apply(name, all));
  }
  static bool find_kernel_with_place(std::string_view name) {
    const KernelInfo* info = find_kernel(name);
    return info && !info->extra.empty();
  }
  Value texmap2(const std::vector<Value>& in, std::size_t start) {
    need_textures("texmap2", start);
    const int texture = fixed_integer(in[1], static_cast<int>(scope_.textures) - 1, "the index of a texture", start);
    const int mode = fixed_integer(in[2], 2, "the mode", start);
    const Value first = colour_action(Action::texture_color, {}, texture);
    const Value second = mode == 0   ? colour_action(Action::colmap, {in[3].part[0]}, 0)
                         : mode == 1 ? colour_action(Action::texmap_color, {in[3].part[0]}, 0)
                                     : current_colour();
    Value v;
    v.colour = true;
    for (std::size_t k = 0; k < 3; ++k)
      v.part[k] = apply("interpolate", {first.part[k], second.part[k], in[0].part[0]}, true);
    return v;
  }

  std::string_view text_;
  std::size_t start_, at_ = 0;
  FormulaScope& scope_;
  Program program_;
  int registers_ = 0, depth_ = 0;
  std::vector<int> free_;
};

}  // namespace

Program compile_formula(Piece text, bool colour, FormulaScope& scope) {
  return FormulaCompiler(text, scope).compile(colour);
}

}  // namespace papilla::procedural_detail
