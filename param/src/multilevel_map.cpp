// SPDX-License-Identifier: MIT
#include "multilevel_map.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "chunks.hpp"
#include "convex_map.hpp"
#include "map_descent.hpp"
#include "map_level.hpp"
#include "nearby_map.hpp"
#include "ring_kernel.hpp"
#include "tube_map.hpp"
#include "vertex_step.hpp"

namespace papilla::param_detail {
namespace {

/// Where coarsening ends.
constexpr std::size_t k_base_vertices = 24;

/// Vertices of a level over those of the one before; fewer where the border is watched and vertices have less room.
constexpr std::size_t k_growth = 6;
constexpr std::size_t k_guarded_growth = 3;

/// Charts of so many vertices count their levels from the finest down: a step that is not a full one costs up to a
/// quarter of the time. For small charts that is nothing, and where the border is short of room the seams chosen by
/// their maps would be other ones, no better.
constexpr std::size_t k_counted_down = 20'000;

/// Vertices that one thread places at a time.
constexpr std::size_t k_together = 256;

/// Triangles of coarse levels count as having at least this part of the mean area: their shape is not the surface's,
/// and slivers keep vertices from moving one by one. On the finest level this holds, until it is relaxed, for
/// triangles whose doubled area is below k_sliver of their longest edge squared.
constexpr double k_least_area = 1e-3;
constexpr double k_sliver = 1e-4;

/// A level tells what the map will come to from this part of all vertices and so many on: hopeless is a mean energy
/// whose excess over 4 is so many times what is of use. Of 174 maps that came to be of use 2 would be lost by the hint,
/// of 1,562 others it saves a fifth of the time.
constexpr double k_telling_part = 1.0 / 64;
constexpr std::size_t k_hinting_vertices = 50, k_telling_vertices = 100;
constexpr double k_hopeless_hint = 6, k_hopeless = 3;

/// Of levels that are only a step on the way.
constexpr double k_coarse_tolerance = 1e-2;
constexpr int k_coarse_iterations = 100;
constexpr double k_relax_tolerance = 3e-3;

/// From this mean energy on a chart counts as deep: fingers, arms. It then begins with more vertices, enough for some
/// around each finger: from fewer, finer levels fall into poor minima. Levels grow slowly and are brought nearer to
/// their minimum, for steps are cheaper on a coarse level than on a fine one that starts far off.
constexpr double k_deep_energy = 15;
constexpr std::size_t k_deep_base_vertices = 200;
constexpr std::size_t k_deep_growth = 3;

/// A finer beginning whose energy is this many times that of the coarsest level has failed.
constexpr double k_much_worse = 2;
constexpr double k_deep_tolerance = 1.5e-3;

/// A tube begins as round as it is, which may be a saddle.
constexpr int k_tube_iterations = 3;

constexpr const char* k_no_time = "no time is left";

constexpr int k_relax_sweeps = 10;
constexpr int k_guarded_sweeps = 5;  // dearer, and Newton's steps do as well

/// Where the border stops all vertices at once, they go on one by one: so many times per level.
constexpr int k_most_unblocked = 4;

/// Shares of the run time, for progress: all levels but the last, and with the last one relaxed.
constexpr double k_share_of_levels = 0.5, k_share_before_newton = 0.7;

/// Of levels that are only relaxed: their long waves are right already.
constexpr int k_fine_sweeps = 30;

/// A level whose energy per area is this much of that of the level before, at most, counts as smooth.
constexpr double k_smooth = 1.01;

constexpr int k_place_steps = 20;

/// Steps end when the vertex moves by less than this fraction of an edge of its ring.
constexpr double k_small_move = 0.01;

/// How much larger or smaller than its rest shape a triangle may be taken when the apex is guessed from it.
constexpr double k_most_scale = 2;

/// A corner that is nearer to the vertex than this fraction of the edge between the others tells where it goes.
constexpr double k_near = 0.1;

struct Guess {
  Vec2 apex;
  double weight;
};

/// Where the triangle's own shape puts the vertex. Edges that are short for their distance say little about it, a
/// corner that is close to it says much.
Guess guess(const RingEdge& e) {
  const double base = e.rest.base(), along = e.rest.along(), height = e.rest.height();
  const Vec2 rest_edge{along - base, height};  // from the second to the third corner; the vertex is at the origin
  const double length = std::sqrt(dot(rest_edge, rest_edge)), uv_length = std::sqrt(dot(e.to - e.from, e.to - e.from));
  if (!(length > 0) || !(uv_length > 0)) return {e.from, 0};
  const Vec2 x = (1 / length) * rest_edge, to_apex{-base, 0};
  const double scale = std::clamp(uv_length / length, 1 / k_most_scale, k_most_scale);
  const double s = dot(to_apex, x), t = cross(x, to_apex);
  const Vec2 d = (1 / uv_length) * (e.to - e.from);
  // Measured from the nearer end, so that a turned or stretched edge matters as little as possible.
  const bool from_start = s < 0.5 * length;
  const double offset = from_start ? s : s - length;
  const Vec2 apex = (from_start ? e.from : e.to) + (scale * offset) * d + (scale * t) * Vec2{-d.y, d.x};
  const double far = std::sqrt(along * along + height * height), trust = length * length / (base * far);
  const double nearness = std::max(1.0, k_near * length / std::min(base, far));
  return {apex, e.rest.area * trust * trust * nearness * nearness};
}

bool all_positive(std::span<const RingEdge> ring, Vec2 at) {
  return std::all_of(ring.begin(), ring.end(), [&](const RingEdge& e) { return cross(e.from - at, e.to - at) > 0; });
}

/// Finds a place where all triangles of the ring are positive and, as far as one vertex can do, their symmetric
/// Dirichlet energy is low.
/// @param ring edges in order, the last one ending where the first one starts when the vertex is not on the border.
/// @param allowed may refuse places; empty: none. For a vertex on the border it must not refuse the polygon of the
/// ring.
/// @return false when rounding leaves no such place.
bool place_in_ring(std::span<const RingEdge> ring, const std::function<bool(Vec2)>& allowed, Vec2& place) {
  const auto good = [&](Vec2 p) { return all_positive(ring, p) && (!allowed || allowed(p)); };
  double weight = 0;
  place = {};
  for (const RingEdge& e : ring) {
    const Guess g = guess(e);
    weight += g.weight, place = place + g.weight * g.apex;
  }
  if (weight > 0) place = (1 / weight) * place;
  if (!(weight > 0) || !good(place)) {
    if (!(middle_of_kernel(ring, false, place) && good(place)) && !(middle_of_kernel(ring, true, place) && good(place)))
      return false;
  }
  const Vec2 edge = ring.front().to - ring.front().from;
  std::vector<CornerView> views;
  for (int i = 0; i < k_place_steps; ++i) {
    views.clear();
    for (const RingEdge& e : ring) views.push_back(corner_view(e.rest, 0, e.from - place, e.to - place));
    const Vec2 step = corner_step(views);
    if (allowed && !allowed(place + step)) break;
    place = place + step;
    if (dot(step, step) < k_small_move * k_small_move * dot(edge, edge)) break;
  }
  return true;
}

class Multilevel {
 public:
  Multilevel(const ChartSurface& chart, const MultilevelOptions& options)
      : chart_(chart),
        options_(options),
        hierarchy_(chart.positions, chart.triangles, k_base_vertices),
        base_removed_(hierarchy_.removed_count()),
        uv_(chart.positions.size()),
        least_edge_(least_edge(chart.positions, chart.triangles)) {}

