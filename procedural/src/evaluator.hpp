// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "node.hpp"

namespace papilla::procedural_detail {

/// The raster on which neighbourhood statistics are evaluated.
struct NearRaster {
  int width = 0, height = 0;
  bool repeats = false;  ///< The left neighbour of the first column is the last one, and so on.
  std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// A statistic of the known values within `radius` texels of every texel, the texel itself included.
///
/// mean, least, most: of the values. deviation: sqrt(mean of v^2 - mean^2). slope: length of the gradient of the plane
/// that fits best, per texel. Means weigh a value at distance d by clamp(radius - d + 1/2, 0, 1) pitches of the grid.
/// A radius over 8 texels is looked at on a grid of ceil(radius / 8) texels (their mean, least or most), and
/// interpolated in between: the disc is then known to an eighth of its radius.
/// @param values  not finite where nothing is known; such texels do not count, and get 0 where nothing is near.
/// Cost: at most 230 terms a texel whatever the radius, all cores. Deterministic.
std::vector<float> near_statistic(NearStatistic kind, std::span<const float> values, const NearRaster& raster,
                                  double radius);

/// Arguments and results of a recipe's neighbourhood statistics on one raster. The picture is evaluated
/// graph.deepest_near() + 1 times: pass k = 0, 1, … collects the arguments of the statistics of level k + 1.
class Neighbourhoods {
 public:
  Neighbourhoods(const Graph& graph, const NearRaster& raster);
  /// Computes the statistics whose arguments are complete and begins the next pass.
  /// @returns false after the last pass.
  bool next();
  /// One statistic at n texels: its result once it is computed; before that without_neighbours(), and `in` is stored
  /// in the pass that collects it. Threads may call it for different texels.
  void evaluate(int request, const std::uint32_t* texels, int n, double texel, const double* in, double* out);

 private:
  struct Request {
    std::vector<float> values, found;
    std::atomic<double> texel{0};
  };
  const Graph& graph_;
  NearRaster raster_;
  std::vector<Request> requests_;
  int pass_ = 0;
};

/// The statistic of a point without neighbours: the value itself, or 0.
void without_neighbours(NearStatistic kind, const double* in, int n, double* out);

/// The points under evaluation and their attributes.
struct Block {
  int n = 0;
  const double *x = nullptr, *y = nullptr;  ///< In the coordinates of the texture that is evaluated.
  double texel = 0;
  bool solid = false;                 ///< Positions in the scene are known.
  double extent_x = 1, extent_y = 1;  ///< What the picture spans in these coordinates.
  const float* normals = nullptr;     ///< 3 a point, or null.
  std::array<const double*, k_block_rows> rows{};
  Neighbourhoods* near = nullptr;         ///< Null: the points have no neighbours.
  const std::uint32_t* texels = nullptr;  ///< Numbers of the points' texels in its raster.
};

/// Results of a texture's channels; color has three rows.
struct ChannelRows {
  alignas(64) double row[k_channels + 2][k_row];
};

/// Evaluates one graph, a row of points at a time. Each thread needs its own.
class Evaluator {
 public:
  explicit Evaluator(const Graph& graph);
  ~Evaluator();
  /// `main` of a texture.
  void main_value(int node, const Block& block, double* out);
  /// The channels whose bits are set.
  void channels(int node, const Block& block, unsigned mask, ChannelRows& out);
  /// The formula of a pattern, over distances f1 to f4, into out.
  void run_on_distances(const Program& program, const double* const* f, int count, int n, double* out);

 private:
  struct Frame;
  Frame& frame_of(int node);
  void prepare(int node, Frame& frame, const Block& block);
  void pattern_and_main(int node, Frame& frame, const Block& block);
  void blended_corners(int node, Frame& frame, const Block& block, double width, double height);
  void run(const Program& program, int node, Frame& frame, const Block& block, double* const* out);
  void step(const Instruction& code, int node, Frame& frame, const Block& block);
  void finish_main(const Node& node, Frame& frame, int n);
  void layers(int node, Frame& frame, const Block& block, ChannelRows& out);
  void texmap(const Node& node, const double* place, const Block& block, unsigned mask, ChannelRows& out);
  const double* operand(const Operand& o, const Frame& frame, const Block& block) const;

  const Graph& graph_;
  std::vector<double> constants_;  ///< A row each.
  std::vector<std::unique_ptr<Frame>> frames_;
  std::unique_ptr<Frame> scratch_;  ///< Of run_on_distances().
};

}  // namespace papilla::procedural_detail
