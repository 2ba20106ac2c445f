// SPDX-License-Identifier: MIT
#include "sparse_cholesky.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "dense_cholesky.hpp"
#include "papilla/core/bounds.hpp"

namespace papilla::param_detail {
namespace {

/// Unknowns at which dissection stops: smaller fronts cost more in bookkeeping than they save.
constexpr Index k_leaf = 24;

/// Branches with fewer multiplications are not worth a task of their own.
constexpr std::size_t k_parallel_work = 500'000;
constexpr std::size_t k_parallel_solve_work = 8'000'000;
constexpr std::size_t k_parallel_square_work = 4'000'000;

/// Panels are kept in blocks of about this size: of blocks that the system has to clear there are then none for small
/// charts, one after the other. Those of large charts are large arrays.
constexpr std::size_t k_block_bytes = std::size_t{2} << 20, k_large_block_bytes = 8 * k_block_bytes;

/// Columns are cleared from the first row of a block of so many on: dense tiles write there.
constexpr std::size_t k_clear_columns = 4;

/// Clears the lower half of columns.
template <class Scalar>
void clear_columns(Scalar* column, std::size_t rows, std::size_t columns) {
  for (std::size_t j = 0; j < columns; ++j, column += rows)
    std::fill(column + j - j % k_clear_columns, column + rows, Scalar(0));
}

/// Where a number lies in an ascending list that has it.
Index place_in(const std::vector<Index>& list, Index number) {
  const Index* first = list.data();
  for (std::size_t size = list.size(); size > 1; size -= size / 2) first += first[size / 2] <= number ? size / 2 : 0;
  return static_cast<Index>(first - list.data());
}

double conjugate(double x) { return x; }
std::complex<double> conjugate(std::complex<double> x) { return std::conj(x); }

}  // namespace

/// What a front hands to its parent: a square matrix over its rows, lower half, column by column.
template <class Scalar>
struct SparseCholesky<Scalar>::Update {
  Scalar* values = nullptr;
  std::size_t size = 0;
};

/// Where updates lie until the parent has taken them: those of a front's own depth in one place, those of the next
/// depth in the other, and so on in turns. A branch that is done leaves nothing but its root's update.
template <class Scalar>
struct SparseCholesky<Scalar>::Stacks {
  Scalar *own, *other;
  Scalar* element;  ///< Room for one element's matrix.
};

template <class Scalar>
SparseCholesky<Scalar>::SparseCholesky(const Elements& elements, std::span<const Vec3> where, int width)
    : width_(static_cast<std::size_t>(width)), elements_(elements), dissection_(dissect(elements, where, k_leaf)) {
  for (std::size_t e = 0; e < elements_.count(); ++e)
    largest_element_ = std::max(largest_element_, width_ * elements_.of(e).size());
  place_.resize(elements_.vertices.size());
  for_each_front(dissection_.fronts, [&](Index f) {
    const Front& front = dissection_.fronts[f];
    for (const Index e : front.elements)
      for (Index i = elements_.first[e]; i < elements_.first[e + 1]; ++i) {
        const Index row = dissection_.position[elements_.vertices[i]];
        place_[i] = row < front.end ? row - front.begin : front.own() + place_in(front.rows, row);
      }
  });
  make_panels();
  bad_pivots_.resize(dissection_.fronts.size());
  count_needs();
}

template <class Scalar>
void SparseCholesky<Scalar>::make_panels() {
  const std::vector<Front>& fronts = dissection_.fronts;
  const auto size = [&](std::size_t f) { return width_ * fronts[f].size() * width_ * fronts[f].own(); };
  panel_.resize(fronts.size());
  std::size_t bytes = 0;
  for (std::size_t f = 0; f < fronts.size(); ++f) bytes += size(f) * sizeof(Scalar);
  const std::size_t most = bytes > k_large_block_bytes ? k_large_block_bytes : k_block_bytes;
  for (std::size_t begin = 0, end = 0; begin < fronts.size(); begin = end) {
    std::size_t together = 0;
    do together += size(end++);
    while (end < fronts.size() && (together + size(end)) * sizeof(Scalar) <= most);
    Scalar* next = blocks_.emplace_back(make_large_array<Scalar>(together + k_dense_slack)).get();
    for (std::size_t f = begin; f < end; ++f) panel_[f] = std::exchange(next, next + size(f));
    std::fill_n(next, k_dense_slack, Scalar(0));
  }
}

template <class Scalar>
bool SparseCholesky<Scalar>::is_parallel(const Front& front) const {
  return front.right != k_no_front && front.subtree_work * width_ * width_ * width_ > k_parallel_work;
}

template <class Scalar>
std::size_t SparseCholesky<Scalar>::update_size(Index f) const {
  const std::size_t rows = width_ * dissection_.fronts[f].rows.size();
  return rows * rows;
}

template <class Scalar>
void SparseCholesky<Scalar>::count_needs() {
  needs_.resize(dissection_.fronts.size());
  for (Index f = 0; f < needs_.size(); ++f) {
    const Front& front = dissection_.fronts[f];
    Need& need = needs_[f];
    need.own = update_size(f);
    std::size_t siblings = 0;
    for (const Index child : {front.left, front.right}) {
      if (child == k_no_front || (child == front.right && is_parallel(front))) continue;
      need.own = std::max(need.own, needs_[child].other);
      need.other = std::max(need.other, siblings + needs_[child].own);
      siblings += update_size(child);
    }
  }
}

template <class Scalar>
std::size_t SparseCholesky<Scalar>::factor(const FillElement& fill) {
  if (!dissection_.fronts.empty()) eliminate_alone(static_cast<Index>(dissection_.fronts.size() - 1), fill, workspace_);
  std::size_t bad = 0;
  for (const std::size_t count : bad_pivots_) bad += count;
  return bad;
}

template <class Scalar>
typename SparseCholesky<Scalar>::Update SparseCholesky<Scalar>::eliminate_alone(Index f, const FillElement& fill,
                                                                                LargeArray<Scalar>& room) {
  const Need& need = needs_[f];
  if (!room) room = make_large_array<Scalar>(need.own + need.other + largest_element_ * largest_element_);
  return eliminate(f, fill, {room.get(), room.get() + need.own, room.get() + need.own + need.other});
}

template <class Scalar>
typename SparseCholesky<Scalar>::Update SparseCholesky<Scalar>::eliminate(Index f, const FillElement& fill,
                                                                          const Stacks& stacks) {
  const Front& front = dissection_.fronts[f];
  Update left, right;
  LargeArray<Scalar> room;  // of a right branch that runs at the same time as the left one
  if (is_parallel(front)) {
    oneapi::tbb::parallel_invoke(
        [&] {
          left = eliminate(front.left, fill, {stacks.other, stacks.own, stacks.element});
        },
        [&] { right = eliminate_alone(front.right, fill, room); });
  } else {
    Scalar* free = stacks.other;
    for (const auto& [child, update] : {std::pair(front.left, &left), std::pair(front.right, &right)})
      if (child != k_no_front) {
        *update = eliminate(child, fill, {free, stacks.own, stacks.element});
        free += update_size(child);
      }
  }

  const std::size_t rows = width_ * front.size(), columns = width_ * front.own();
  Scalar* panel = panel_[f];
  clear_columns(panel, rows, columns);
  const Update update{stacks.own, width_ * front.rows.size()};
  clear_columns(update.values, update.size, update.size);
  const auto assemble = [&]<std::size_t Width>() {
    add_elements<Width>(front, fill, stacks.element, panel, update);
    if (left.values) add_update<Width>(dissection_.fronts[front.left].into_parent, left, front, panel, update);
    if (right.values) add_update<Width>(dissection_.fronts[front.right].into_parent, right, front, panel, update);
  };
  if (width_ == 1)
    assemble.template operator()<1>();
  else
    assemble.template operator()<2>();
  bad_pivots_[f] = factor_columns(panel, rows, columns);
  subtract_from_update(panel, rows, columns, update);
  return update;
}

/// The squares of large fronts near the root, where few branches are left to run side by side, are shared by threads.
template <class Scalar>
void SparseCholesky<Scalar>::subtract_from_update(const Scalar* panel, std::size_t rows, std::size_t columns,
                                                  const Update& update) {
  const auto subtract = [&](std::size_t first, std::size_t last) {
    subtract_square(panel, rows, columns, update.values, update.size, first, std::min(last, update.size));
  };
  if (update.size * update.size * columns < k_parallel_square_work) return subtract(0, update.size);
  const std::size_t parts = (update.size + k_square_columns - 1) / k_square_columns;
  oneapi::tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
    subtract(part * k_square_columns, (part + 1) * k_square_columns);
  });
}