  bool run() {
    while (!run_from_current()) {
      // A finer start has more room.
      while (hierarchy_.removed_count() < base_removed_) hierarchy_.remove_again();
      if (base_removed_ == 0 || options_.deadline.passed()) return false;
      const std::size_t enough = k_growth * hierarchy_.vertex_count();
      while (hierarchy_.removed_count() > 0 && hierarchy_.vertex_count() < enough) hierarchy_.restore();
      base_removed_ = hierarchy_.removed_count();
    }
    return true;
  }

  MultilevelMap result() { return std::move(result_); }

 private:
  /// Tutte's map of the chart as coarse as it is now. @return whether it has one.
  bool start_on_circle(MapLevel& level) {
    result_ = {};
    level = make_level();
    level.uv = map_to_circle(level, chart_.positions);
    if (!std::isfinite(energy_of(level))) return false;
    store_uv(level);
    return true;
  }

  void set_vertex_count(std::size_t vertices) {
    while (hierarchy_.vertex_count() > vertices) hierarchy_.remove_again();
    while (hierarchy_.removed_count() > 0 && hierarchy_.vertex_count() < vertices) hierarchy_.restore();
  }

  /// Puts a finer beginning into the place of the coarsest level, unless none is any good.
  /// @param level the coarsest one, improved; the finer one, improved, on return.
  /// @param beginning gets the finer one as it was before.
  void start_finer(MapLevel& level, MapLevel& beginning) {
    const double coarsest = mean_energy_;
    for (std::size_t vertices = k_deep_base_vertices; vertices >= 2 * level.vertices.size(); vertices /= 2) {
      set_vertex_count(vertices);
      MapLevel finer;
      if (!start_on_circle(finer)) continue;
      MapLevel improved = finer;
      minimise(improved);
      if (!(mean_energy_ < k_much_worse * coarsest)) continue;
      beginning = std::move(finer);
      level = std::move(improved);
      return;
    }
    set_vertex_count(level.vertices.size());
    result_ = {};
    mean_energy_ = coarsest;
  }

