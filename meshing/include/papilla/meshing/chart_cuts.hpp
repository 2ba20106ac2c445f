// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
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

/// The same for those charts alone that no method can map as they are: closed ones and those with handles become disks,
/// all others stay as they are with their holes. A closed chart of genus 0 is slit along a path of least cost between
/// two far points. When no chart is opened, the set comes back as it is. O(n log n); deterministic.
/// @throws InvalidInput as open_charts().
ChartSet open_closed_charts(const TriangleMesh& mesh, const ChartSet& charts);

/// Cuts charts of one mesh across; what depends on the mesh alone is found once.
class ChartHalver {
 public:
  /// @param mesh must live as long. O(n log n).
  /// @throws InvalidInput when the mesh has a bad index or coordinate.
  explicit ChartHalver(const TriangleMesh& mesh);
  ~ChartHalver();
  ChartHalver(const ChartHalver&) = delete;
  ChartHalver& operator=(const ChartHalver&) = delete;

  /// Charts with some of them cut across: each named chart of two triangles or more falls into two or more, along the
  /// path of least cost (as in segment_charts()) from border to border half way between its two farthest triangles. For
  /// charts that a method can't flatten. O(n log n); deterministic.
  /// @throws InvalidInput when the charts don't fit the mesh, and for a number that is not below `charts.count`.
  ChartSet halve(const ChartSet& charts, std::span<const std::uint32_t> numbers) const;

 private:
  struct Surface;
  std::unique_ptr<const Surface> surface_;
};

}  // namespace papilla
