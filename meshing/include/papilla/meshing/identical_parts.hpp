// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// A part to compare with others.
struct ComparedPart {
  const TriangleMesh* mesh = nullptr;
  std::uint64_t label = 0;  ///< Parts with different labels are different, for example by their materials.
};

/// Options of find_identical_parts().
struct IdenticalOptions {
  double relative_tolerance = 1e-5;    ///< Of the part's bounding diagonal, in (0, 1e-2].
  bool compare_attributes = true;      ///< uv, uv1, colours, normals and material slots must agree, too.
  std::uint32_t most_trials = 20'000;  ///< Rotations tried per pair; a pair that needs more is taken as different.
};

/// What a part is a copy of.
struct PartCopy {
  std::uint32_t original = 0;  ///< The first part it equals; its own number when there is none.
  /// Row-major rigid motion that takes the original's mesh onto this one's; the identity for originals.
  std::array<double, 16> motion{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double max_distance_mm = 0;  ///< Largest distance between corresponding vertices after the motion.
};

/// Finds parts that are the same mesh after a translation and a rotation, so that they need to be processed only once
/// and can be instanced.
///
/// Certified: two parts are called identical only when after the motion every distinct position of one lies within the
/// tolerance of a distinct position of the other, one to one, and the triangles between them are the same, with the
/// same orientation (and the same attributes). Mirror images are therefore different unless the part is its own mirror
/// image. The order of vertices and triangles does not matter. TriangleMesh::face and cad_uv are not compared.
/// Not found: copies tessellated differently, scaled copies, and pairs whose symmetry needs more than `most_trials`.
/// Method: parts with equal counts, area and distances from the centre are laid on each other by their centre of area
/// and two vertices, at the rarest distances from it; every pair of vertices of the other part at those distances is
/// tried, the ones with the same numbers first, until the check passes. Cost: O(n log n) a part and per pair of equal
/// counts and area; deterministic.
/// @throws InvalidInput naming the part when a mesh is missing or has a bad index or coordinate; also when an option is
///         out of its range.
std::vector<PartCopy> find_identical_parts(std::span<const ComparedPart> parts, const IdenticalOptions& options = {});

}  // namespace papilla
