// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chart_pieces.hpp"
#include "papilla/param/grain_frame.hpp"

namespace papilla::param_detail {

/// The chart's border loops, each as the list of its vertices in order; the longest (in space) first.
std::vector<std::vector<Index>> border_loops(const ChartSurface& chart);

/// Why the chart can't be flattened in one piece, or nothing: it must be connected, of genus 0, with a border whose
/// loops have three vertices or more.
std::string topology_failure(const ChartSurface& chart);

double area_of(const ChartSurface& chart);

/// Scales to equal area and turns v into the grain direction; does nothing for a map without area.
/// @param scale false: turn only.
void normalise(const ChartSurface& chart, UpAxis up, bool scale, std::vector<Vec2>& uv);

/// How the map fails to be a valid one (finite, no flipped triangle, no overlap), or nothing.
std::string map_failure(const ChartSurface& chart, const std::vector<Vec2>& uv);

/// The parallel projection along a normal of length 1, in true size.
std::vector<Vec2> projected(const ChartSurface& chart, Vec3 normal);

/// The chart moved to the origin and scaled to area 1: what solvers with absolute tolerances want.
struct UnitChart {
  ChartSurface surface;
  double scale = 1;  ///< Unit lengths per millimetre.
};
UnitChart to_unit(const ChartSurface& chart);

}  // namespace papilla::param_detail
