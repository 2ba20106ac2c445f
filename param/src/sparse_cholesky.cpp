// SPDX-License-Identifier: MIT
#include "sparse_cholesky.hpp"

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

/// A separator longer than this times √(number of unknowns) is worth a search for a shorter one.
constexpr double k_long_separator = 1.2;

struct Graph {
  std::vector<Index> first, neighbors;
  std::span<const Index> of(Index v) const { return {neighbors.data() + first[v], first[v + 1] - first[v]}; }
};

Graph graph_of(const Elements& elements, Index count) {
  // The elements of each vertex.
  std::vector<Index> begin(count + 2, 0), room(count + 1, 0), element_of(elements.vertices.size());
  for (const Index v : elements.vertices) ++begin[v + 2];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (Index e = 0; e < elements.count(); ++e)
    for (const Index v : elements.of(e)) {
      element_of[begin[v + 1]++] = e;
      room[v + 1] += static_cast<Index>(elements.of(e).size()) - 1;
    }
  std::partial_sum(room.begin(), room.end(), room.begin());
  // Vertices enter their neighbours' lists in ascending order, so that a second time comes right after the first.
  std::vector<Index> list(room.back()), end(room.begin(), room.end() - 1);
  for (Index v = 0; v < count; ++v)
    for (Index i = begin[v]; i < begin[v + 1]; ++i)
      for (const Index w : elements.of(element_of[i]))
        if (w != v && (end[w] == room[w] || list[end[w] - 1] != v)) list[end[w]++] = v;
  Graph graph;
  graph.first.assign(1, 0);
  graph.first.reserve(count + 1);
  for (Index v = 0; v < count; ++v) graph.first.push_back(graph.first.back() + end[v] - room[v]);
  graph.neighbors.reserve(graph.first.back());
  for (Index v = 0; v < count; ++v)
    graph.neighbors.insert(graph.neighbors.end(), list.begin() + room[v], list.begin() + end[v]);
  return graph;
}

class Dissector {
 public:
  Dissector(const Graph& graph, std::span<const Vec3> where, Index leaf)
      : graph_(graph), where_(where), leaf_(leaf), region_(where.size(), 0), mark_(where.size(), 0) {
    result_.order.reserve(where.size());
    result_.position.resize(where.size());
  }

  Dissection run() {
    std::vector<Index> all(where_.size());
    std::iota(all.begin(), all.end(), Index{0});
    split(all);
    return std::move(result_);
  }

 private:
  /// @return the front of the members' subtree.
  Index split(std::span<Index> members) {
    if (members.size() <= leaf_) return add_front(members, k_no_front, k_no_front);
    const std::uint32_t inside = ++regions_;
    for (const Index v : members) region_[v] = inside;
    Cut best = cut_along_longest_axis(members, inside);
    if (static_cast<double>(best.separator) > k_long_separator * std::sqrt(static_cast<double>(members.size()))) {
      const Cut by_distance = cut_by_distance(members, inside);
      if (by_distance.separator < best.separator) best = by_distance;
    }
    arrange(members, best);
    const Index left = split(members.subspan(0, best.left));
    const Index right = split(members.subspan(best.left, best.right));
    return add_front(members.subspan(best.left + best.right), left, right);
  }

  /// The members of the left part, the right part and the separator, in this order.
  struct Cut {
    std::vector<Index> members;
    std::size_t left = 0, right = 0, separator = std::numeric_limits<std::size_t>::max();
  };

  static void arrange(std::span<Index> members, const Cut& cut) {
    std::copy(cut.members.begin(), cut.members.end(), members.begin());
  }

  Cut cut_along_longest_axis(std::span<const Index> members, std::uint32_t inside) {
    Bounds3 bounds;
    for (const Index v : members) bounds.add(where_[v]);
    const Vec3 extent = bounds.size();
    double Vec3::*axis = &Vec3::x;
    if (extent.y > extent.*axis) axis = &Vec3::y;
    if (extent.z > extent.*axis) axis = &Vec3::z;
    std::vector<Index> sorted(members.begin(), members.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end(), [&](Index a, Index b) {
      const double x = where_[a].*axis, y = where_[b].*axis;
      return x != y ? x < y : a < b;
    });
    return cut_at(std::move(sorted), members.size() / 2, inside);
  }

  /// Breadth first from a member that is far from the first one; split where half of the members are reached.
  Cut cut_by_distance(std::span<const Index> members, std::uint32_t inside) {
    const Index far = breadth_first(members, members[0], inside).back();
    return cut_at(breadth_first(members, far, inside), members.size() / 2, inside);
  }

