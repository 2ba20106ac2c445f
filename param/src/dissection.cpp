// SPDX-License-Identifier: MIT
#include "dissection.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "papilla/core/bounds.hpp"

namespace papilla::param_detail {
namespace {

/// A separator longer than this times √(number of unknowns) is worth a search for a shorter one.
constexpr double k_long_separator = 1.2;

/// Halves of fewer unknowns are not worth a task of their own, nor are branches deeper than this below the root.
constexpr std::size_t k_parallel_members = 4096;
constexpr int k_parallel_depth = 5;

/// Fronts that one thread works through at a time.
constexpr std::size_t k_fronts_together = 64;

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
      : graph_(graph), where_(where), leaf_(leaf), region_(where.size(), 0), mark_(where.size(), 0) {}

  Dissection run() {
    Dissection result;
    result.order.resize(where_.size());
    std::iota(result.order.begin(), result.order.end(), Index{0});
    all_ = result.order.data();
    split(result.order, 0, result.fronts);
    result.position.resize(where_.size());
    for (Index i = 0; i < result.order.size(); ++i) result.position[result.order[i]] = i;
    return result;
  }

 private:
  /// Brings the members into elimination order and appends the fronts of their subtree, the root last.
  void split(std::span<Index> members, int depth, std::vector<Front>& fronts) {
    if (members.size() <= leaf_) return add_front(members, k_no_front, k_no_front, fronts);
    const std::uint32_t inside = ++regions_;
    for (const Index v : members) std::atomic_ref(region_[v]).store(inside, std::memory_order_relaxed);
    Cut best = cut_along_longest_axis(members, inside);
    if (static_cast<double>(best.separator) > k_long_separator * std::sqrt(static_cast<double>(members.size()))) {
      const Cut by_distance = cut_by_distance(members, inside);
      if (by_distance.separator < best.separator) best = by_distance;
    }
    arrange(members, best);
    const std::span<Index> left = members.subspan(0, best.left), right = members.subspan(best.left, best.right);
    Index left_root = 0;
    if (depth < k_parallel_depth && right.size() > k_parallel_members) {
      std::vector<Front> of_right;
      oneapi::tbb::parallel_invoke([&] { split(left, depth + 1, fronts); }, [&] { split(right, depth + 1, of_right); });
      left_root = static_cast<Index>(fronts.size() - 1);
      append(std::move(of_right), fronts);
    } else {
      split(left, depth + 1, fronts);
      left_root = static_cast<Index>(fronts.size() - 1);
      split(right, depth + 1, fronts);
    }
    add_front(members.subspan(best.left + best.right), left_root, static_cast<Index>(fronts.size() - 1), fronts);
  }

  /// Appends the fronts of a subtree that were numbered from 0 on.
  static void append(std::vector<Front> more, std::vector<Front>& fronts) {
    const auto first = static_cast<Index>(fronts.size());
    for (Front& front : more)
      for (Index* number : {&front.parent, &front.left, &front.right})
        if (*number != k_no_front) *number += first;
    fronts.insert(fronts.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }

  void add_front(std::span<const Index> own, Index left, Index right, std::vector<Front>& fronts) const {
    Front front;
    front.begin = static_cast<Index>(own.data() - all_);
    front.end = front.begin + static_cast<Index>(own.size());
    front.left = left, front.right = right;
    for (const Index child : {left, right})
      if (child != k_no_front) fronts[child].parent = static_cast<Index>(fronts.size());
    fronts.push_back(std::move(front));
  }

  /// Whether a neighbour of a member is a member; others may be in the hands of another thread.
  bool is_inside(Index v, std::uint32_t region) {
    return std::atomic_ref(region_[v]).load(std::memory_order_relaxed) == region;
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
        if (is_inside(w, inside) && mark_[w] != seen) mark_[w] = seen, queue.push_back(w);
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
        if (is_inside(w, inside) && (mark_[w] == right_half || mark_[w] == right_at_cut))
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

  const Graph& graph_;
  std::span<const Vec3> where_;
  Index leaf_;
  std::vector<std::uint32_t> region_, mark_;
  std::atomic<std::uint32_t> regions_ = 0, marks_ = 0;  ///< Numbers that were given, each to one thread.
  const Index* all_ = nullptr;                          ///< The order of all unknowns.
};

/// @param seen per unknown, the last front of this branch that has it as a row.
void find_rows_below(Index f, int depth, const Graph& graph, Dissection& dissection, std::vector<Index>& seen) {
  Front& front = dissection.fronts[f];
  if (front.left != k_no_front) {
    if (depth < k_parallel_depth && front.begin - dissection.fronts[front.left].end > k_parallel_members) {
      std::vector<Index> seen_by_right;
      oneapi::tbb::parallel_invoke([&] { find_rows_below(front.left, depth + 1, graph, dissection, seen); },
                                   [&] {
                                     seen_by_right.resize(seen.size(), k_no_front);
                                     find_rows_below(front.right, depth + 1, graph, dissection, seen_by_right);
                                   });
    } else {
      find_rows_below(front.left, depth + 1, graph, dissection, seen);
      find_rows_below(front.right, depth + 1, graph, dissection, seen);
    }
  }
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

void find_rows(const Graph& graph, Dissection& dissection) {
  std::vector<Index> seen(dissection.order.size(), k_no_front);
  if (!dissection.fronts.empty())
    find_rows_below(static_cast<Index>(dissection.fronts.size() - 1), 0, graph, dissection, seen);
}

void link_to_parents(Dissection& dissection) {
  for_each_front(dissection.fronts, [&](Index f) {
    Front& front = dissection.fronts[f];
    if (front.parent == k_no_front) return;
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
  });
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

}  // namespace

Elements elements_of(std::span<const Triangle> triangles) {
  Elements elements;
  elements.first.reserve(triangles.size() + 1);
  elements.vertices.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) elements.add(t);
  return elements;
}

void for_each_front(std::span<const Front> fronts, const std::function<void(Index front)>& work) {
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, fronts.size(), k_fronts_together),
                            [&](const auto& range) {
                              for (std::size_t f = range.begin(); f < range.end(); ++f) work(static_cast<Index>(f));
                            });
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

}  // namespace papilla::param_detail
