// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formula.hpp"

namespace papilla::procedural_detail {

/// A number of a formula: a constant, or the operand that holds it during evaluation.
struct Scalar {
  bool fixed = true;
  double number = 0;
  Operand place;
  int level = 0;  ///< How many neighbourhood statistics deep it is.
};

struct Value {
  bool colour = false;
  std::array<Scalar, 3> part{};
  static Value of(double number);
  static Value of(const Scalar& scalar);
};

/// Writes the instructions of one formula: allocates registers, collects constants, folds constant expressions.
class BytecodeWriter {
 public:
  /// @param position  of the formula, for messages.
  BytecodeWriter(FormulaScope& scope, std::size_t position) : scope_(scope), position_(position) {}

  /// A kernel applied to its inputs; a constant when they are. Inputs in registers are used up unless `keep`.
  /// @pre a kernel has that name.
  Scalar apply(std::string_view name, const std::vector<Scalar>& in, bool keep = false);
  /// Appends any other instruction with a number as its result.
  Scalar emit(Action action, const std::vector<Scalar>& in, int index);
  /// The same with a colour.
  Value emit_colour(Action action, const std::vector<Scalar>& in, int index);
  /// The program whose result is `value`, as a colour or a number.
  Program finish(const Value& value, bool colour);

 private:
  int new_registers(int count);
  Operand place_of(const Scalar& s);
  Instruction& add(Action action, const std::vector<Scalar>& in, int outs);

  FormulaScope& scope_;
  std::size_t position_;
  Program program_;
  int registers_ = 0;
  std::vector<int> free_;
};

/// Resolves the names of a formula. Positions count in the whole recipe.
/// All @throw InvalidInput naming the position when a name is unknown, or not available in this formula.
class FormulaNames {
 public:
  FormulaNames(FormulaScope& scope, BytecodeWriter& writer) : scope_(scope), writer_(writer) {}

  /// A name without brackets: a variable, a texture, a colour.
  Value resolve_name(std::string_view name, std::size_t position);
  /// A name with arguments; their number and kinds are checked.
  /// @param places  positions of the arguments.
  Value resolve_call(std::string_view name, std::vector<Value> arguments, const std::vector<std::size_t>& places,
                     std::size_t position);
  /// The value of a texture; nothing when the head is unknown.
  std::optional<Value> texture(Piece recipe, std::size_t position);

 private:
  [[noreturn]] void fail(std::size_t position, const std::string& reason) const;
  std::string suggestion(std::string_view name) const;
  Value variable(std::string_view name, std::size_t position);
  std::optional<Value> constant_variable(std::string_view name) const;
  Value point_variable(std::string_view name, std::size_t position);
  Value distance_variable(std::string_view name, std::size_t position) const;
  [[noreturn]] void refuse_early(std::string_view name, std::size_t position) const;
  Value current_colour() const;
  void require_textures(std::string_view name, std::size_t position);
  Value texmapped(std::string_view name, std::size_t position);
  std::optional<Value> colour_function(std::string_view name, const std::vector<Value>& in);
  std::optional<Value> place_function(std::string_view name, const std::vector<Value>& in);
  std::optional<Value> info_function(std::string_view name, const std::vector<Value>& in, std::size_t position);
  std::optional<Value> neighbourhood(std::string_view name, const std::vector<Value>& in, std::size_t position);
  std::optional<Value> colour_map(std::string_view name, const std::vector<Value>& in, std::size_t position);
  Value function(std::string_view name, const std::vector<Value>& in, std::size_t position);
  int fixed_integer(const Value& v, int most, std::string_view what, std::size_t position) const;
  Value texmap2(const std::vector<Value>& in, std::size_t position);

  FormulaScope& scope_;
  BytecodeWriter& writer_;
};

}  // namespace papilla::procedural_detail