  /// Begins with the whole chart as one tube, unless it has several ends or that has failed.
  /// @param level the coarsest one, improved; the whole one, improved, on return.
  bool start_as_tube(MapLevel& level) {
    set_vertex_count(k_deep_base_vertices);
    if (has_one_end(make_level(), chart_.positions)) {
      set_vertex_count(options_.newton_vertices);
      MapLevel whole = make_level();
      if (widen_tube(whole) && energy_of(whole) < k_much_worse * mean_energy_ * whole.area) {
        level = std::move(whole);
        store_uv(level);
        is_tube_ = true;
        minimise(level);
        is_tube_ = false;
        return true;
      }
    }
    set_vertex_count(level.vertices.size());
    return false;
  }

  /// Radii r, as parts of the largest one, become r^1.5 as long as that lowers the energy: they begin as √z on a tube
  /// of height z, and should end near z.
  void steepen_radii(MapLevel& level) const {
    const auto squared = [](Vec2 p) { return dot(p, p); };
    double most = 0;
    for (const Vec2 p : level.uv) most = std::max(most, squared(p));
    for (double energy = energy_of(level);;) {
      MapLevel steeper = level;
      for (Vec2& p : steeper.uv) p = std::sqrt(std::sqrt(squared(p) / most)) * p;
      const double next = energy_of(steeper);
      if (!(next < energy)) return;
      energy = next;
      level.uv = std::move(steeper.uv);
    }
  }

  /// Maps a level as a tube and minimises the energy over the radii of its rings. @return whether that is possible.
  bool widen_tube(MapLevel& level) const {
    std::optional<TubeMap> tube = map_tube(level, chart_.positions);
    if (!tube) return false;
    level.uv = std::move(tube->uv);
    if (!std::isfinite(energy_of(level))) return false;
    steepen_radii(level);
    const SymmetricDirichlet energy(level.rest);
    DescentOptions descent;
    descent.tolerance = k_coarse_tolerance;
    descent.of_logarithm = true;
    descend_by_rings({level.triangles, &energy, nullptr}, tube->rings, level.uv, descent);
    return true;
  }

