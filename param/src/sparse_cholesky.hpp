// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "dissection.hpp"

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

  /// Overwrites b, `width` numbers per vertex in the caller's order, by A⁻¹ b.
  void solve(std::span<Scalar> b) const;

  std::size_t stored() const { return stored_; }

 private:
  struct Update;
  Update eliminate(Index front, const FillElement& fill);
  void assemble_elements(const Front& front, const FillElement& fill, Scalar* panel, Update& update) const;
  void assemble_child(const Front& front, const Front& child, const Update& from, Scalar* panel, Update& to) const;

  template <std::size_t Width>
  static void add_update(const std::vector<Index>& into, const Update& from, const Front& front, Scalar* panel,
                         Update& to);

  std::size_t width_, largest_element_ = 0;  ///< The latter in unknowns.
  Elements elements_;
  Dissection dissection_;
  std::vector<Index> place_;        ///< Of each element's members in their front: own unknowns, then rows.
  std::vector<std::size_t> panel_;  ///< Where each front's columns begin in factor_.
  std::size_t stored_ = 0;
  std::unique_ptr<Scalar[]> factor_;
  std::vector<std::size_t> bad_pivots_;  ///< Per front.
};

extern template class SparseCholesky<double>;
extern template class SparseCholesky<std::complex<double>>;

}  // namespace papilla::param_detail
