// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "papilla/core/vec.hpp"
#include "piece.hpp"

namespace papilla::detail {

/// Curvature of a piece as angles: per interior vertex 2π - Σ angles, per border vertex π - Σ angles. A flat vertex,
/// whatever the creases through it, has none; the sum over the piece is 2π χ (Gauss, Bonnet).
std::vector<double> angle_defects(const Piece& piece);

/// The conformal map of a piece with the least variation of scale [Springborn, Schröder, Pinkall 2008; Sawhney, Crane
/// 2017]: the logarithm u of its scale solves Δu = K with u = 0 on the border. Pieces of more than some thousand
/// vertices are solved on clusters of them, so that any size costs O(n).
class ChartField {
 public:
  explicit ChartField(const Piece& piece);
  ~ChartField();

  /// u and what is read off it.
  struct Solution {
    std::vector<double> u;  ///< Per node.
    double mean = 0, distortion = 0, squared_scale = 0;
  };

  /// Makes these vertices border, too, where a cut would run.
  void solve(const std::vector<std::uint8_t>& cut_vertex);
  const Solution& solution() const noexcept { return solution_; }
  /// Takes up what was solved before.
  void restore(Solution solution) { solution_ = std::move(solution); }

  /// Area mean of σ1² + σ2² + σ1⁻² + σ2⁻² - 4 = 8 sinh² (u - mean).
  double distortion() const noexcept { return solution_.distortion; }
  /// The same of u itself, without the mean taken off.
  double squared_scale() const noexcept { return solution_.squared_scale; }
  /// angle_defects() of a vertex.
  double defect(Index v) const noexcept { return defect_[v]; }
  /// u at a vertex.
  double scale(Index v) const noexcept { return node_[v] == k_none ? 0 : solution_.u[node_[v]]; }
  /// Where u is largest, if anywhere above zero, and smallest, if below.
  struct Extremes {
    Index largest = k_none, smallest = k_none;
  };
  Extremes extremes() const;

  /// Where the border comes to lie in that map: the polygon of the outer loop (border_loops().front()), from turning
  /// angles k - ∂u/∂n and true lengths; what is missing for closing is spread along it.
  std::vector<Vec2> lay_out(const Piece& piece, const std::vector<Index>& outer) const;

 private:
  struct Link {
    Index a, b;  ///< Nodes; b is k_none for the border, which `border_vertex` then names.
    Index border_vertex;
    double weight;
  };
  void cluster(const Piece& piece);
  void connect(const Piece& piece, const std::vector<std::array<double, 3>>& angles);
  void order();
  /// The system's matrix for no cut at all: that of any cut has zeros more.
  void make_system();
  void sum_up();

  std::vector<Index> node_;     ///< Per vertex; k_none on the border.
  std::vector<Index> centre_;   ///< A vertex of each node.
  std::vector<int> row_;        ///< Per node, in an order that leaves little fill-in.
  std::vector<double> defect_;  ///< Per vertex.
  std::vector<double> charge_, area_;
  std::vector<Link> links_;
  double border_area_ = 0;
  struct System;
  std::unique_ptr<System> system_;
  Solution solution_;
};

/// A chart by its outer border, flattened: what neighbours are fitted against.
struct ChartOutline {
  std::vector<Index> triangles;
  std::vector<Index> border;    ///< Half-edges of the surface along the outer loop, the chart on their left.
  std::vector<Vec2> place;      ///< Where each border half-edge starts in the plane.
  std::vector<double> turning;  ///< π - Σ angles of the chart there, on the surface.
  double area = 0, distortion = 0;
};

/// @param field of this piece.
ChartOutline make_outline(const Piece& piece, const ChartField& field);

}  // namespace papilla::detail