  /// From Tutte's map of the chart as coarse as it is now.
  bool run_from_current() {
    guarded_ = false;
    MapLevel level;
    if (!start_on_circle(level)) return fail("Tutte's map of the coarsened chart is not valid");
    std::vector<MapLevel> left_alone{level};  // levels before the border was watched
    for (bool first = true;; first = false) {
      if (options_.deadline.passed() && hierarchy_.removed_count() > 0) return fail(k_no_time);
      minimise(level);
      if (first && is_deep() && !start_as_tube(level)) start_finer(level, left_alone.front());
      if (is_hopeless(level)) {
        if (leave_unfinished(level)) return true;
        gives_up_ = false;
        while (hierarchy_.removed_count() < base_removed_) hierarchy_.remove_again();
        return run_from_current();
      }
      if (gives_up_ && hierarchy_.removed_count() == 0 && is_above_limit(level)) return leave(level);
      std::string why = "the chart overlaps itself";
      if (is_simple(level)) {
        store_uv(level);
        tell(hierarchy_.removed_count() == 0 ? 1 : k_share_of_levels);
        if (hierarchy_.removed_count() == 0) break;
        if (!guarded_) left_alone.push_back(level);
        if (refine(level)) continue;
        why = "vertices have no room in the coarser map";
      }
      // Most charts do not overlap themselves when left alone, and are done faster so; this one is watched from the
      // level before on, and where that has no room, from an earlier one.
      if (left_alone.empty()) return fail(std::move(why));
      guarded_ = true;
      result_ = {};
      level = std::move(left_alone.back());
      left_alone.pop_back();
      while (hierarchy_.vertex_count() > level.vertices.size()) hierarchy_.remove_again();
      store_uv(level);
    }
    result_.uv = uv_;
    return true;
  }

  bool is_above_limit(const MapLevel& level) const { return energy_of(level) > options_.give_up_energy * level.area; }

  /// By a level that is coarser than the chart.
  bool is_hopeless(const MapLevel& level) const {
    const std::size_t vertices = level.vertices.size();
    if (!gives_up_ || hierarchy_.removed_count() == 0 || vertices < k_hinting_vertices) return false;
    if (static_cast<double>(vertices) < k_telling_part * static_cast<double>(all_vertices())) return false;
    const double most = vertices < k_telling_vertices ? k_hopeless_hint : k_hopeless;
    return mean_energy_ - 4 > most * (options_.give_up_energy - 4);
  }

  /// Puts the vertices that are missing to where their rings want them, whatever the border does.
  /// @return false when that is not possible, or gives a map that is not to be given up.
  bool leave_unfinished(MapLevel& level) {
    store_uv(level);
    guarded_ = false;
    guard_.reset();
    if (!insert_down_to(0, least_area(true))) return false;
    level = make_level();
    relax(level, k_guarded_sweeps, k_relax_tolerance, false);
    restore_slivers(level, false);
    add_trace_sample(level, true);
    return is_above_limit(level) && leave(level);
  }

  bool leave(const MapLevel& level) {
    store_uv(level);
    result_.uv = uv_;
    result_.given_up = true;
    return true;
  }

  bool fail(std::string why) {
    result_.failure = std::move(why);
    return false;
  }

  MapLevel make_level() const {
    return current_level(hierarchy_, chart_.positions, uv_, least_area(hierarchy_.removed_count() == 0));
  }

  /// @param last for the whole chart: of slivers alone.
  LeastArea least_area(bool last) const {
    const auto [area, count] = sum_over(hierarchy_.triangles().size(), [&](std::size_t t) {
      if (!hierarchy_.alive(static_cast<Index>(t))) return Vec2{};
      const Triangle& c = hierarchy_.triangles()[t];
      return Vec2{0.5 * norm(cross(chart_.positions[c[1]] - chart_.positions[c[0]],
                                   chart_.positions[c[2]] - chart_.positions[c[0]])),
                  1};
    });
    return {k_least_area * area / count, last ? k_sliver : std::numeric_limits<double>::infinity()};
  }

  double energy_of(const MapLevel& level) const {
    const SymmetricDirichlet energy(level.rest);
    return total_energy({level.triangles, &energy, nullptr}, level.uv);
  }

  bool is_deep() const { return mean_energy_ > k_deep_energy; }

  static bool is_simple(const MapLevel& level) { return barrier_of(level).is_simple(level.uv); }