  /// All members by distance from `start`; those of other components follow.
  std::vector<Index> breadth_first(std::span<const Index> members, Index start, std::uint32_t inside) {
    const std::uint32_t seen = ++marks_;
    std::vector<Index> queue{start};
    queue.reserve(members.size());
    mark_[start] = seen;
    std::size_t next_member = 0;
    for (std::size_t i = 0; queue.size() < members.size();) {
      if (i == queue.size()) {
        while (mark_[members[next_member]] == seen) ++next_member;
        queue.push_back(members[next_member]);
        mark_[members[next_member]] = seen;
      }
      for (const Index w : graph_.of(queue[i++]))
        if (region_[w] == inside && mark_[w] != seen) mark_[w] = seen, queue.push_back(w);
    }
    return queue;
  }

  /// Splits a sorted list at `middle`; the separator covers every edge between the halves.
  Cut cut_at(std::vector<Index> sorted, std::size_t middle, std::uint32_t inside) {
    const std::uint32_t right_half = ++marks_;
    for (std::size_t i = middle; i < sorted.size(); ++i) mark_[sorted[i]] = right_half;
    const std::uint32_t right_at_cut = ++marks_, separator = ++marks_;
    std::array<std::vector<Index>, 2> at_cut;
    for (std::size_t i = 0; i < middle; ++i) {
      bool touches = false;
      for (const Index w : graph_.of(sorted[i]))
        if (region_[w] == inside && (mark_[w] == right_half || mark_[w] == right_at_cut))
          touches = true, mark_[w] = right_at_cut;
      if (touches) at_cut[0].push_back(sorted[i]);
    }
    for (std::size_t i = middle; i < sorted.size(); ++i)
      if (mark_[sorted[i]] == right_at_cut) at_cut[1].push_back(sorted[i]);
    // The half whose members at the cut are fewer gives the separator.
    const std::vector<Index>& chosen = at_cut[at_cut[1].size() < at_cut[0].size()];
    std::vector<Index> members;
    members.reserve(sorted.size());
    for (const Index v : chosen) mark_[v] = separator;
    Cut cut;
    for (std::size_t i = 0; i < middle; ++i)
      if (mark_[sorted[i]] != separator) members.push_back(sorted[i]);
    cut.left = members.size();
    for (std::size_t i = middle; i < sorted.size(); ++i)
      if (mark_[sorted[i]] != separator) members.push_back(sorted[i]);
    cut.right = members.size() - cut.left;
    cut.separator = chosen.size();
    members.insert(members.end(), chosen.begin(), chosen.end());
    cut.members = std::move(members);
    return cut;
  }

  Index add_front(std::span<const Index> own, Index left, Index right) {
    Front front;
    front.begin = static_cast<Index>(result_.order.size());
    for (const Index v : own) {
      result_.position[v] = static_cast<Index>(result_.order.size());
      result_.order.push_back(v);
    }
    front.end = static_cast<Index>(result_.order.size());
    front.left = left, front.right = right;
    const auto self = static_cast<Index>(result_.fronts.size());
    for (const Index child : {left, right})
      if (child != k_no_front) result_.fronts[child].parent = self;
    result_.fronts.push_back(std::move(front));
    return self;
  }

  const Graph& graph_;
  std::span<const Vec3> where_;
  Index leaf_;
  std::vector<std::uint32_t> region_, mark_;
  std::uint32_t regions_ = 0, marks_ = 0;
  Dissection result_;
};

void find_rows(const Graph& graph, Dissection& dissection) {
  std::vector<Index> seen(dissection.order.size(), k_no_front);
  for (Index f = 0; f < dissection.fronts.size(); ++f) {
    Front& front = dissection.fronts[f];
    const auto take = [&](Index row) {
      if (row >= front.end && seen[row] != f) seen[row] = f, front.rows.push_back(row);
    };
    for (Index i = front.begin; i < front.end; ++i)
      for (const Index w : graph.of(dissection.order[i])) take(dissection.position[w]);
    for (const Index child : {front.left, front.right})
      if (child != k_no_front)
        for (const Index row : dissection.fronts[child].rows) take(row);
    std::sort(front.rows.begin(), front.rows.end());
  }
}

void link_to_parents(Dissection& dissection) {
  for (Front& front : dissection.fronts) {
    if (front.parent == k_no_front) continue;
    const Front& parent = dissection.fronts[front.parent];
    front.into_parent.reserve(front.rows.size());
    auto next = parent.rows.begin();
    for (const Index row : front.rows) {
      if (row < parent.end) {
        front.into_parent.push_back(row - parent.begin);
        continue;
      }
      next = std::lower_bound(next, parent.rows.end(), row);
      front.into_parent.push_back(parent.own() + static_cast<Index>(next - parent.rows.begin()));
    }
  }
}

