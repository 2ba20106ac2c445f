// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// A vertex that was slid onto a neighbour. `around` lists the triangles it had: those with the neighbour vanished, in
/// the others the neighbour took its place.
struct Removal {
  Index vertex = 0, target = 0;
  Index first_around = 0, around_count = 0;
};

/// A disk, possibly with holes, coarsened vertex by vertex, and the way back.
///
/// Short edges on flat surface go first, and the coarse triangles keep a decent shape and the side they face to as long
/// as that is possible. The topology never changes; vertices of the border slide along the border. Every state is a
/// mesh of the input's positions.
class DiskHierarchy {
 public:
  /// Coarsens as far as it goes, or to `enough` vertices. Vertices without triangles don't take part.
  DiskHierarchy(std::span<const Vec3> positions, std::span<const Triangle> triangles, std::size_t enough);

  /// The current state: triangles that are not alive have vanished.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  bool alive(Index triangle) const { return alive_[triangle]; }
  std::size_t vertex_count() const { return vertex_count_; }
  /// Removals that are not undone.
  std::size_t removed_count() const { return removed_; }

  /// How many of the last removals, those that are not undone, have no triangle in common: at least one.
  /// Precondition: removed_count() > 0.
  std::size_t apart() const;
  /// Undoes that many of the last removals, at most apart(). @return the first of them first, which is undone last.
  std::span<const Removal> restore(std::size_t count = 1);
  /// Takes the last undone removal back.
  void remove_again();
  std::span<const Index> around(const Removal& removal) const {
    return {around_.data() + removal.first_around, removal.around_count};
  }

 private:
  class Coarsener;
  std::vector<Triangle> triangles_;
  std::vector<char> alive_;
  std::vector<Removal> removals_;
  std::vector<std::size_t> passes_;  ///< First removal of each pass: those of one lie apart.
  std::vector<Index> around_;
  std::size_t removed_ = 0, vertex_count_ = 0;
};

}  // namespace papilla::param_detail