  void minimise(MapLevel& level) {
    const bool last = hierarchy_.removed_count() == 0, factored = level.vertices.size() <= options_.newton_vertices;
    add_trace_sample(level, last);
    if (last && factored && options_.only_when_rough && level.slivers.empty() &&
        energy_of(level) <= k_smooth * mean_energy_ * level.area)
      return;
    const int sweeps = guarded_ ? k_guarded_sweeps : k_relax_sweeps;
    const bool well_relaxed = last && (!factored || !level.slivers.empty() || counts_down());
    const double relax_tolerance = well_relaxed ? 0.1 * options_.tolerance : k_relax_tolerance;
    relax(level, last && !factored ? k_fine_sweeps : sweeps, relax_tolerance, guarded_);
    if (last) restore_slivers(level, guarded_);
    if (last) tell(k_share_before_newton);
    add_trace_sample(level, last);
    if (!factored || (last && options_.max_iterations == 0)) return;
    const SymmetricDirichlet dirichlet(level.rest);
    DescentOptions descent;
    descent.max_iterations = last ? options_.max_iterations : k_coarse_iterations;
    descent.tolerance = last ? options_.tolerance : k_coarse_tolerance;
    if (is_deep() && !last) descent.tolerance = k_deep_tolerance;
    if (is_tube_) descent.least_iterations = std::min(k_tube_iterations, descent.max_iterations);
    descent.of_logarithm = !guarded_;  // the barrier counts in the slope alone
    descent.foresee = last;
    if (last && gives_up_) descent.give_up_energy = options_.give_up_energy * level.area;
    for (int i = 0; i <= k_most_unblocked; ++i) {
      if (i > 0) relax(level, sweeps, k_relax_tolerance, guarded_);
      descent.leave_when_blocked = i < k_most_unblocked;
      descent.deadline = options_.deadline;
      const double begin = clock_.seconds();
      const BorderBarrier barrier = barrier_of(level);
      const DescentResult result =
          descend({level.triangles, &dirichlet, guarded_ ? &barrier : nullptr}, level.uv, descent);
      mean_energy_ = result.energy / level.area;
      if (last) {
        result_.stop = result.stop;
        for (std::size_t k = 1; k < result.trace.size(); ++k)
          result_.trace.push_back({begin + result.trace[k].seconds, result.trace[k].error / level.area});
      }
      descent.max_iterations -= result.iterations;
      if (!guarded_ || result.stop != StopReason::line_search_stalled || descent.max_iterations == 0) break;
    }
  }

  /// @param share  of the time, about, that it takes until here when all vertices are back.
  void tell(double share) const {
    const auto back = static_cast<double>(hierarchy_.vertex_count());
    if (options_.progress) options_.progress(share * back / (back + static_cast<double>(hierarchy_.removed_count())));
  }

  void add_trace_sample(const MapLevel& level, bool last) {
    if (last) result_.trace.push_back({clock_.seconds(), energy_of(level) / level.area});
  }

  void store_uv(const MapLevel& level) {
    for (std::size_t i = 0; i < level.vertices.size(); ++i) uv_[level.vertices[i]] = level.uv[i];
  }

  std::size_t all_vertices() const { return hierarchy_.removed_count() + hierarchy_.vertex_count(); }

  /// Whether levels are counted from the finest one on, so that the dearest step is a full one.
  bool counts_down() const { return all_vertices() >= k_counted_down; }

  /// How many the next level has.
  std::size_t next_vertices(std::size_t growth) const {
    const std::size_t all = all_vertices(), present = hierarchy_.vertex_count();
    if (!counts_down()) return 2 * all < 3 * growth * present ? all : growth * present;
    std::size_t next = all;
    while (2 * next > 3 * growth * present) next /= growth;
    return next;
  }

