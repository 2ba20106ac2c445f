// SPDX-License-Identifier: MIT
#include "sparse_cholesky.hpp"

#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>

#include "dense_cholesky.hpp"

namespace papilla::param_detail {
namespace {

/// Unknowns at which dissection stops: smaller fronts cost more in bookkeeping than they save.
constexpr Index k_leaf = 16;

/// Branches with fewer multiplications are not worth a task of their own.
constexpr std::size_t k_parallel_work = 200'000;

double conjugate(double x) { return x; }
std::complex<double> conjugate(std::complex<double> x) { return std::conj(x); }

}  // namespace

/// What a front hands to its parent: a square matrix over its rows, lower half.
template <class Scalar>
struct SparseCholesky<Scalar>::Update {
  std::vector<Scalar> values;
  std::size_t size = 0;
};

template <class Scalar>
SparseCholesky<Scalar>::SparseCholesky(const Elements& elements, std::span<const Vec3> where, int width)
    : width_(static_cast<std::size_t>(width)), elements_(elements), dissection_(dissect(elements, where, k_leaf)) {
  std::size_t total = 0;
  for (const Front& front : dissection_.fronts) {
    panel_.push_back(total);
    total += width_ * front.size() * width_ * front.own();
  }
  for (std::size_t e = 0; e < elements_.count(); ++e)
    largest_element_ = std::max(largest_element_, width_ * elements_.of(e).size());
  stored_ = total + k_dense_slack;
  place_.resize(elements_.vertices.size());
  for (const Front& front : dissection_.fronts)
    for (const Index e : front.elements)
      for (Index i = elements_.first[e]; i < elements_.first[e + 1]; ++i) {
        const Index row = dissection_.position[elements_.vertices[i]];
        const auto found = std::lower_bound(front.rows.begin(), front.rows.end(), row) - front.rows.begin();
        place_[i] = row < front.end ? row - front.begin : front.own() + static_cast<Index>(found);
      }
  factor_ = std::make_unique_for_overwrite<Scalar[]>(stored_);
  bad_pivots_.resize(dissection_.fronts.size());
}

template <class Scalar>
std::size_t SparseCholesky<Scalar>::factor(const FillElement& fill) {
  std::fill_n(factor_.get() + stored_ - k_dense_slack, k_dense_slack, Scalar(0));
  if (!dissection_.fronts.empty()) eliminate(static_cast<Index>(dissection_.fronts.size() - 1), fill);
  std::size_t bad = 0;
  for (const std::size_t count : bad_pivots_) bad += count;
  return bad;
}

template <class Scalar>
typename SparseCholesky<Scalar>::Update SparseCholesky<Scalar>::eliminate(Index f, const FillElement& fill) {
  const Front& front = dissection_.fronts[f];
  Update left, right;
  const auto first = [&] {
    if (front.left != k_no_front) left = eliminate(front.left, fill);
  };
  const auto second = [&] {
    if (front.right != k_no_front) right = eliminate(front.right, fill);
  };
  if (front.subtree_work * width_ * width_ * width_ > k_parallel_work)
    oneapi::tbb::parallel_invoke(first, second);
  else
    first(), second();

  const std::size_t rows = width_ * front.size(), columns = width_ * front.own();
  Scalar* panel = factor_.get() + panel_[f];
  std::fill_n(panel, rows * columns, Scalar(0));
  Update update;
  update.size = width_ * front.rows.size();
  update.values.assign(update.size * update.size + k_dense_slack, Scalar(0));
  assemble_elements(front, fill, panel, update);
  if (front.left != k_no_front) assemble_child(front, dissection_.fronts[front.left], left, panel, update);
  if (front.right != k_no_front) assemble_child(front, dissection_.fronts[front.right], right, panel, update);
  bad_pivots_[f] = factor_columns(panel, rows, columns);
  subtract_square(panel, rows, columns, update.values.data(), update.size);
  return update;
}

template <class Scalar>
void SparseCholesky<Scalar>::assemble_elements(const Front& front, const FillElement& fill, Scalar* panel,
                                               Update& update) const {
  const std::size_t rows = width_ * front.size(), own = width_ * front.own();
  std::vector<Scalar> matrix(largest_element_ * largest_element_);
  for (const Index e : front.elements) {
    const auto members = elements_.of(e);
    const Index* place = place_.data() + elements_.first[e];
    fill(e, matrix.data());
    const std::size_t size = width_ * members.size();
    for (std::size_t j = 0; j < members.size(); ++j)
      for (std::size_t i = j; i < members.size(); ++i) {
        // Only lower halves are kept: a block that would lie above the diagonal is transposed.
        const bool turned = place[i] < place[j];
        const std::size_t row = width_ * place[turned ? j : i], column = width_ * place[turned ? i : j];
        const bool eliminated = column < own;
        const std::size_t stride = eliminated ? rows : update.size, shift = eliminated ? 0 : own;
        Scalar* target = (eliminated ? panel : update.values.data()) + (column - shift) * stride + (row - shift);
        const Scalar* block = matrix.data() + width_ * (j * size + i);
        for (std::size_t c = 0; c < width_; ++c)
          for (std::size_t r = i == j ? c : 0; r < width_; ++r) {
            const Scalar value = block[c * size + r];
            if (turned)
              target[r * stride + c] += conjugate(value);
            else
              target[c * stride + r] += value;
          }
      }
  }
}

template <class Scalar>
void SparseCholesky<Scalar>::assemble_child(const Front& front, const Front& child, const Update& from, Scalar* panel,
                                            Update& to) const {
  if (width_ == 1)
    add_update<1>(child.into_parent, from, front, panel, to);
  else
    add_update<2>(child.into_parent, from, front, panel, to);
}

template <class Scalar>
template <std::size_t Width>
void SparseCholesky<Scalar>::add_update(const std::vector<Index>& into, const Update& from, const Front& front,
                                        Scalar* panel, Update& to) {
  const std::size_t rows = Width * front.size(), own = front.own();
  for (std::size_t j = 0; j < into.size(); ++j) {
    // Places ascend with rows, so that the lower half stays the lower half.
    const bool eliminated = into[j] < own;
    const std::size_t stride = eliminated ? rows : to.size, shift = eliminated ? 0 : own;
    Scalar* target = (eliminated ? panel : to.values.data()) + Width * (into[j] - shift) * stride;
    const Scalar* value = from.values.data() + Width * j * from.size;
    for (std::size_t column = 0; column < Width; ++column, target += stride, value += from.size) {
      for (std::size_t k = column; k < Width; ++k) target[Width * (into[j] - shift) + k] += value[Width * j + k];
      for (std::size_t i = j + 1; i < into.size(); ++i)
        for (std::size_t k = 0; k < Width; ++k) target[Width * (into[i] - shift) + k] += value[Width * i + k];
    }
  }
}

template <class Scalar>
void SparseCholesky<Scalar>::solve(std::span<Scalar> b) const {
  std::vector<Scalar> x(b.size()), local;
  for (std::size_t i = 0; i < dissection_.order.size(); ++i)
    for (std::size_t k = 0; k < width_; ++k) x[width_ * i + k] = b[width_ * dissection_.order[i] + k];
  const auto each_row = [&](const Front& front, auto visit) {
    std::size_t place = width_ * front.own();
    for (const Index row : front.rows)
      for (std::size_t k = 0; k < width_; ++k) visit(width_ * row + k, place++);
  };
  for (std::size_t f = 0; f < dissection_.fronts.size(); ++f) {
    const Front& front = dissection_.fronts[f];
    const std::size_t rows = width_ * front.size(), own = width_ * front.own();
    local.assign(rows, Scalar(0));
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin), own, local.begin());
    solve_forward(factor_.get() + panel_[f], rows, own, local.data());
    std::copy_n(local.begin(), own, x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin));
    each_row(front, [&](std::size_t row, std::size_t place) { x[row] += local[place]; });
  }
  for (std::size_t f = dissection_.fronts.size(); f-- > 0;) {
    const Front& front = dissection_.fronts[f];
    const std::size_t rows = width_ * front.size(), own = width_ * front.own();
    local.resize(rows);
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin), own, local.begin());
    each_row(front, [&](std::size_t row, std::size_t place) { local[place] = x[row]; });
    solve_backward(factor_.get() + panel_[f], rows, own, local.data());
    std::copy_n(local.begin(), own, x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin));
  }
  for (std::size_t i = 0; i < dissection_.order.size(); ++i)
    for (std::size_t k = 0; k < width_; ++k) b[width_ * dissection_.order[i] + k] = x[width_ * i + k];
}

template class SparseCholesky<double>;
template class SparseCholesky<std::complex<double>>;

}  // namespace papilla::param_detail
