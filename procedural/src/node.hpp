// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "colours.hpp"
#include "papilla/procedural/reference.hpp"
#include "papilla/procedural/texture.hpp"
#include "program.hpp"

namespace papilla::procedural_detail {

class Evaluator;
struct Block;

/// What a pattern is asked for: n points at (x, y), in units of the texture.
struct PatternRow {
  int n = 0;
  const double *x = nullptr, *y = nullptr;
  double* out = nullptr;
  double* id = nullptr;               ///< k_row numbers each.
  double* info = nullptr;             ///< k_infos rows of k_row numbers.
  double texel = 0;                   ///< Distance of neighbouring texels; 0: unknown.
  double period_x = 0, period_y = 0;  ///< The pattern shall repeat after this; 0: need not.
  const Block* block = nullptr;
  Evaluator* evaluator = nullptr;
};

/// What a base type computes: `this`.
class Pattern {
 public:
  virtual ~Pattern() = default;
  virtual void evaluate(const PatternRow& row) const = 0;
};

enum class Blend : std::uint8_t { off, interpolate, add, subtract };

/// A texture: a base type with its parameters.
struct Node {
  const TypeInfo* type = nullptr;
  std::unique_ptr<Pattern> pattern;  ///< Null: this = 0.
  double inverse_scale_x = 1, inverse_scale_y = 1;
  double du = 0, dv = 0, cos_rot = 1, sin_rot = 0;
  bool stretch = false, seamless = false, absolute = false, invert = false;
  double limit_low = -1e30, limit_high = 1e30, intensity = 1, add = 0;
  std::array<double, 3> normal{0, 1, 0}, dirt{0, -1, 0};
  Program a, b, perturb_x, perturb_y, main;
  std::array<Program, k_channels> channels;  ///< Entry Channel::main is unused.
  std::array<Blend, k_channels> blend{};
  std::vector<Rgb> colours;
  std::vector<int> textures;
  std::vector<double> ranges, fades;  ///< Of `textures`.
  bool multi = false;
  std::array<double, k_channels> channel_scale{};
  double range = 1, fade = 1;  ///< Of this texture within texmap.
  bool uses_normal = false;
  bool uses_infos = false;  ///< A formula reads the information numbers; else nobody clears them.
  double evaluations = 1;   ///< A point's cost in textures, those within included.
};

struct Graph {
  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<double> constants;
  int root = 0;
  bool uses_normal = false, uses_position = false, uses_sky = false, uses_time = false;
  std::set<std::array<double, 3>> dirt_directions;  ///< Of the textures that use the normal.
  std::set<std::string> recipes;
};

}  // namespace papilla::procedural_detail
