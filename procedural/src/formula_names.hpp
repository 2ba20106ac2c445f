// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bytecode_writer.hpp"
#include "formula.hpp"

namespace papilla::procedural_detail {

/// What the names of a formula stand for. Positions count in the whole recipe.
/// All @throw InvalidInput naming the position when a name is unknown, or not known in this formula.
class FormulaNames {
 public:
  FormulaNames(FormulaScope& scope, BytecodeWriter& writer) : scope_(scope), writer_(writer) {}

  /// A name without brackets: a variable, a texture, a colour.
  Value plain(std::string_view name, std::size_t position);
  /// A name with arguments; their number and kinds are checked.
  /// @param places  positions of the arguments.
  Value called(std::string_view name, std::vector<Value> arguments, const std::vector<std::size_t>& places,
               std::size_t position);
  /// The value of a texture; nothing when the head is unknown.
  std::optional<Value> texture(Piece recipe, std::size_t position);

 private:
  [[noreturn]] void fail(std::size_t position, const std::string& reason) const;
  std::string suggestion(std::string_view name) const;
  Value variable(std::string_view name, std::size_t position);
  std::optional<Value> setting(std::string_view name) const;
  Value of_the_point(std::string_view name, std::size_t position);
  Value of_the_distances(std::string_view name, std::size_t position) const;
  [[noreturn]] void refuse_early(std::string_view name, std::size_t position) const;
  Value current_colour() const;
  void need_textures(std::string_view name, std::size_t position);
  Value texmapped(std::string_view name, std::size_t position);
  std::optional<Value> colour_function(std::string_view name, const std::vector<Value>& in);
  std::optional<Value> moving_function(std::string_view name, const std::vector<Value>& in);
  std::optional<Value> information(std::string_view name, const std::vector<Value>& in, std::size_t position);
  std::optional<Value> neighbourhood(std::string_view name, const std::vector<Value>& in, std::size_t position);
  std::optional<Value> colour_map(std::string_view name, const std::vector<Value>& in, std::size_t position);
  Value function(std::string_view name, const std::vector<Value>& in, std::size_t position);
  int fixed_integer(const Value& v, int most, std::string_view what, std::size_t position) const;
  Value texmap2(const std::vector<Value>& in, std::size_t position);

  FormulaScope& scope_;
  BytecodeWriter& writer_;
};

}  // namespace papilla::procedural_detail