  /// Inserts removed vertices until there are next_vertices(), or the next one has no valid place.
  bool refine(MapLevel& level) {
    const std::size_t before = hierarchy_.removed_count();
    const std::size_t growth = guarded_ ? k_guarded_growth : is_deep() ? k_deep_growth : k_growth;
    const std::size_t leave = all_vertices() - next_vertices(growth);
    LeastArea least = least_area(leave == 0);
    least.area /= static_cast<double>(growth);
    guard_.reset();
    if (guarded_) {
      std::vector<BorderPair> border = level.border;
      for (BorderPair& pair : border) pair = {level.vertices[pair[0]], level.vertices[pair[1]]};
      guard_.emplace(std::move(border), uv_);
    }
    insert_down_to(leave, least);
    if (hierarchy_.removed_count() == before) return false;
    level = make_level();
    return true;
  }

  /// Inserts removed vertices until `leave` are missing or the next one has no valid place, which is said. Those that
  /// don't touch one another are placed in parallel while the border is not watched.
  bool insert_down_to(std::size_t leave, LeastArea least_area) {
    while (hierarchy_.removed_count() > leave) {
      const std::size_t missing = hierarchy_.removed_count() - leave;
      const std::span<const Removal> back = hierarchy_.restore(guard_ ? 1 : std::min(hierarchy_.apart(), missing));
      std::atomic<std::size_t> refused = 0;  // The first ones of `back`, which come back last.
      const auto place = [&](const auto& range) {
        std::vector<RingEdge> ring;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          if (insert(back[i], least_area, ring)) continue;
          std::size_t known = refused;
          while (known < i + 1 && !refused.compare_exchange_weak(known, i + 1)) {
          }
        }
      };
      oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, back.size(), k_together), place);
      for (std::size_t i = 0; i < refused; ++i) hierarchy_.remove_again();
      if (refused > 0) return false;
    }
    return true;
  }

  /// Puts a vertex that has its triangles again into its ring.
  bool insert(const Removal& removal, LeastArea least_area, std::vector<RingEdge>& ring) {
    ring.clear();
    Index first = ~Index{0}, last = first;
    for (const Index t : hierarchy_.around(removal)) {
      const Triangle& c = hierarchy_.triangles()[t];
      const std::size_t k = c[0] == removal.vertex ? 0 : c[1] == removal.vertex ? 1 : 2;
      const Index a = c[(k + 1) % 3], b = c[(k + 2) % 3];
      if (ring.empty()) first = a;
      last = b;
      ring.push_back({uv_[a], uv_[b],
                      rest_shape(chart_.positions[removal.vertex], chart_.positions[a], chart_.positions[b],
                                 least_edge_, least_area)});
    }
    Vec2& place = uv_[removal.vertex];
    if (!guard_ || first == last) return place_in_ring(ring, {}, place);
    // The border ran from the ring's last vertex to its first one.
    const auto free = [&](Vec2 p) { return guard_->may_split(last, first, removal.vertex, p); };
    if (!place_in_ring(ring, free, place)) return false;
    guard_->split(last, first, removal.vertex, place);
    return true;
  }

  const ChartSurface& chart_;
  const MultilevelOptions& options_;
  Stopwatch clock_;
  DiskHierarchy hierarchy_;
  std::size_t base_removed_;  ///< What is removed where the map began.
  std::vector<Vec2> uv_;
  double least_edge_;
  bool is_tube_ = false;  ///< The level began as one.
  bool gives_up_ = std::isfinite(options_.give_up_energy);
  bool guarded_ = false;    ///< The border is kept from running into itself.
  double mean_energy_ = 0;  ///< Per area, of the level before.
  std::optional<BorderGuard> guard_;
  MultilevelMap result_;
};

}  // namespace

MultilevelMap map_multilevel(const ChartSurface& chart, const MultilevelOptions& options) {
  const auto from_nothing = [&] {
    Multilevel multilevel(chart, options);
    multilevel.run();
    return multilevel.result();
  };
  std::optional<MultilevelMap> nearby;
  if (!chart.nearby.empty()) nearby = map_nearby(chart, options);
  MultilevelMap map = nearby ? std::move(*nearby) : from_nothing();
  if (map.failure.empty() && !map.trace.empty() && map.trace.back().error > options.energy_limit)
    map.failure = "its mean symmetric Dirichlet energy is " + std::to_string(map.trace.back().error);
  return map;
}

}  // namespace papilla::param_detail
