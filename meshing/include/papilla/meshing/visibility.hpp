// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "papilla/meshing/placed_mesh.hpp"

namespace papilla {

/// Axis-parallel, closed, in mm; low <= high in every coordinate.
struct BoxVolume {
  Vec3 low, high;
};

/// Closed ball, in mm; radius >= 0.
struct SphereVolume {
  Vec3 centre;
  double radius_mm = 0;
};

/// Where eyes or hands can be.
using Volume = std::variant<BoxVolume, SphereVolume>;

/// Options of measure_visibility().
struct VisibilityOptions {
  std::uint32_t samples_per_part = 2000;  ///< >= 1.
  std::uint32_t eyes_per_sample = 32;     ///< >= 1.
};

/// How much of a part is seen.
struct PartVisibility {
  std::uint64_t samples = 0, visible_samples = 0;
  double visible_fraction = 0;  ///< visible_samples / samples: share of the area.
  /// 95 % interval of the share that these eyes see, by Wilson's score; with no visible sample out of n it is about
  /// [0, 3.8 / n].
  double low = 0, high = 0;
};

/// Ray-cast visibility: sample points spread over each part's area, each tested against eye points spread over the view
/// volume; a sample is visible when the straight line to one of its eye points meets no opaque triangle. Both sides of
/// a surface can be seen, so neither closed nor oriented parts are needed, and parts that are not opaque hide nothing.
///
/// Honest about sampling: `visible_fraction` counts what `eyes_per_sample` eyes see and is biased low, since an opening
/// that all of a sample's eyes miss stays unseen; `low` and `high` cover the chance in the surface samples, not that
/// bias. A part that is seen through a small gap only may be reported as invisible: more samples make that rarer, never
/// impossible. Lines start 1e-6 of the scene's diagonal off the surface, so that coincident sheets do not hide each
/// other. Low-discrepancy points [Roberts 2018, the R sequences], no random numbers: same input, same result, whatever
/// the number of threads. Cost: O(n log n) for the tree over all triangles, then about 1 us a line of sight.
/// @throws InvalidInput naming the part when a mesh is missing or has a bad index or coordinate, a transform is not
/// finite;
///         also when the volume or an option is out of its range.
std::vector<PartVisibility> measure_visibility(std::span<const PlacedMesh> parts, const Volume& eyes,
                                               const VisibilityOptions& options = {});

/// What of a part a volume touches.
struct PartReach {
  std::uint64_t triangles = 0, triangles_inside = 0;  ///< Those with a point in the volume.
  bool in_reach() const noexcept { return triangles_inside > 0; }
};

/// Which parts reach into a volume, exactly up to rounding: a triangle counts when it has a point in common with the
/// volume, so also where it only touches it or a large triangle passes through it. O(n), parallel, deterministic.
/// @throws InvalidInput as measure_visibility().
std::vector<PartReach> measure_reach(std::span<const PlacedMesh> parts, const Volume& reach);

}  // namespace papilla
