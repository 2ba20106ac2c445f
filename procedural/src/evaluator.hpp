// SPDX-License-Identifier: MIT
#pragma once

#include "neighbourhood.hpp"
#include "node.hpp"

namespace papilla::procedural_detail {

/// The points under evaluation and what is known of them.
struct Block {
  int n = 0;
  const double *x = nullptr, *y = nullptr;  ///< In the coordinates of whoever asks.
  double texel = 0;
  bool solid = false;                 ///< Positions in the scene are known.
  double extent_x = 1, extent_y = 1;  ///< What the picture spans in these coordinates.
  const float* normals = nullptr;     ///< 3 a point, or null.
  std::array<const double*, k_block_rows> rows{};
  Neighbourhoods* near = nullptr;         ///< Null: the points have no neighbours.
  const std::uint32_t* texels = nullptr;  ///< Where the points lie in its raster.
};

/// Results of a texture's channels; color has three rows.
struct ChannelRows {
  alignas(64) double row[k_channels + 2][k_row];
};

/// Evaluates one graph, a row of points at a time. One a thread.
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
