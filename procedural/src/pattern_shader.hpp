// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "noise.hpp"
#include "program.hpp"

namespace papilla::procedural_detail {

class ShaderWriter;

/// A value as a shader writes it.
struct ShaderValue {
  std::string text;
  ShaderValue(double number);          // NOLINT(google-explicit-constructor)
  ShaderValue(int number);             // NOLINT(google-explicit-constructor)
  ShaderValue(std::uint32_t bits);     // NOLINT(google-explicit-constructor)
  ShaderValue(bool flag);              // NOLINT(google-explicit-constructor)
  ShaderValue(std::string expression)  // NOLINT(google-explicit-constructor)
      : text(std::move(expression)) {}
  ShaderValue(const char* expression) : text(expression) {}  // NOLINT(google-explicit-constructor)
};
using ShaderValues = std::vector<std::pair<std::string_view, ShaderValue>>;

/// What a pattern writes into a shader: the statements that compute it at one point.
///
/// Statements are GLSL ES 3.00 in the part of the language that becomes WGSL word by word: one declaration a line, no
/// `?:` but pick(condition, then, else), no assignment to parameters, numbers with a point, shifts in brackets. `$name`
/// stands for one of the values; $x, $y are the place, $out the result, $id the number of the cell, $t begins names
/// that belong to this texture alone.
class PatternShader {
 public:
  double texel = 0, period_x = 0, period_y = 0;  ///< As of PatternRow.

  PatternShader(ShaderWriter& writer, int texture, int instance)
      : writer_(writer), texture_(texture), instance_(instance) {}
  void add(std::string_view statements, const ShaderValues& values = {});
  /// Outside of functions, before the statements.
  void add_function(std::string_view text, const ShaderValues& values = {});
  /// A constant array NAME; `type` is float or uint.
  void add_array(std::string_view name, std::string_view type, const std::vector<ShaderValue>& values);
  /// Sets information `number`, which nothing reads when !keeps_infos().
  void set_info(int number, const std::string& expression);
  bool keeps_infos() const;
  /// noise_row() of an octave at expressions x and y; in space at z != 0.
  std::string noise(const std::string& x, const std::string& y, const Octave& octave, double z = 0) const;
  /// A variable that holds a formula over the distances f1 … f4, given as expressions.
  std::string formula(const Program& program, const std::vector<std::string>& distances);
  /// A call that gives all channels of a texture within at (x, y).
  std::string channels(int texture, const std::string& x, const std::string& y, double inner_texel);
  /// @throws InvalidInput naming the texture's type and the reason.
  [[noreturn]] void refuse(const std::string& reason) const;
  const std::string& statements() const { return statements_; }

 private:
  std::string filled(std::string_view text, const ShaderValues& values) const;

  ShaderWriter& writer_;
  int texture_, instance_;
  std::string statements_;
};
using WriteShader = std::function<void(PatternShader&)>;

}  // namespace papilla::procedural_detail
