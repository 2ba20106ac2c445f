// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Charts of any origin, cut until each is a connected surface of genus 0 with a border, along short paths that show
/// little: handles are opened and border loops joined as segment_charts() does. With `disks`, every chart is a disk;
/// else holes stay that a flat sheet could have. Charts in several pieces become several charts. O(n log n);
/// deterministic.
/// @throws InvalidInput when the charts don't fit the mesh, or the mesh has a bad index or coordinate.
ChartSet open_charts(const TriangleMesh& mesh, const ChartSet& charts, bool disks = true);

/// Charts with some of them cut across: each named chart of two triangles or more falls into two or more, along the
/// path of least cost (as in segment_charts()) from border to border half way between its two farthest triangles. For
/// charts that a method can't flatten. O(n log n); deterministic.
/// @throws InvalidInput as open_charts(), and for a number that is not below `charts.count`.
ChartSet halve_charts(const TriangleMesh& mesh, const ChartSet& charts, std::span<const std::uint32_t> numbers);

}  // namespace papilla
