// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of repair(). The defaults are relative to the part, so they serve any size: fractions of its bounding
/// diagonal, or of 0.6 of its farthest distance from the origin of its frame where that is more, because what is
/// written in single precision is coarser there.
struct RepairOptions {
  std::optional<double> weld_mm = {};    ///< Weld tolerance; not given: 1e-6 of that length.
  std::optional<double> stitch_mm = {};  ///< Widest gap between faces that is closed; not given: 2e-4 of the diagonal;
                                         ///< 0: gaps stay.
  std::optional<double> tolerance_mm = {};  ///< The furthest that the surface may move; not given: 2e-4 of the diagonal
                                            ///< (or `stitch_mm`), and what welding and parting sheets may take.
  double fill_holes_mm = 0;                 ///< Holes that fit into a box of this diagonal are filled; 0: holes stay.
  std::size_t max_passes = 16;              ///< At least 1.
  std::size_t sample_above = 100'000;       ///< Pieces of more triangles are measured by samples.
  Deadline deadline = {};                   ///< Pieces not done by then stay as they came.
  ProgressCallback progress = {};           ///< Told the fraction done; may be empty.
};

/// What each operation did, summed over the passes.
struct RepairCounts {
  std::size_t welded_equal = 0;      ///< Positions that another one equalled, in single precision.
  std::size_t welded_near = 0;       ///< Vertices moved onto another one to close a crack.
  std::size_t repeated_corners = 0;  ///< Triangles dropped because they named a vertex twice, or came to by welding.
  std::size_t collapsed_needles = 0;
  std::size_t flipped_caps = 0;
  std::size_t pushed_apexes = 0;   ///< Vertices pushed off an edge they lay on.
  std::size_t duplicates = 0;      ///< Triangles dropped because an earlier one ran the same way.
  std::size_t opposites = 0;       ///< Backs of double sheets dropped.
  std::size_t kept_walls = 0;      ///< Backs of double sheets that stay: each side goes on into other surface.
  std::size_t kept_backs = 0;      ///< Backs of double sheets that stay: they look different.
  std::size_t t_junctions = 0;     ///< Vertices inserted into boundary edges.
  std::size_t border_slivers = 0;  ///< Border triangles dropped because their apex lay on their boundary edge.
  std::size_t reversed = 0;        ///< Triangles turned over.
  std::size_t parted_edges = 0;    ///< Non-manifold edges and cuts through non-orientable surfaces.
  std::size_t added_vertices = 0;  ///< Copies made to part them.
  std::size_t stitched_gaps = 0;   ///< Gaps between faces closed.
  std::size_t filled_holes = 0;
  std::size_t added_triangles = 0;  ///< In gaps and holes.
  friend bool operator==(const RepairCounts&, const RepairCounts&) = default;
};

/// All of them, with the names that reports use.
inline constexpr std::pair<std::string_view, std::size_t RepairCounts::*> k_repair_counts[] = {
    {"welded_equal", &RepairCounts::welded_equal},
    {"welded_near", &RepairCounts::welded_near},
    {"repeated_corners", &RepairCounts::repeated_corners},
    {"collapsed_needles", &RepairCounts::collapsed_needles},
    {"flipped_caps", &RepairCounts::flipped_caps},
    {"pushed_apexes", &RepairCounts::pushed_apexes},
    {"duplicates", &RepairCounts::duplicates},
    {"opposites", &RepairCounts::opposites},
    {"kept_walls", &RepairCounts::kept_walls},
    {"kept_backs", &RepairCounts::kept_backs},
    {"t_junctions", &RepairCounts::t_junctions},
    {"border_slivers", &RepairCounts::border_slivers},
    {"reversed", &RepairCounts::reversed},
    {"parted_edges", &RepairCounts::parted_edges},
    {"added_vertices", &RepairCounts::added_vertices},
    {"stitched_gaps", &RepairCounts::stitched_gaps},
    {"filled_holes", &RepairCounts::filled_holes},
    {"added_triangles", &RepairCounts::added_triangles}};

/// The furthest that each operation moved a point of the surface in one pass, in mm.
struct RepairDeviations {
  double weld = 0, degenerate = 0, t_junctions = 0, partings = 0, stitches = 0;
};

struct RepairResult {
  TriangleMesh mesh;
  RepairCounts counts;
  RepairDeviations deviations;
  double weld_tolerance_mm = 0;
  double stitch_tolerance_mm = 0;
  double tolerance_mm = 0;      ///< The furthest that the surface may move. Pieces that would move further are refused.
  double max_deviation_mm = 0;  ///< Upper bound: the sum over all operations and passes of the furthest each moved the
                                ///< surface. What fills a hole is new surface and does not count.
  double lost_mm = 0;   ///< Measured: no point of the surface that came is farther from the one that is left. Triangles
                        ///< flatter than 1.2e-6 of the reference length are no surface; distances below a fiftieth of
                        ///< the tolerance are not told apart.
  double added_mm = 0;  ///< The other way round: what fills gaps and holes counts.
  bool sampled = false;  ///< Both are the largest met at samples where pieces are larger than `sample_above`.
  std::size_t refused_triangles = 0;     ///< Of pieces that stay as they came, because they would have moved too far.
  double refused_mm = 0;                 ///< How far.
  std::size_t unfinished_triangles = 0;  ///< Of pieces that stay as they came, because the deadline had passed.
  std::set<std::uint32_t> two_sided;     ///< Materials (TriangleMesh::material, 0 without) of sheets whose back was
                                         ///< dropped: to be shown from both sides.
  std::size_t passes = 0;
  bool settled = false;  ///< The last pass found nothing left to do. Otherwise max_passes or the deadline ended the
                         ///< work.
};

/// Makes a clean, oriented, manifold mesh of a triangle soup: welds, drops duplicates, removes degenerate triangles,
/// splits T-junctions, orients, parts what is not manifold, closes gaps, and repeats until nothing changes. Pieces that
/// have nothing to do with each other are repaired one by one; one that is measured to have moved by more than
/// `tolerance_mm` stays as it came.
///
/// Guarantees when `settled` and nothing is refused or unfinished: no degenerate or duplicate triangle, no edge of more
/// than two triangles, no neighbours running opposite senses, no T-junction, every vertex with one fan of triangles
/// (indices; sheets that touch in a point keep equal positions there); all of that, as mesh_statistics() counts it,
/// also of the positions rounded to single precision in millimetres or metres, as files hold them; repairing the result
/// again changes nothing. Closed input stays closed unless it was a double sheet; no surface is lost but that of
/// degenerate triangles. Positions, normals, uv, colours, materials and CAD faces are carried through.
///
/// Cost: O(n log n), a few linear passes for CAD soups, and 4 us for each triangle that changed in pieces that are
/// measured whole; about 250 bytes per triangle. Deterministic.
/// @throws InvalidInput when an index is out of range, a position is not finite, `weld_mm` is negative or not finite,
///         or max_passes is 0.
RepairResult repair(TriangleMesh mesh, const RepairOptions& options = {});

/// What was done to all of them, without meshes: counts added, distances, tolerances and passes the largest.
RepairResult total_repair(std::span<const RepairResult> results);

}  // namespace papilla
