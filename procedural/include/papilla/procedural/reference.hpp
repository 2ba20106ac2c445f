// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace papilla {

/// What a recipe's parameter takes.
enum class ParameterKind {
  number,      ///< A number, or an expression without x and y.
  integer,     ///< A number that is rounded.
  flag,        ///< true or false.
  expression,  ///< A scalar expression, evaluated at every point.
  colour,      ///< A colour expression, evaluated at every point.
  text,        ///< Taken as it stands.
  choice,      ///< One of the words in `note`, separated by spaces.
  colours,     ///< A list of colour names and <r,g,b>.
  textures,    ///< A list of recipe names and [recipes].
  vector       ///< <x,y,z>; one number stands for all.
};

/// A parameter of a texture type. Where `low` < `high` is not met the range is open: -1e300 or 1e300.
struct ParameterInfo {
  std::string_view name;
  ParameterKind kind;
  double low, high;               ///< Numbers outside are refused.
  std::string_view preset;        ///< The default, as a recipe would write it.
  std::string_view note;          ///< What it does; for `choice` the words.
  std::string_view refusal = {};  ///< Why any value but the default is refused; empty: none is.
};

/// How a type keeps its promise when `seamless=true`.
enum class Seamless {
  lattice,     ///< By construction: the lattice of the type is wrapped; bit-equal across borders.
  tile,        ///< By construction: the pattern itself repeats; bit-equal across borders.
  four_corner  ///< Four shifted copies are blended (twice the blur in the middle).
};

/// A base type: the first word of a recipe.
struct TypeInfo {
  std::string_view name;
  std::string_view note;
  Seamless seamless;
  std::span<const ParameterInfo> parameters;  ///< Its own ones; common_parameters() come on top.
};

/// A function or variable of the expression language.
struct FunctionInfo {
  std::string_view name;
  int arity;                   ///< 0: a variable, written without parentheses.
  std::string_view arguments;  ///< One letter an argument: n number, c colour.
  bool colour;                 ///< What it returns: a colour, or else a number.
  std::string_view note;
};

/// The tables from which the parser, the checks, the completion and the reference page are made.
/// Static, in alphabetical order of the names. Cost: none.
/// Source: the texture types, parameters and functions of a texture editor of 2006 (thesis, appendix).
std::span<const TypeInfo> texture_types() noexcept;
std::span<const ParameterInfo> common_parameters() noexcept;
std::span<const FunctionInfo> expression_functions() noexcept;

/// The type of that name, or nullptr.
const TypeInfo* find_type(std::string_view name) noexcept;
/// The function of that name, or nullptr.
const FunctionInfo* find_function(std::string_view name) noexcept;
/// The type's own parameter of that name, else the common one, else nullptr.
const ParameterInfo* find_parameter(const TypeInfo& type, std::string_view name) noexcept;

std::string_view to_string(ParameterKind kind) noexcept;

/// The tables as Markdown: a section a type, then the common parameters, then the functions.
std::string reference_markdown();

}  // namespace papilla
