// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "large_array.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// Groups of unknowns that the terms of a quadratic form couple: element e has vertices[first[e]] to
/// vertices[first[e + 1]].
struct Elements {
  std::vector<Index> first{0}, vertices;
  std::size_t count() const { return first.size() - 1; }
  std::span<const Index> of(std::size_t e) const { return {vertices.data() + first[e], first[e + 1] - first[e]}; }
  void add(std::span<const Index> members) {
    vertices.insert(vertices.end(), members.begin(), members.end());
    first.push_back(static_cast<Index>(vertices.size()));
  }
};

Elements elements_of(std::span<const Triangle> triangles);

/// A front of the elimination: its own unknowns are eliminated together, `rows` are those that are coupled to them
/// and come later.
struct Front {
  Index begin = 0, end = 0;        ///< Own unknowns, in elimination order.
  std::vector<Index> rows;         ///< Elimination numbers, ascending.
  std::vector<Index> into_parent;  ///< Place of each row in the parent's list (own unknowns, then rows).
  std::vector<Index> elements;     ///< Elements that are summed here: those whose first unknown is eliminated here.
  Index parent = ~Index{0}, left = ~Index{0}, right = ~Index{0};
  std::size_t subtree_work = 0;  ///< Multiplications in this front and below, about.
  Index own() const { return end - begin; }
  Index size() const { return own() + static_cast<Index>(rows.size()); }
};

inline constexpr Index k_no_front = ~Index{0};

/// Nested dissection: an elimination order with little fill, and the structure of the factor.
struct Dissection {
  std::vector<Index> order;     ///< order[new] = old.
  std::vector<Index> position;  ///< position[old] = new.
  std::vector<Front> fronts;    ///< Children before parents; the last one is the root.
};

/// Splits the unknowns at the median of a coordinate, or at the median distance in edges where that cuts less, again
/// and again.
/// @param where one point per unknown, near for unknowns that are coupled.
/// @param leaf stop splitting at so many unknowns.
Dissection dissect(const Elements& elements, std::span<const Vec3> where, Index leaf);

/// A x = b for Hermitian positive definite A, factored as L Lᴴ front by front (multifrontal, nested dissection).
///
/// A is a sum over elements of small dense matrices. The order of elimination and the structure are found once, by the
/// constructor; factor() may then be called for any number of matrices. Pivots that are not positive are replaced by a
/// large number, which holds their unknown at zero. Fronts of separate branches run in parallel; each front sums its
/// parts in a fixed order, so that the result does not depend on the number of threads. Cost: O(n^1.5) time,
/// O(n log n) memory. Reference: A. George, Nested dissection of a regular finite element mesh, 1973; J. Liu, The
/// multifrontal method for sparse matrix solution, 1992.
template <class Scalar>
class SparseCholesky {
 public:
  /// Writes element e's matrix: column major, (members × width) squared; its lower half is read, of both triangles
  /// between different members the one that is lower.
  using FillElement = std::function<void(std::size_t element, Scalar* matrix)>;

  /// @param width unknowns per vertex, 1 or 2.
  SparseCholesky(const Elements& elements, std::span<const Vec3> where, int width);

  /// @return how many pivots were not positive.
  std::size_t factor(const FillElement& fill);

  /// Overwrites b, `width` numbers per vertex in the caller's order, by A⁻¹ b.
  void solve(std::span<Scalar> b) const;

 private:
  struct Update;
  struct Stacks;

  void make_panels();

  /// The most numbers that updates in and below a front take at a time, by the parity of their depth.
  struct Need {
    std::size_t own = 0, other = 0;
  };
  void count_needs();
  std::size_t update_size(Index front) const;

  /// Whether the branches below run at the same time; the right one then has memory of its own.
  bool is_parallel(const Front& front) const;

  Update eliminate(Index front, const FillElement& fill, const Stacks& stacks);
  /// @param room workspace of the front and those below; allocated when it is empty.
  Update eliminate_alone(Index front, const FillElement& fill, LargeArray<Scalar>& room);

  template <std::size_t Width>
  void add_elements(const Front& front, const FillElement& fill, Scalar* matrix, Scalar* panel,
                    const Update& update) const;
  template <std::size_t Width>
  static void add_update(const std::vector<Index>& into, const Update& from, const Front& front, Scalar* panel,
                         const Update& to);

  std::size_t width_, largest_element_ = 0;  ///< The latter in unknowns.
  Elements elements_;
  Dissection dissection_;
  std::vector<Index> place_;  ///< Of each element's members in their front: own unknowns, then rows.
  std::vector<LargeArray<Scalar>> blocks_;
  std::vector<Scalar*> panel_;           ///< Where each front's columns begin in its block.
  std::vector<Need> needs_;              ///< Per front.
  LargeArray<Scalar> workspace_;         ///< Kept for the next matrix.
  std::vector<std::size_t> bad_pivots_;  ///< Per front.
};

extern template class SparseCholesky<double>;
extern template class SparseCholesky<std::complex<double>>;

}  // namespace papilla::param_detail
