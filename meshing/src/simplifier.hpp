// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "papilla/meshing/simplify.hpp"
#include "triangle_bvh.hpp"
#include "wedge_mesh.hpp"

namespace papilla::detail {

class PassProgress;

/// Of measuring both sides of what so many triangles were simplified to: kept of the time that there is.
inline double seconds_to_measure(std::size_t triangles) { return 4e-6 * static_cast<double>(triangles); }

/// Simplifies one mesh, as often as wanted, measuring against the same input. For one thread at a time.
class Simplifier {
 public:
  /// @param options Its deadline ends the collapses; result() comes after it. Its progress does not matter.
  /// @throws InvalidInput in the name of `function`.
  Simplifier(const TriangleMesh& mesh, const SimplifyOptions& options, std::string_view function);

  /// Triangles between wedges of the input.
  const std::vector<Index>& all() const noexcept { return wedges_.indices; }

  /// Collapses of at most the error, without measuring; those that there is time for.
  std::vector<Index> collapse(const std::vector<Index>& indices, double error_mm, std::size_t target_triangles) const;

  /// The fewest triangles within the tolerance that the passes find in time, from `indices` on, which hold it already.
  /// Writes the trace.
  std::vector<Index> within(std::vector<Index> indices, double tolerance_mm, std::size_t target_triangles,
                            const Stopwatch& clock, Trace& trace, const ProgressCallback& progress) const;

  /// Has the deadline cut anything short?
  bool is_out_of_time() const noexcept { return out_of_time_; }

  /// The mesh of these triangles, which hold the tolerance (infinity: any), with its measured deviation.
  SimplifyResult result(const std::vector<Index>& indices, double tolerance_mm) const;

  double diagonal() const noexcept { return diagonal_; }

 private:
  TriangleMesh surface(const std::vector<Index>& indices) const;
  /// @throws OutOfTime leaving `indices` as they are.
  bool collapse_and_check(std::vector<Index>& indices, double error_mm, double tolerance_mm,
                          std::size_t target_triangles, PassProgress& progress) const;
  void run_passes(std::vector<Index>& indices, double tolerance_mm, std::size_t target_triangles,
                  const Stopwatch& clock, Trace& trace, PassProgress& progress) const;

  const TriangleMesh& mesh_;
  SimplifyOptions options_;
  WedgeMesh wedges_;
  TriangleMesh surface_;  ///< The input's, positions only.
  mutable bool out_of_time_ = false;
  double diagonal_ = 0;
};

}  // namespace papilla::detail
