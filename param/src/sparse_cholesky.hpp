// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "dissection.hpp"
#include "large_array.hpp"

namespace papilla::param_detail {

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

  /// Overwrites b, `width` numbers per vertex in the caller's order, by A⁻¹ b. Large branches run in parallel.
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

  /// Numbers of a solve in elimination order, and of each front what it hands to its parent.
  struct Solution;
  void solve_up(Index front, Solution& solution) const;
  void solve_down(Index front, Solution& solution) const;
  /// Works on both branches of a front.
  template <class Work>
  void on_branches(const Front& front, const Work& work) const;

  Update eliminate(Index front, const FillElement& fill, const Stacks& stacks);
  /// @param room workspace of the front and those below; allocated when it is empty.
  Update eliminate_alone(Index front, const FillElement& fill, LargeArray<Scalar>& room);

  template <std::size_t Width>
  void add_elements(const Front& front, const FillElement& fill, Scalar* matrix, Scalar* panel,
                    const Update& update) const;
  template <std::size_t Width>
  static void add_update(const std::vector<Index>& into, const Update& from, const Front& front, Scalar* panel,
                         const Update& to);
  static void subtract_from_update(const Scalar* panel, std::size_t rows, std::size_t columns, const Update& update);

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
