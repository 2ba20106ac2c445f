// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "chart_field.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "piece.hpp"
#include "seam_weights.hpp"
#include "segmented_mesh.hpp"

namespace papilla::detail {

/// What seams are measured by in a chart of this area: its root, or with a common price that of the whole surface.
inline double seam_unit(const SegmentedMesh& surface, const SegmentationOptions& options, double area) {
  return std::sqrt(options.common_price ? surface.total_area : area);
}

struct PatchCuts {
  std::size_t opening = 0, relief = 0, halving = 0;  ///< How often each kind of cut was made.
};

/// Cuts a patch until every piece has the topology asked for, is not worth another relief cut, and has an outline that
/// does not overlap itself. Marks `seam`. May run in parallel for different patches.
/// @param triangles connected, with seams or borders around. @param finished  told the triangles of each piece that is
/// done.
std::vector<ChartOutline> cut_patch(const SegmentedMesh& surface, const SeamWeights& weights,
                                    const SegmentationOptions& options, std::vector<Index> triangles,
                                    PieceCutter& cutter, std::vector<std::uint8_t>& seam, PatchCuts& cuts,
                                    const std::function<void(std::size_t)>& finished);

/// Only the topology: cuts a patch until every piece is of genus 0 with a border, or a disk.
void open_patch(const SegmentedMesh& surface, const SeamWeights& weights, bool disks, std::vector<Index> triangles,
                PieceCutter& cutter, std::vector<std::uint8_t>& seam);

/// Joins charts over a common stretch of border where the union unfolds into the plane: angles add up to 2π along the
/// stretch, or the distortion that comes in is worth the seam that goes (as in relieve()); the union's outline does
/// not overlap itself; the stretch is a fair part of the smaller chart's border; and with a grain direction both
/// charts' grains run the same way. The costliest stretches go first. Other common stretches of the two charts stay as
/// seams, so that genus 0 stays genus 0. Small charts join by the longest stretch whatever it costs. Clears `seam`
/// where charts were joined.
std::vector<ChartOutline> merge_unfolded(const SegmentedMesh& surface, const SeamWeights& weights,
                                         const SegmentationOptions& options, std::vector<std::uint8_t>& seam,
                                         std::vector<ChartOutline> charts);

/// Lets charts of a single triangle, below `small_area_fraction` of a neighbour's area or below `speck_area_fraction`
/// of their component's join a larger neighbour over the longest unbroken stretch of their common border, whatever it
/// costs; other stretches stay seams, so that no handle and no closed chart comes up. Clears `seam`. Returns how many
/// joined.
std::size_t absorb_charts(const SegmentedMesh& surface, double small_area_fraction, double speck_area_fraction,
                          std::vector<std::uint8_t>& seam);

/// Per half-edge: is it a border, or bent by more than the feature angle?
std::vector<std::uint8_t> feature_halfedges(const SegmentedMesh& surface, double feature_angle_deg);

/// Labels of the pieces that half-edges which are no feature connect; `count` tells how many.
std::vector<std::uint32_t> feature_patches(const SegmentedMesh& surface, const std::vector<std::uint8_t>& feature,
                                           std::uint32_t& count);

/// Per triangle: this fraction of its component's area.
std::vector<double> speck_areas(const SegmentedMesh& surface, double fraction);

/// Lets patches below `small_area_fraction` of a neighbour's area, or below `speck_area_fraction` of their component's,
/// join the neighbour with the longest common border. Labels must be dense; returns the new count.
std::uint32_t absorb_small(const SegmentedMesh& surface, const SegmentationOptions& options,
                           std::vector<std::uint32_t>& labels);

}  // namespace papilla::detail
