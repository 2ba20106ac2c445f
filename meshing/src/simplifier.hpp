// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "papilla/meshing/simplify.hpp"
#include "triangle_bvh.hpp"
#include "wedge_mesh.hpp"

namespace papilla::detail {

/// Simplifies one mesh, as often as wanted, measuring against the same input. For one thread at a time.
class Simplifier {
 public:
  /// @throws InvalidInput in the name of `function`.
  Simplifier(const TriangleMesh& mesh, const SimplifyOptions& options, std::string_view function);

  /// Triangles between wedges of the input.
  const std::vector<Index>& all() const noexcept { return wedges_.indices; }

  /// Collapses of at most the error, without measuring.
  std::vector<Index> collapse(const std::vector<Index>& indices, double error_mm, std::size_t target_triangles) const;

  /// The fewest triangles within the tolerance that the passes find, from `indices` on, which hold it already. Writes
  /// the trace.
  std::vector<Index> within(std::vector<Index> indices, double tolerance_mm, std::size_t target_triangles,
                            const Stopwatch& clock, Trace& trace) const;

  /// The mesh of these triangles, which hold the tolerance (infinity: any), with its measured deviation.
  SimplifyResult result(const std::vector<Index>& indices, double tolerance_mm) const;

  double diagonal() const noexcept { return diagonal_; }

 private:
  TriangleMesh surface(const std::vector<Index>& indices) const;
  /// Of `surface_`, made when it is first asked for: a decimation of the whole input wants the memory before.
  const TriangleBvh& bvh() const;
  bool collapse_and_check(std::vector<Index>& indices, double error_mm, double tolerance_mm,
                          std::size_t target_triangles) const;

  const TriangleMesh& mesh_;
  SimplifyOptions options_;
  WedgeMesh wedges_;
  TriangleMesh surface_;  ///< The input's, positions only.
  mutable std::optional<TriangleBvh> bvh_;
  double diagonal_ = 0;
};

}  // namespace papilla::detail
