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

#include "chunks.hpp"
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

/// Neighbours ascend.
struct Graph {
  std::vector<Index> begin, end, neighbors;
  std::span<const Index> of(Index v) const { return {neighbors.data() + begin[v], end[v] - begin[v]}; }
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
  Graph graph;
  graph.neighbors.resize(room.back());
  room.pop_back();
  graph.begin = graph.end = std::move(room);
  for_chunks(count, [&](std::size_t, std::size_t first, std::size_t last) {
    for (auto v = static_cast<Index>(first); v < last; ++v) {
      Index* const list = graph.neighbors.data() + graph.begin[v];
      Index* end = list;
      for (Index i = begin[v]; i < begin[v + 1]; ++i)
        for (const Index w : elements.of(element_of[i]))
          if (w != v) *end++ = w;
      std::sort(list, end);
      graph.end[v] = graph.begin[v] + static_cast<Index>(std::unique(list, end) - list);
    }
  });
  return graph;
}

class Dissector {
 public:
  Dissector(const Graph& graph, std::span<const Vec3> where, Index leaf)
      : graph_(graph),
        where_(where),
        leaf_(leaf),
        mark_(where.size(), 0),
        placed_(where.size()),
        sorted_(where.size()),
        parted_(where.size()) {}

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
    sort_along_longest_axis(members);
    Cut cut;
    take_if_shorter(cut, members);
    if (static_cast<double>(cut.separator) > k_long_separator * std::sqrt(static_cast<double>(members.size()))) {
      sort_by_distance(members);
      take_if_shorter(cut, members);
    }
    const std::span<const Index> parted = room(parted_, members);
    std::copy(parted.begin(), parted.end(), members.begin());
    const std::span<Index> left = members.subspan(0, cut.left), right = members.subspan(cut.left, cut.right);
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
    add_front(members.subspan(cut.left + cut.right), left_root, static_cast<Index>(fronts.size() - 1), fronts);
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

  /// A branch has numbers of its own. The marks of others, which other threads may be writing, differ from all of them.
  std::uint32_t mark_of(Index v) { return std::atomic_ref(mark_[v]).load(std::memory_order_relaxed); }
  void mark(Index v, std::uint32_t number) { std::atomic_ref(mark_[v]).store(number, std::memory_order_relaxed); }
  void mark(std::span<const Index> members, std::uint32_t number) {
    for (const Index v : members) mark(v, number);
  }

  /// Room for as many members, in the same place for each branch.
  template <class T>
  std::span<T> room(std::vector<T>& of_all, std::span<const Index> members) const {
    return std::span(of_all).subspan(static_cast<std::size_t>(members.data() - all_), members.size());
  }

  void sort_along_longest_axis(std::span<const Index> members) {
    Bounds3 bounds;
    for (const Index v : members) bounds.add(where_[v]);
    const Vec3 extent = bounds.size();
    double Vec3::*axis = &Vec3::x;
    if (extent.y > extent.*axis) axis = &Vec3::y;
    if (extent.z > extent.*axis) axis = &Vec3::z;
    const std::span<Place> places = room(placed_, members);
    for (std::size_t i = 0; i < members.size(); ++i) places[i] = {where_[members[i]].*axis, members[i]};
    const auto middle = places.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
    std::nth_element(places.begin(), middle, places.end(),
                     [](const Place& a, const Place& b) { return a.along != b.along ? a.along < b.along : a.v < b.v; });
    const std::span<Index> sorted = room(sorted_, members);
    for (std::size_t i = 0; i < members.size(); ++i) sorted[i] = places[i].v;
  }

  /// Breadth first from a member that is far from the first one.
  void sort_by_distance(std::span<const Index> members) {
    sort_by_distance_from(members.front(), members);
    sort_by_distance_from(room(sorted_, members).back(), members);
  }

