// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "formula.hpp"

namespace papilla::procedural_detail {

/// A number that a formula has at hand: known now, or where it stands.
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

/// Writes the instructions of one formula: registers, constants, folding of what is known.
class BytecodeWriter {
 public:
  /// @param position  of the formula, for messages.
  BytecodeWriter(FormulaScope& scope, std::size_t position) : scope_(scope), position_(position) {}

  /// A kernel applied to its inputs; a constant when they are. Inputs in registers are used up unless `keep`.
  /// @pre a kernel has that name.
  Scalar apply(std::string_view name, const std::vector<Scalar>& in, bool keep = false);
  /// Any other instruction with a number as its result.
  Scalar act(Action action, const std::vector<Scalar>& in, int index);
  /// The same with a colour.
  Value act_for_colour(Action action, const std::vector<Scalar>& in, int index);
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

}  // namespace papilla::procedural_detail
