// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "papilla/meshing/placed_mesh.hpp"

namespace papilla {

struct StainOptions {
  std::uint32_t drops = 6000;  ///< >= 1; the noise of the stains falls with its root.
  Vec3 gravity{0, -1, 0};      ///< Any length above 0.
  double run_mm = 0;           ///< After that way down a wall a drop has lost 63 % of its dirt; 0: 1/6 of the diagonal.
  double cling = 0.7;          ///< Share of the drops that go on round an edge onto an underside, in [0, 1].
  std::uint32_t seed = 1;
};

/// Dirt in the units of a drop.
struct StainBalance {
  double carried = 0;    ///< What landed on the scene: one a drop.
  double deposited = 0;  ///< What stayed on it.
  double left = 0;       ///< What fell off it.
};

/// Stains of dirt that water carries down the surfaces of a scene, after the gamma-tons of [Chen, Xia, Wong, Tong, Bao,
/// Guo, Shum 2005: Visual Simulation of Weathering by gamma-ton Tracing].
///
/// Drops fall along gravity, evenly over the scene, and take up one unit of dirt where they land. On a level surface a
/// drop spreads in a random direction and leaves nothing (rain washes it); on a slope it follows the steepest way and
/// leaves 1 - exp(-step sin(slope) / run) of its dirt a step. At an edge it goes round onto the next surface; under an
/// overhang it clings with probability `cling`, for a quarter of the diagonal in the mean, then it falls, and goes on
/// where it lands. Where it comes from a slope to a level floor, it leaves all it has. So stains begin below edges and
/// ledges, run down from there, and fade.
///
/// The field is the dirt left per area, over what falls on a level area: a kernel density over a neighbourhood of 1/85
/// of the scene's diagonal, of deposits whose surface faces the same way.
/// carried = deposited + left, up to rounding. Details below 1/256 of the diagonal are stepped over; surfaces without
/// thickness end at their edges. Both sides of a triangle are wet. Deterministic, whatever the number of threads.
/// Cost: about 300 sight lines a drop, all cores; a query looks at 27 cells. Safe to call from several threads.
class StainField {
 public:
  /// @throws InvalidInput naming the part when a mesh is missing or has a bad index or coordinate; or when an option is
  ///         out of its range.
  explicit StainField(std::span<const PlacedMesh> parts, const StainOptions& options = {});

  /// @param point  in mm, finite. @param normal  of unit length.
  double operator()(const Vec3& point, const Vec3& normal) const noexcept;

  const StainBalance& balance() const noexcept { return balance_; }

 private:
  struct Deposits;
  std::shared_ptr<const Deposits> deposits_;
  StainBalance balance_;
};

}  // namespace papilla