void distribute_elements(const Elements& elements, Dissection& dissection) {
  std::vector<Index> front_of(dissection.order.size());
  for (Index f = 0; f < dissection.fronts.size(); ++f)
    for (Index i = dissection.fronts[f].begin; i < dissection.fronts[f].end; ++i) front_of[i] = f;
  for (std::size_t e = 0; e < elements.count(); ++e) {
    if (elements.of(e).empty()) continue;
    Index first = ~Index{0};
    for (const Index v : elements.of(e)) first = std::min(first, dissection.position[v]);
    dissection.fronts[front_of[first]].elements.push_back(static_cast<Index>(e));
  }
}

void count_work(Dissection& dissection) {
  for (Front& front : dissection.fronts) {
    const std::size_t own = front.own(), rows = front.rows.size();
    front.subtree_work = own * (own * own / 3 + own * rows + rows * rows);
    for (const Index child : {front.left, front.right})
      if (child != k_no_front) front.subtree_work += dissection.fronts[child].subtree_work;
  }
}

/// Unknowns at which dissection stops: smaller fronts cost more in bookkeeping than they save.
constexpr Index k_leaf = 24;

/// Branches with fewer multiplications are not worth a task of their own.
constexpr std::size_t k_parallel_work = 500'000;

/// Panels are kept in blocks of about this size: of blocks that the system has to clear there are then none for small
/// charts, one after the other. Those of large charts are large arrays.
constexpr std::size_t k_block_bytes = std::size_t{2} << 20, k_large_block_bytes = 8 * k_block_bytes;

/// Columns of an update are cleared from the first row of a block of so many on: dense tiles write there.
constexpr std::size_t k_clear_columns = 4;

double conjugate(double x) { return x; }
std::complex<double> conjugate(std::complex<double> x) { return std::conj(x); }

}  // namespace

Elements elements_of(std::span<const Triangle> triangles) {
  Elements elements;
  elements.first.reserve(triangles.size() + 1);
  elements.vertices.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) elements.add(t);
  return elements;
}

Dissection dissect(const Elements& elements, std::span<const Vec3> where, Index leaf) {
  const Graph graph = graph_of(elements, static_cast<Index>(where.size()));
  Dissection dissection = Dissector(graph, where, leaf).run();
  find_rows(graph, dissection);
  link_to_parents(dissection);
  distribute_elements(elements, dissection);
  count_work(dissection);
  return dissection;
}

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
  for (const Front& front : dissection_.fronts)
    for (const Index e : front.elements)
      for (Index i = elements_.first[e]; i < elements_.first[e + 1]; ++i) {
        const Index row = dissection_.position[elements_.vertices[i]];
        const auto found = std::lower_bound(front.rows.begin(), front.rows.end(), row) - front.rows.begin();
        place_[i] = row < front.end ? row - front.begin : front.own() + static_cast<Index>(found);
      }
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
  std::fill_n(panel, rows * columns, Scalar(0));
  const Update update{stacks.own, width_ * front.rows.size()};
  for (std::size_t j = 0; j < update.size; ++j)
    std::fill(update.values + j * update.size + j - j % k_clear_columns, update.values + (j + 1) * update.size,
              Scalar(0));
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
  subtract_square(panel, rows, columns, update.values, update.size);
  return update;
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
    solve_forward(panel_[f], rows, own, local.data());
    std::copy_n(local.begin(), own, x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin));
    each_row(front, [&](std::size_t row, std::size_t place) { x[row] += local[place]; });
  }
  for (std::size_t f = dissection_.fronts.size(); f-- > 0;) {
    const Front& front = dissection_.fronts[f];
    const std::size_t rows = width_ * front.size(), own = width_ * front.own();
    local.resize(rows);
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin), own, local.begin());
    each_row(front, [&](std::size_t row, std::size_t place) { local[place] = x[row]; });
    solve_backward(panel_[f], rows, own, local.data());
    std::copy_n(local.begin(), own, x.begin() + static_cast<std::ptrdiff_t>(width_ * front.begin));
  }
  for (std::size_t i = 0; i < dissection_.order.size(); ++i)
    for (std::size_t k = 0; k < width_; ++k) b[width_ * dissection_.order[i] + k] = x[width_ * i + k];
}

template class SparseCholesky<double>;
template class SparseCholesky<std::complex<double>>;

}  // namespace papilla::param_detail
