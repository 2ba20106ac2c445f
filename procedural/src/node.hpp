// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "colours.hpp"
#include "papilla/procedural/preview.hpp"
#include "papilla/procedural/reference.hpp"
#include "papilla/procedural/texture.hpp"
#include "program.hpp"

namespace papilla::procedural_detail {

class Evaluator;
class PatternShader;
struct Block;
struct ChannelRows;

/// Input and output of a pattern: n points at (x, y), in units of the texture.
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
  /// Channels beside the value that come from it, through channels(): bits by Channel.
  virtual unsigned given_channels() const { return 0; }
  /// As evaluate(), whose result is the channel main, which is always given. @pre given_channels() != 0.
  virtual void channels(const PatternRow& row, ChannelRows& out) const;
  /// The same as a shader. @throws InvalidInput through shader.refuse() where there is none.
  virtual void write_shader(PatternShader& shader) const = 0;
};

/// All bits by Channel.
inline constexpr unsigned k_all_channels = (1U << k_channels) - 1;

/// Statistics of a neighbourhood.
enum class NearStatistic : std::uint8_t { mean, least, most, deviation, slope };
inline constexpr double k_most_radius = 1000;
inline constexpr std::size_t k_most_near = 64;
inline constexpr int k_deepest_near = 8;

struct NearRequest {
  NearStatistic kind;
  double radius;  ///< In the coordinates of the texture whose formula uses it.
  int level;      ///< 1, or one more than the largest of the statistics that its argument rests on.
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
  unsigned layered =
      0;  ///< Channels that come from the textures within or the pattern, unless a formula says otherwise.
  std::array<double, k_channels> channel_scale{};
  bool own_highlight = false;  ///< Its roughness follows from its own specular channels.
  bool cuts = false;           ///< As a layer it is a hole.
  double range = 1, fade = 1;  ///< Of this texture within texmap.
  PreviewLight light;
  bool uses_normal = false;
  bool uses_near = false;   ///< A formula of it or of a texture within uses a neighbourhood.
  bool uses_infos = false;  ///< A formula reads the information numbers; otherwise they are not cleared.
  double evaluations = 1;   ///< A point's cost in textures, those within included.
};

struct Graph {
  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<double> constants;
  std::vector<NearRequest> near;
  int root = 0;
  bool uses_normal = false, uses_position = false, uses_sky = false, uses_flow = false, uses_time = false;
  std::set<std::array<double, 3>> dirt_directions;  ///< Of the textures that use the normal.
  std::set<std::string> recipes;
  /// How many neighbourhood statistics rest on each other, at most.
  int deepest_near() const {
    int level = 0;
    for (const NearRequest& request : near) level = std::max(level, request.level);
    return level;
  }
};

}  // namespace papilla::procedural_detail
