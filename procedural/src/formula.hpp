// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "node.hpp"
#include "syntax.hpp"

namespace papilla::procedural_detail {

/// The order of evaluation: a formula can use the results of earlier stages.
enum class FormulaStage : std::uint8_t { first, second, place, main, channel };

/// The names that a formula may use, and what compiling it finds out about its texture.
struct FormulaScope {
  Graph* graph = nullptr;
  const Origin* origin = nullptr;
  double time = 0, globaltime = 0, realtime = 0, seed = 0;
  double du = 0, dv = 0, privatescalex = 1, privatescaley = 1;
  bool point = true;                  ///< x, y, textures and what depends on the place may be named.
  bool distances = false;             ///< f1 to f4.
  bool density = false;               ///< orig, index.
  std::size_t textures = 0;           ///< Of the parameter `textures`.
  std::vector<double> texture_costs;  ///< Evaluations of each.
  std::function<std::optional<int>(Piece recipe)> texture;  ///< Compiles a recipe; nothing when the head is unknown.
  std::function<std::optional<Rgb>(std::string_view)> colour;
  std::function<std::vector<std::string_view>()> known_names;  ///< For suggestions.
  double cost = 0;                                             ///< Evaluations of textures within the formulas so far.
  FormulaStage stage = FormulaStage::channel;
  int lower_level = 0;  ///< Level of the neighbourhood statistics in the layers below.
  bool textures_use_near = false;
  bool uses_normal = false, uses_infos = false, uses_near = false;
};

/// Compiles a formula to bytecode with constants folded.
/// @throws InvalidInput naming the position and what was expected.
Program compile_formula(Piece text, bool colour, FormulaScope& scope);

}  // namespace papilla::procedural_detail