template <class Scalar>
template <std::size_t Width>
void SparseCholesky<Scalar>::add_elements(const Front& front, const FillElement& fill, Scalar* matrix, Scalar* panel,
                                          const Update& update) const {
  const std::size_t rows = Width * front.size(), own = Width * front.own();
  for (const Index e : front.elements) {
    const std::size_t members = elements_.of(e).size(), size = Width * members;
    const Index* place = place_.data() + elements_.first[e];
    fill(e, matrix);
    for (std::size_t j = 0; j < members; ++j)
      for (std::size_t i = j; i < members; ++i) {
        // Only lower halves are kept: a block that would lie above the diagonal is transposed.
        const bool turned = place[i] < place[j];
        const std::size_t row = Width * place[turned ? j : i], column = Width * place[turned ? i : j];
        const bool eliminated = column < own;
        const std::size_t stride = eliminated ? rows : update.size, shift = eliminated ? 0 : own;
        Scalar* target = (eliminated ? panel : update.values) + (column - shift) * stride + (row - shift);
        const Scalar* block = matrix + Width * (j * size + i);
        for (std::size_t c = 0; c < Width; ++c)
          for (std::size_t r = i == j ? c : 0; r < Width; ++r) {
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
template <std::size_t Width>
void SparseCholesky<Scalar>::add_update(const std::vector<Index>& into, const Update& from, const Front& front,
                                        Scalar* panel, const Update& to) {
  const std::size_t rows = Width * front.size(), own = front.own();
  for (std::size_t j = 0; j < into.size(); ++j) {
    // Places ascend with rows, so that the lower half stays the lower half.
    const bool eliminated = into[j] < own;
    const std::size_t stride = eliminated ? rows : to.size, shift = eliminated ? 0 : own;
    Scalar* target = (eliminated ? panel : to.values) + Width * (into[j] - shift) * stride;
    const Scalar* value = from.values + Width * j * from.size;
    for (std::size_t column = 0; column < Width; ++column, target += stride, value += from.size) {
      for (std::size_t k = column; k < Width; ++k) target[Width * (into[j] - shift) + k] += value[Width * j + k];
      for (std::size_t i = j + 1; i < into.size(); ++i)
        for (std::size_t k = 0; k < Width; ++k) target[Width * (into[i] - shift) + k] += value[Width * i + k];
    }
  }
}

template <class Scalar>
struct SparseCholesky<Scalar>::Solution {
  std::vector<Scalar> x;
  std::vector<std::size_t> first;  ///< Of a front's numbers in `of_front`: its own ones, then its rows'.
  std::vector<Scalar> of_front;
};

template <class Scalar>
template <class Work>
void SparseCholesky<Scalar>::on_branches(const Front& front, const Work& work) const {
  if (front.left == k_no_front) return;
  if (front.subtree_work * width_ * width_ * width_ > k_parallel_solve_work) {
    oneapi::tbb::parallel_invoke([&] { work(front.left); }, [&] { work(front.right); });
  } else {
    work(front.left);
    work(front.right);
  }
}

/// L y = b, from the leaves to the front: what its rows lose by the branches below is summed on the way.
template <class Scalar>
void SparseCholesky<Scalar>::solve_up(Index f, Solution& solution) const {
  const Front& front = dissection_.fronts[f];
  on_branches(front, [&](Index branch) { solve_up(branch, solution); });
  const std::size_t rows = width_ * front.size(), own = width_ * front.own();
  Scalar* numbers = solution.of_front.data() + solution.first[f];
  Scalar* const x = solution.x.data() + width_ * front.begin;
  std::copy_n(x, own, numbers);
  std::fill(numbers + own, numbers + rows, Scalar(0));
  for (const Index child : {front.left, front.right}) {
    if (child == k_no_front) continue;
    const Front& below = dissection_.fronts[child];
    const Scalar* lost = solution.of_front.data() + solution.first[child] + width_ * below.own();
    for (std::size_t i = 0; i < below.into_parent.size(); ++i)
      for (std::size_t k = 0; k < width_; ++k) numbers[width_ * below.into_parent[i] + k] += lost[width_ * i + k];
  }
  solve_forward(panel_[f], rows, own, numbers);
  std::copy_n(numbers, own, x);
}

/// Lᴴ x = y, from the front to the leaves.
template <class Scalar>
void SparseCholesky<Scalar>::solve_down(Index f, Solution& solution) const {
  const Front& front = dissection_.fronts[f];
  const std::size_t rows = width_ * front.size(), own = width_ * front.own();
  Scalar* numbers = solution.of_front.data() + solution.first[f];
  Scalar* const x = solution.x.data() + width_ * front.begin;
  for (std::size_t i = 0; i < front.rows.size(); ++i)
    for (std::size_t k = 0; k < width_; ++k) numbers[own + width_ * i + k] = solution.x[width_ * front.rows[i] + k];
  solve_backward(panel_[f], rows, own, numbers);
  std::copy_n(numbers, own, x);
  on_branches(front, [&](Index branch) { solve_down(branch, solution); });
}

template <class Scalar>
void SparseCholesky<Scalar>::solve(std::span<Scalar> b) const {
  const std::vector<Front>& fronts = dissection_.fronts;
  Solution solution;
  solution.x.resize(b.size());
  for (std::size_t i = 0; i < dissection_.order.size(); ++i)
    for (std::size_t k = 0; k < width_; ++k) solution.x[width_ * i + k] = b[width_ * dissection_.order[i] + k];
  std::size_t all = 0;
  solution.first.reserve(fronts.size());
  for (const Front& front : fronts) solution.first.push_back(std::exchange(all, all + width_ * front.size()));
  solution.of_front.resize(all);
  const auto root = static_cast<Index>(fronts.size() - 1);
  solve_up(root, solution);
  solve_down(root, solution);
  for (std::size_t i = 0; i < dissection_.order.size(); ++i)
    for (std::size_t k = 0; k < width_; ++k) b[width_ * dissection_.order[i] + k] = solution.x[width_ * i + k];
}

template class SparseCholesky<double>;
template class SparseCholesky<std::complex<double>>;

}  // namespace papilla::param_detail
