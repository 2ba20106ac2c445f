// SPDX-License-Identifier: MIT
#include "formula.hpp"

#include <charconv>
#include <cmath>

#include "formula_compiler.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr int k_deepest = 100;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// The grammar of formulas.
class FormulaParser {
 public:
  FormulaParser(Piece text, FormulaScope& scope)
      : text_(text.text),
        start_(text.position),
        origin_(*scope.origin),
        writer_(scope, text.position),
        names_(scope, writer_) {}

  Program parse(bool colour) {
    Value value = sum();
    blanks();
    if (at_ < text_.size()) fail(at_, "expected an operator or the end, found " + in_quotes(text_.substr(at_)));
    if (!colour && value.colour) fail(0, "expected a number, found a colour");
    if (colour && !value.colour) value.colour = true, value.part[1] = value.part[2] = value.part[0];
    return writer_.finish(value, colour);
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& reason) const { fail_at(origin_, start_ + at, reason); }
  Value binary(std::string_view name, const Value& l, const Value& r) {
    return Value::of(writer_.apply(name, {l.part[0], r.part[0]}));
  }

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
    if (minus) return v.part[0].fixed ? Value::of(-v.part[0].number) : Value::of(writer_.apply("negate", {v.part[0]}));
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
    if (exponent.part[0].fixed && exponent.part[0].number == 2)
      return Value::of(writer_.apply("square", {base.part[0]}));
    if (exponent.part[0].fixed && exponent.part[0].number == 3) return Value::of(writer_.apply("cube", {base.part[0]}));
    if (exponent.part[0].fixed && exponent.part[0].number == 0.5)
      return Value::of(writer_.apply("sqrt", {base.part[0]}));
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
    const auto value = names_.texture(recipe, start_ + start);
    if (!value) fail(start, "unknown texture " + in_quotes(recipe.text));
    return *value;
  }
  Value named(std::string_view name, std::size_t start) {
    if (peek() != '(') return names_.resolve_name(name, start_ + start);
    ++at_;
    std::vector<Value> arguments;
    std::vector<std::size_t> places;
    if (peek() != ')') {
      for (;;) {
        blanks();
        places.push_back(start_ + at_);
        arguments.push_back(sum());
        if (peek() != ',') break;
        ++at_;
        if (arguments.size() > 8) break;
      }
    }
    expect(')', "or ',' behind an argument");
    return names_.resolve_call(name, std::move(arguments), places, start_ + start);
  }

  std::string_view text_;
  std::size_t start_, at_ = 0;
  const Origin& origin_;
  BytecodeWriter writer_;
  FormulaNames names_;
  int depth_ = 0;
};

}  // namespace

Program compile_formula(Piece text, bool colour, FormulaScope& scope) {
  return FormulaParser(text, scope).parse(colour);
}

}  // namespace papilla::procedural_detail