  /// Those of other components follow.
  void sort_by_distance_from(Index start, std::span<const Index> members) {
    const std::uint32_t unseen = ++marks_, seen = ++marks_;
    mark(members, unseen);
    const std::span<Index> queue = room(sorted_, members);
    std::size_t end = 0, next_member = 0;
    const auto reach = [&](Index v) {
      mark(v, seen);
      queue[end++] = v;
    };
    reach(start);
    for (std::size_t i = 0; end < members.size();) {
      if (i == end) {
        while (mark_of(members[next_member]) == seen) ++next_member;
        reach(members[next_member]);
      }
      for (const Index w : graph_.of(queue[i++]))
        if (mark_of(w) == unseen) reach(w);
    }
  }

  /// How many members are on the left, on the right and between.
  struct Cut {
    std::size_t left = 0, right = 0, separator = std::numeric_limits<std::size_t>::max();
  };

  /// Splits the sorted members in the middle; the separator covers every edge between the halves. Where it is smaller
  /// than that of `cut`, the parts are put one after the other: left, right, separator.
  void take_if_shorter(Cut& cut, std::span<const Index> members) {
    const std::span<const Index> sorted = room(sorted_, members);
    const std::span<const Index> left = sorted.first(sorted.size() / 2), right = sorted.subspan(left.size());
    const std::uint32_t right_half = ++marks_, right_at_cut = ++marks_, separator = ++marks_;
    mark(right, right_half);
    std::vector<Index> at_cut;
    std::size_t right_members = 0;
    for (const Index v : left) {
      bool touches = false;
      for (const Index w : graph_.of(v)) {
        const std::uint32_t other = mark_of(w);
        if (other == right_half) mark(w, right_at_cut), ++right_members;
        touches = touches || other == right_half || other == right_at_cut;
      }
      if (touches) at_cut.push_back(v);
    }
    // The half whose members at the cut are fewer gives the separator.
    if (right_members < at_cut.size()) {
      at_cut.clear();
      for (const Index v : right)
        if (mark_of(v) == right_at_cut) at_cut.push_back(v);
    }
    if (at_cut.size() >= cut.separator) return;
    mark(at_cut, separator);
    const std::span<Index> parted = room(parted_, members);
    std::size_t end = 0;
    for (const Index v : left)
      if (mark_of(v) != separator) parted[end++] = v;
    cut.left = end;
    for (const Index v : right)
      if (mark_of(v) != separator) parted[end++] = v;
    cut.right = end - cut.left;
    cut.separator = at_cut.size();
    std::copy(at_cut.begin(), at_cut.end(), parted.begin() + static_cast<std::ptrdiff_t>(end));
  }

  struct Place {
    double along;
    Index v;
  };

  const Graph& graph_;
  std::span<const Vec3> where_;
  Index leaf_;
  std::vector<std::uint32_t> mark_;
  std::atomic<std::uint32_t> marks_ = 0;  ///< Numbers that were given, each to one thread.
  std::vector<Place> placed_;
  std::vector<Index> sorted_, parted_;
  const Index* all_ = nullptr;  ///< The order of all unknowns.
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
      while (*next < row) ++next;
      front.into_parent.push_back(parent.own() + static_cast<Index>(next - parent.rows.begin()));
    }
  });
}

void distribute_elements(const Elements& elements, Dissection& dissection) {
  std::vector<Index> front_of(dissection.order.size());
  for (Index f = 0; f < dissection.fronts.size(); ++f)
    for (Index i = dissection.fronts[f].begin; i < dissection.fronts[f].end; ++i) front_of[i] = f;
  std::vector<Index> front_of_element(elements.count(), k_no_front);
  for_chunks(elements.count(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      Index first = ~Index{0};
      for (const Index v : elements.of(e)) first = std::min(first, dissection.position[v]);
      if (!elements.of(e).empty()) front_of_element[e] = front_of[first];
    }
  });
  std::vector<Index> counts(dissection.fronts.size(), 0);
  for (const Index f : front_of_element)
    if (f != k_no_front) ++counts[f];
  for (std::size_t f = 0; f < counts.size(); ++f) dissection.fronts[f].elements.reserve(counts[f]);
  for (std::size_t e = 0; e < front_of_element.size(); ++e)
    if (front_of_element[e] != k_no_front)
      dissection.fronts[front_of_element[e]].elements.push_back(static_cast<Index>(e));
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
