// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/param/flattening.hpp"
#include "papilla/param/grain_frame.hpp"

namespace papilla {

/// Options of flatten_triplanar(). Every length ratio is dimensionless, so one set of values serves a
/// 5 mm button and a 5 m car body alike.
struct TriplanarOptions {
  UpAxis up = UpAxis::z;
  /// How oblique, as |n·axis|, a triangle may lie to the axis it is moved to in order to straighten a class border;
  /// in [0.05, 0.577]. 0.5 stretches by a factor of 2 at most.
  double smoothing_cosine = 0.5;
  /// The same for pieces that are too small for a seam of their own; in [0.05, smoothing_cosine].
  double absorption_cosine = 0.3;
  /// A piece is too small when its area is below this fraction of the neighbour that takes it; in [0, 1].
  double small_piece = 0.05;
  int smoothing_rounds = 8;  ///< At most this many passes over the class borders; at least 0.
  Vec2 tile_mm{0, 0};        ///< Size of the grain's repeat; border jumps are counted modulo it. 0: as they are.
};

/// How far the texture jumps where two classes meet, over all seams, weighted by length: the known price of the method.
struct BorderJump {
  double seam_mm = 0;                          ///< Length of the seams.
  double mean_mm = 0, rms_mm = 0, max_mm = 0;  ///< Of |uv on one side - uv on the other|.
};

/// Wall time of the steps.
struct TriplanarSeconds {
  double project = 0;  ///< Dominant axis per triangle and coordinates per corner.
  double connect = 0;  ///< Triangle adjacency.
  double smooth = 0;
  double sheets = 0;  ///< Connected sheets, small pieces, overlap test and splits.
  double total = 0;
};

struct TriplanarResult {
  Flattening flattening;            ///< Trace: triangles that are alone in their class, after each smoothing pass.
  std::vector<std::uint8_t> label;  ///< Per triangle: 2 * axis + (1 when it looks along the negative axis).
  BorderJump border_jump;
  std::uint32_t folded_sheets = 0;  ///< Sheets that overlapped themselves and were split.
  TriplanarSeconds seconds;
};

/// Planar triple projection: each triangle is projected along the coordinate axis a for which |n_a| is largest,
///     uv = (u_sign p[u_axis], v_sign p[v_axis])   as projection_axes(a, n_a < 0, up) says,
/// in millimetres. Normals within 1e-6 of a tie take the earlier of x, y, z.
///
/// Labels are smoothed: a triangle of which two neighbours share another class (the heavier by area when there
/// are two such) joins it when |n·axis| >= smoothing_cosine; pieces with less than small_piece of a
/// neighbour's area join that neighbour when |n·axis| >= absorption_cosine on all of the piece.
/// Each class is then cut into connected sheets, and a sheet that folds over itself in projection is split.
///
/// Guarantees: no flipped and no mirrored triangle; every chart is injective up to 1e-12 of its extent; no
/// chart of one triangle, unless the triangle has no neighbour that can join it; triangles without area
/// follow their neighbours. Scale: an edge is never longer in uv than in space, at 0.577 the shortest direction
/// of an unsmoothed triangle is 0.577 of its length.
/// Good input: welded, consistently oriented. Non-manifold and inconsistently oriented edges are seams.
/// Cost: O(n) plus O(b) overlap tests for b border triangles; about 100 bytes per triangle. Single-threaded.
/// Deterministic: the same mesh gives the same bytes.
/// Source: planar triple projection of section 4.2.3.1 of the thesis on haptic textures, with the dominant axis instead
/// of the 45° rule, which leaves (1,1,1)/√3 without a class.
///
/// @param mesh positions finite, indices in range, any topology, may be empty.
/// @throws InvalidInput when a position is not finite, an index is out of range, or an option is.
TriplanarResult flatten_triplanar(const TriangleMesh& mesh, const TriplanarOptions& options = {});

}  // namespace papilla
