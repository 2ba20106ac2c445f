// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "triangle_bvh.hpp"
#include "world_scene.hpp"

namespace papilla::detail {

/// What TriangleBvh answers, for the opaque parts of a scene where they stand: a tree a part and one over these. No
/// triangle is copied, so that it takes about 22 bytes a triangle, and twice that when most are slanted slivers; what a
/// part needs while its tree is built is given back before the next one's. Sight lines take about 1.5 times the time.
/// Triangles are numbered through the opaque parts, and counter-clockwise seen from their front where a part is
/// mirrored, too.
class PlacedBvh {
 public:
  PlacedBvh() = default;
  /// @param scene  The meshes of its parts must outlive this.
  explicit PlacedBvh(const WorldScene& scene);

  std::size_t size() const noexcept { return size_; }

  /// The number of a part's triangle; k_no_value when it is not opaque.
  Index number(std::size_t part, std::size_t triangle) const noexcept {
    return first_[part] == k_no_value ? k_no_value : first_[part] + static_cast<Index>(triangle);
  }

  ClosestPoint closest(const Vec3& p) const noexcept;
  bool blocks(const Vec3& a, const Vec3& b, Index ignored = k_no_value) const noexcept;
  Index first_cut(const Vec3& a, const Vec3& b) const noexcept;
  TriangleFrame frame(Index triangle) const noexcept;

 private:
  struct Tree {
    PlacedTriangles part;
    Index first = 0;
    BoxTree boxes;
    std::vector<Index> order;

    TriangleFrame frame(std::size_t triangle) const noexcept;
  };

  std::size_t size_ = 0;
  std::vector<Index> first_;
  std::vector<Tree> trees_;  ///< Of the opaque parts that have triangles, their numbers ascending.
  BoxTree boxes_;
  std::vector<Index> order_;
};

}  // namespace papilla::detail
