// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of segment_charts(). All are relative, so one set of values serves any size of part.
struct SegmentationOptions {
  /// What seams cost against distortion, the λ below: 0.01 cuts generously, 0.5 hardly ever; >= 0.
  double seam_cost = 0.03;
  double feature_angle_deg = 45;      ///< Edges bent more than this are the first seams; in (0, 180].
  double small_area_fraction = 1e-3;  ///< A chart below this fraction of a neighbour's area joins it; in [0, 1].
  double speck_area_fraction =
      1e-5;                 ///< A patch below this fraction of its component's area joins its longest
                            ///< neighbour whatever that one's size, which bounds the number of charts; in [0, 1].
  bool disks = true;        ///< Every chart a disk. Else holes stay that a flat sheet could have: they need no cut.
  bool unfold = true;       ///< Charts may go on over feature edges where they unfold into the plane.
  double union_trials = 1;  ///< How many unions that need a solve are tried, of the usual number; >= 0.
  /// A seam costs λ w |e| √A of the whole surface, wherever it is, instead of λ w |e| √A_c: what minimises the sum of
  /// all seams for a given sum of distortion.
  bool common_price = false;
  bool feature_seams = true;  ///< Feature edges are the first seams; false: only what topology and distortion ask for.
  bool weigh_seams = true;    ///< Seams count by how visible they are; false: w = 1, by their length alone.
  /// Given: what can't be seen from there counts as hidden, o = 0.2, all else as open, o = 1; in the mesh's
  /// coordinates.
  std::optional<Vec3> eye = {};
  /// The direction in the surface in which grain should run at a place with this outward normal. When given, charts are
  /// joined over feature edges only where the grain goes on in its direction.
  std::function<Vec3(Vec3)> grain = {};
  ProgressCallback progress = {};  ///< Told the fraction done; may be empty.
};

/// The distortion D, measured on the map of a chart, from which on the chart is better cut in two: 3 λ. A cut as long
/// as the root of the area raises E by about λ A, and takes off half of A D or more.
inline double worth_halving(const SegmentationOptions& options) { return 3 * options.seam_cost; }

struct SegmentationResult {
  ChartSet charts;
  std::size_t feature_patches = 0;  ///< Pieces between feature edges.
  std::size_t absorbed = 0;         ///< Small patches and charts that joined a neighbour.
  std::size_t disk_cuts = 0;        ///< Openings of handles, closed surfaces and border loops.
  std::size_t relief_cuts = 0;      ///< Pieces whose distortion was worth cuts.
  std::size_t halved = 0;           ///< Pieces that would have overlapped themselves in the plane.
  std::size_t unfolded = 0;         ///< Charts that were joined to another.
};

/// Splits a mesh into charts for texturing, with few and hidden seams at low distortion. It seeks a small value of
///
///     E = Σ_c A_c (D_c + λ S_c / √A_c),     D_c = area mean of σ1² + σ2² + σ1⁻² + σ2⁻² - 4,     S_c = Σ w_e |e|
///
/// over the charts c of area A_c and their seams e. D is that of the conformal map with the least variation of scale:
/// the logarithm u of the scale solves Δu = K, u = 0 on the border, so that σ1 = σ2 = e^u [Springborn, Schröder,
/// Pinkall 2008]. w_e in [0.05, 1] is how visible a seam is: w = o (1 - s), o the share of directions in which the
/// edge is open to the outside (ray casts against the mesh, at least 0.2), s = 1/2 for creases of the feature angle,
/// 3/4 for concave ones, proportionally less for flatter edges; so seams go to creases, concave edges and places seldom
/// seen.
///
/// Steps, each a header in src/: patches between feature edges, specks absorbed; handles opened and border loops joined
/// along short hidden paths (tree and cotree, [Erickson, Whittlesey 2005]); cuts from where u is extreme, as long as E
/// falls ([Sheffer, Hart 2002], "Seamster", with E to decide); patches that would overlap themselves in the plane
/// cut between the places that overlap; at last charts joined over stretches of seam where the union unfolds (angles
/// add up to 2π, whatever the dihedral angle) or E falls, and the outline does not overlap itself. All measures are
/// areas, angles and ratios of lengths, so the number of charts follows the shape, not the tessellation.
///
/// Guarantees: every triangle in exactly one chart, chart numbers in the order of their first triangles, every chart
/// connected, of genus 0 with a border, cuts counted as border; with `disks`, a topological disk in the sense of
/// ChartTopology. Seams run along edges of the mesh. No bound on distortion: E decides.
/// Good input is repaired: welded by index, manifold and oriented; edges that are not count as borders. D is an
/// estimate: methods that don't reach the conformal optimum do worse, those that trade angles for areas better; on
/// surfaces that are rough at the scale of their triangles it counts the roughness as distortion, too.
/// Cost: O(n log n), 5 to 50 µs a triangle and thread. Connectivity is kept in arrays of opposite half-edges; charts
/// with handles or several loops go through OpenMesh. Deterministic, whatever the number of threads.
/// @throws InvalidInput when an index is out of range, a position is not finite or an option is out of range.
SegmentationResult segment_charts(const TriangleMesh& mesh, const SegmentationOptions& options = {});

/// For several segmentations of one mesh: the edges of the mesh and the rays that tell how visible a seam would be, up
/// to half of the cost, are computed once.
class ChartSegmenter {
 public:
  /// @param mesh  must live as long as this. @throws InvalidInput as segment_charts().
  explicit ChartSegmenter(const TriangleMesh& mesh);
  ~ChartSegmenter();
  ChartSegmenter(const ChartSegmenter&) = delete;
  ChartSegmenter& operator=(const ChartSegmenter&) = delete;

  /// What segment_charts() gives. @throws InvalidInput as segment_charts().
  SegmentationResult segment(const SegmentationOptions& options) const;

  /// What a seam along each half-edge (3 t + k) costs: w |e|, by `feature_angle_deg`, `weigh_seams` and `eye`; 0 on
  /// edges that are always borders. The same on both sides of an edge. O(n), with an eye O(n log n).
  /// @throws InvalidInput as segment_charts().
  std::vector<double> seam_costs(const SegmentationOptions& options) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;  ///< None of an empty mesh.
};

}  // namespace papilla
