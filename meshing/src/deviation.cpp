// SPDX-License-Identifier: MIT
#include "papilla/meshing/deviation.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "check_mesh.hpp"
#include "convex_piece.hpp"
#include "one_sided_deviation.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "triangle_bvh.hpp"

namespace papilla {
namespace {

using detail::ClosestPoint;
using detail::ConvexPiece;
using detail::TriangleBvh;
using detail::TriangleFrame;

constexpr std::size_t k_chunk = 1024;  ///< Fixed, so that results don't depend on the number of threads.

void check(const DeviationOptions& o) {
  if (!(o.relative_tolerance >= 0) || std::isnan(o.absolute_tolerance_mm) || !(o.settled_below_mm >= 0) ||
      !(o.list_above_mm >= 0))
    throw InvalidInput("surface_deviation: an option is negative or not a number");
  if (o.settled_below_mm > o.list_above_mm)
    throw InvalidInput("surface_deviation: options.settled_below_mm exceeds list_above_mm");
}

/// Closest point of p, starting from a triangle that is probably near; k_no_value: no idea.
ClosestPoint closest_from(const TriangleBvh& bvh, const Vec3& p, Index hint, double enough = 0) noexcept {
  return bvh.closest(
      p, hint == k_no_value ? ClosestPoint{} : ClosestPoint{detail::squared_distance(p, bvh.frame(hint)), hint},
      enough);
}

/// Squared distances up to this need no closer point while settling against `floor`: a thousandth of it.
double near_enough(double floor) noexcept { return 1e-6 * floor * floor; }

/// The largest distance met and where.
struct Peak {
  double value = -1;
  Vec3 at;
  Index triangle = k_no_value, nearest_triangle = k_no_value;
  void note(double d, const Vec3& p, Index from_triangle, Index to_triangle) noexcept {
    if (d > value) *this = {d, p, from_triangle, to_triangle};
  }
  void note(const Peak& other) noexcept {
    if (other.value > value) *this = other;
  }
};

double farthest_corner(const ConvexPiece& piece, const Vec3& p) noexcept {
  double best = 0;
  for (const Vec3& v : piece.corners()) best = std::max(best, dot(v - p, v - p));
  return std::sqrt(best);
}

/// Bounds the distances of one triangle's points by cutting it to pieces.
class TriangleRefiner {
 public:
  TriangleRefiner(const TriangleBvh& to, double floor, const DeviationOptions& options)
      : to_(to),
        options_(options),
        floor_(floor),
        most_pieces_(options.pieces_per_triangle + k_pieces_per_overlap * to.size()) {}

  struct Outcome {
    double bound = 0;
    bool settled = true;
  };

  /// @param nearest Triangles of `to` closest to the three corners. @param known The maximum met anywhere so far.
  Outcome refine(const std::array<Vec3, 3>& corner, const std::array<Index, 3>& nearest, double known, Index triangle,
                 Peak& peak) {
    Outcome outcome;
    Index hint = nearest[0];
    double bound = std::numeric_limits<double>::infinity();
    const ConvexPiece whole(corner[0], corner[1], corner[2]);
    for (const Index candidate : nearest) {
      const double b = distance_bound(whole, candidate);
      if (b < bound) {
        bound = b;
        hint = candidate;
      }
    }
    known_ = known;
    local_ = 0;
    triangle_ = triangle;
    peak_ = &peak;
    if (bound > limit())
      for (std::size_t k = 0; k < 3; ++k) measure(corner[k], nearest[k]);
    pending_.clear();
    pending_.push_back({whole, bound, hint});
    for (std::size_t pieces = 0; !pending_.empty();) {
      std::pop_heap(pending_.begin(), pending_.end(), bound_less);
      const Pending next = pending_.back();
      pending_.pop_back();
      if (next.bound <= limit())
        outcome.bound = std::max(outcome.bound, next.bound);
      else if (++pieces > most_pieces_ || !divide(next, outcome.bound)) {
        outcome.bound = std::max(outcome.bound, next.bound);
        outcome.settled = false;
      }
    }
    return outcome;
  }

 private:
  static constexpr std::size_t k_pieces_per_overlap =
      32;  ///< Cuts of a triangle that overlaps all of `to` are not too many.

  struct Pending {
    ConvexPiece piece;
    double bound;
    Index hint;  ///< A triangle of `to` near it.
  };

  /// Pieces bounded by this need no further look.
  double limit() const noexcept {
    if (local_ > options_.list_above_mm) return std::numeric_limits<double>::infinity();
    const double known = std::max(known_, local_);
    if (known <= floor_) return floor_;  // Whether anything exceeds it is still open: a share of it more would not do.
    return std::min((1 + options_.relative_tolerance) * known, options_.list_above_mm);
  }

  double distance_bound(const ConvexPiece& piece, Index to_triangle) const noexcept {
    double bound = 0;
    for (const Vec3& v : piece.corners()) bound = std::max(bound, detail::squared_distance(v, to_.frame(to_triangle)));
    return std::sqrt(bound);
  }

  ClosestPoint measure(const Vec3& p, Index hint) {
    const ClosestPoint found = closest_from(to_, p, hint, near_enough(floor_));
    const double d = std::sqrt(found.squared_distance);
    local_ = std::max(local_, d);
    peak_->note(d, p, triangle_, found.triangle);
    return found;
  }

  /// Bounds the piece from its centre and, where that is not enough, cuts it; false when rounding forbids a cut.
  bool divide(const Pending& whole, double& settled_bound) {
    const Vec3 centre = whole.piece.centre();
    const ClosestPoint found = measure(centre, whole.hint);
    const double extent = farthest_corner(whole.piece, centre);
    const double bound = std::min(
        {whole.bound, std::sqrt(found.squared_distance) + extent, distance_bound(whole.piece, found.triangle)});
    if (bound <= limit()) {
      settled_bound = std::max(settled_bound, bound);
      return true;
    }
    const Pending next{whole.piece, bound, found.triangle};
    return cut_along_prism(next) || cut_off_near(next) || halve(next, centre);
  }

  static bool bound_less(const Pending& a, const Pending& b) noexcept { return a.bound < b.bound; }

  void pend(const Pending& piece) {
    pending_.push_back(piece);
    std::push_heap(pending_.begin(), pending_.end(), bound_less);
  }

  void push(const ConvexPiece& piece, double bound, Index hint) {
    constexpr std::size_t k_most_corners = 8;  // three cuts add at most three corners
    if (piece.size() <= k_most_corners) {
      pend({piece, bound, hint});
      return;
    }
    ConvexPiece first, second;
    const std::size_t middle = piece.size() / 2;
    for (std::size_t i = 0; i <= middle; ++i) first.add(piece[i]);
    for (std::size_t i = middle; i < piece.size(); ++i) second.add(piece[i]);
    second.add(piece[0]);
    pend({first, bound, hint});
    pend({second, bound, hint});
  }

  /// Cuts along the planes through the edges of the closest triangle, upright on it. Inside, the distance to it is
  /// a linear height, so its bound there is exact for that triangle. Slices thinner than a hundredth of the piece are
  /// not cut off: two triangles nearly as close could take such slices from each other for ever.
  bool cut_along_prism(const Pending& whole) {
    const TriangleFrame& frame = to_.frame(whole.hint);
    if (frame.thin) return false;
    const Vec3 normal = cross(frame.ab, frame.ac);
    const std::array<Vec3, 3> origin{frame.a, frame.a + frame.ab, frame.a + frame.ac};
    const std::array<Vec3, 3> edge{frame.ab, frame.ac - frame.ab, -frame.ac};
    std::array<ConvexPiece, 3> outside;
    ConvexPiece inside = whole.piece;
    bool is_cut = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 outwards = cross(edge[k], normal);
      const auto halves = inside.cut(origin[k], outwards, least_slice(inside, origin[k], outwards, norm(edge[k])));
      if (halves.behind.size() == 0) return false;
      is_cut |= halves.ahead.size() > 0;
      outside[k] = halves.ahead;
      inside = halves.behind;
    }
    if (!is_cut) return false;
    for (const ConvexPiece& piece : outside)
      if (piece.size() > 0) push(piece, whole.bound, whole.hint);
    push_inside(inside, whole);
    return true;
  }

  /// The slack of ConvexPiece::cut() with which a thin slice ahead stays, while a thin one behind is no hindrance.
  static double least_slice(const ConvexPiece& piece, const Vec3& origin, const Vec3& outwards, double edge) noexcept {
    constexpr double k_rounding = 1e-12;  // of the edge
    constexpr double k_thinnest = 1e-3;   // of the piece
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& v : piece.corners()) {
      const double height = dot(v - origin, outwards);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return std::max(k_rounding * edge * norm(outwards), std::min(k_thinnest * (high - low), -0.5 * low));
  }

  /// Takes the distance at the farthest corner at once: mostly that is the piece's maximum.
  void push_inside(const ConvexPiece& inside, const Pending& whole) {
    Vec3 farthest = inside[0];
    double bound = -1;
    for (const Vec3& v : inside.corners()) {
      const double d = detail::squared_distance(v, to_.frame(whole.hint));
      if (d > bound) {
        bound = d;
        farthest = v;
      }
    }
    bound = std::min(std::sqrt(bound), whole.bound);
    const Index hint = bound > limit() ? measure(farthest, whole.hint).triangle : whole.hint;
    push(inside, bound, hint);
  }

  /// Cuts off what lies beside the closest triangle within the limit. On both sides of the middle of a gap between two
  /// triangles each covers its side so, where halves would have to become as short as the gap is wide.
  bool cut_off_near(const Pending& whole) {
    constexpr double k_least_share = 0.1;    // of the piece's extent away from the triangle
    constexpr double k_within_limit = 0.99;  // so that rounding does not leave the near piece above it
    const TriangleFrame& frame = to_.frame(whole.hint);
    Vec3 away;
    double farthest = 0;
    for (const Vec3& v : whole.piece.corners()) {
      const Vec3 d = v - closest_on_triangle(v, frame);
      if (dot(d, d) > farthest) {
        farthest = dot(d, d);
        away = d;
      }
    }
    farthest = std::sqrt(farthest);
    if (!(farthest > limit())) return false;
    const Vec3 direction = normalized(away);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& v : whole.piece.corners()) {
      low = std::min(low, dot(v, direction));
      high = std::max(high, dot(v, direction));
    }
    const double level = high - farthest + k_within_limit * limit();
    if (!(level - low >= k_least_share * (high - low))) return false;
    const auto halves = whole.piece.cut(level * direction, direction, 0);
    if (halves.behind.size() == 0 || halves.ahead.size() == 0) return false;
    push(halves.behind, std::min(whole.bound, distance_bound(halves.behind, whole.hint)), whole.hint);
    push(halves.ahead, whole.bound, whole.hint);
    return true;
  }

  bool halve(const Pending& whole, const Vec3& centre) {
    Vec3 longest;
    for (std::size_t i = 0; i < whole.piece.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 d = whole.piece[i] - whole.piece[j];
        if (dot(d, d) > dot(longest, longest)) longest = d;
      }
    const auto halves = whole.piece.cut(centre, longest, 0);
    if (halves.behind.size() == 0 || halves.ahead.size() == 0) return false;
    push(halves.behind, whole.bound, whole.hint);
    push(halves.ahead, whole.bound, whole.hint);
    return true;
  }

  const TriangleBvh& to_;
  const DeviationOptions& options_;
  double floor_;
  std::size_t most_pieces_;
  double known_ = 0, local_ = 0;
  Index triangle_ = 0;
  Peak* peak_ = nullptr;
  std::vector<Pending> pending_;  ///< A heap: the largest bound first, so that what is left at the limit is small.
};

/// The distances of one surface to another, step by step.
class OneSide {
 public:
  OneSide(const TriangleMesh& from, const TriangleBvh& to, double floor, const DeviationOptions& options)
      : from_(from),
        to_(to),
        floor_(floor),
        options_(options),
        done_(options.progress, "measure",
              static_cast<double>((options.settled_below_mm > 0 ? 1 : 0) + (options.mean_samples > 0 ? 1 : 0) + 1) *
                      static_cast<double>(from.triangles.size()) +
                  static_cast<double>(from.positions.size())) {}

  OneSidedDeviation run() {
    settle_at_once();
    measure_corners();
    if (options_.mean_samples > 0) sample_areas();
    bound_triangles();
    if (peak_.triangle == k_no_value) return std::move(result_);
    result_.value = peak_.value;
    result_.bound = std::max(result_.bound, peak_.value);
    result_.at = peak_.at;
    result_.triangle = peak_.triangle;
    result_.nearest = closest_on_triangle(peak_.at, to_.frame(peak_.nearest_triangle));
    return std::move(result_);
  }

 private:
  template <class Body>
  void for_each_chunk(std::size_t count, const Body& body) {
    const std::size_t chunks = (count + k_chunk - 1) / k_chunk;
    oneapi::tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
      const std::size_t begin = chunk * k_chunk, end = std::min(count, begin + k_chunk);
      body(chunk, begin, end);
      done_.add(static_cast<double>(end - begin));
    });
  }

  /// Settles what a triangle of `to` near the neighbour is near enough to, without a search.
  void settle_at_once() {
    settled_.assign(from_.triangles.size(), 0);
    if (!(options_.settled_below_mm > 0)) return;
    std::vector<double> bounds((from_.triangles.size() + k_chunk - 1) / k_chunk, 0);
    for_each_chunk(from_.triangles.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Index hint = k_no_value;
      for (std::size_t t = begin; t < end; ++t) {
        double bound = hint == k_no_value ? std::numeric_limits<double>::infinity() : corner_bound(t, hint);
        if (!(bound <= floor_)) {
          hint = closest_from(to_, (1.0 / 3) * (from_.corner(t, 0) + from_.corner(t, 1) + from_.corner(t, 2)), hint,
                              near_enough(floor_))
                     .triangle;
          bound = corner_bound(t, hint);
        }
        settled_[t] = bound <= floor_;
        if (settled_[t]) bounds[chunk] = std::max(bounds[chunk], bound);
      }
    });
    for (const double bound : bounds) result_.bound = std::max(result_.bound, bound);
  }

  double corner_bound(std::size_t t, Index to_triangle) const noexcept {
    double bound = 0;
    for (int k = 0; k < 3; ++k)
      bound = std::max(bound, detail::squared_distance(from_.corner(t, k), to_.frame(to_triangle)));
    return std::sqrt(bound);
  }

  void measure_corners() {
    std::vector<Index> triangle_at(from_.positions.size(), k_no_value);
    for (Index t = 0; t < from_.triangles.size(); ++t)
      if (!settled_[t])
        for (const Index v : from_.triangles[t]) triangle_at[v] = t;
    nearest_.assign(from_.positions.size(), k_no_value);
    std::vector<Peak> peaks((from_.positions.size() + k_chunk - 1) / k_chunk);
    for_each_chunk(from_.positions.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Index hint = k_no_value;
      for (std::size_t v = begin; v < end; ++v) {
        if (triangle_at[v] == k_no_value) continue;
        const ClosestPoint found = closest_from(to_, from_.positions[v], hint, near_enough(floor_));
        nearest_[v] = hint = found.triangle;
        peaks[chunk].note(std::sqrt(found.squared_distance), from_.positions[v], triangle_at[v], found.triangle);
      }
    });
    for (const Peak& peak : peaks) peak_.note(peak);
  }

  double area(std::size_t t) const {
    return 0.5 * norm(cross(from_.corner(t, 1) - from_.corner(t, 0), from_.corner(t, 2) - from_.corner(t, 0)));
  }

  /// Midpoint rule on a regular subdivision of each triangle into samples of about equal area.
  void sample_areas() {
    double total = 0;
    for (std::size_t t = 0; t < from_.triangles.size(); ++t) total += area(t);
    const double per_sample = total / static_cast<double>(std::max<std::uint64_t>(options_.mean_samples, 1));
    struct Sums {
      double weighted = 0, squares = 0;
      Peak peak;
    };
    std::vector<Sums> sums((from_.triangles.size() + k_chunk - 1) / k_chunk);
    for_each_chunk(from_.triangles.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Index hint = k_no_value;
      for (std::size_t t = begin; t < end; ++t) {
        const double triangle_area = area(t);
        const double rows = per_sample > 0 ? std::ceil(std::sqrt(triangle_area / per_sample)) : 1;
        const auto n = static_cast<int>(std::clamp(rows, 1.0, 2000.0));
        const Vec3 a = from_.corner(t, 0), ab = (1.0 / n) * (from_.corner(t, 1) - a),
                   ac = (1.0 / n) * (from_.corner(t, 2) - a);
        double sum = 0, squares = 0;
        const auto sample = [&](double i, double j) {
          const Vec3 p = a + i * ab + j * ac;
          const ClosestPoint found = closest_from(to_, p, hint);
          hint = found.triangle;
          const double d = std::sqrt(found.squared_distance);
          sum += d;
          squares += found.squared_distance;
          sums[chunk].peak.note(d, p, static_cast<Index>(t), found.triangle);
        };
        for (int i = 0; i < n; ++i)
          for (int j = 0; i + j < n; ++j) {
            sample(i + 1.0 / 3, j + 1.0 / 3);
            if (i + j + 1 < n) sample(i + 2.0 / 3, j + 2.0 / 3);
          }
        const double weight = triangle_area / (static_cast<double>(n) * n);
        sums[chunk].weighted += weight * sum;
        sums[chunk].squares += weight * squares;
      }
    });
    double squares = 0;
    for (const Sums& s : sums) {
      result_.mean += s.weighted;
      squares += s.squares;
      peak_.note(s.peak);
    }
    if (total > 0) {
      result_.mean /= total;
      result_.rms = std::sqrt(squares / total);
    }
  }

  void bound_triangles() {
    struct Part {
      double bound = 0;
      std::uint64_t unsettled = 0;
      std::vector<ExceedingTriangle> above;
      Peak peak;
    };
    std::vector<Part> parts((from_.triangles.size() + k_chunk - 1) / k_chunk);
    const double known = peak_.value;
    for_each_chunk(from_.triangles.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Part& part = parts[chunk];
      TriangleRefiner refiner(to_, floor_, options_);
      for (std::size_t t = begin; t < end; ++t) {
        if (settled_[t]) continue;
        const Triangle& v = from_.triangles[t];
        Peak peak;
        const auto outcome =
            refiner.refine({from_.positions[v[0]], from_.positions[v[1]], from_.positions[v[2]]},
                           {nearest_[v[0]], nearest_[v[1]], nearest_[v[2]]}, known, static_cast<Index>(t), peak);
        part.peak.note(peak);
        part.bound = std::max(part.bound, outcome.bound);
        part.unsettled += outcome.settled ? 0 : 1;
        if (outcome.bound > options_.list_above_mm)
          part.above.push_back({static_cast<Index>(t), peak.nearest_triangle, peak.value, peak.at});
      }
    });
    for (const Part& part : parts) {
      result_.bound = std::max(result_.bound, part.bound);
      result_.unsettled += part.unsettled;
      result_.above.insert(result_.above.end(), part.above.begin(), part.above.end());
      peak_.note(part.peak);
    }
  }

  const TriangleMesh& from_;
  const TriangleBvh& to_;
  double floor_;
  const DeviationOptions& options_;
  std::vector<std::uint8_t> settled_;  ///< Per triangle of `from`.
  std::vector<Index> nearest_;         ///< Per position of `from`: the triangle of `to` closest to it.
  Peak peak_;
  SharedProgress done_;
  OneSidedDeviation result_;
};

}  // namespace

OneSidedDeviation detail::one_sided_deviation(const TriangleMesh& from, const TriangleBvh& to, double floor_mm,
                                              const DeviationOptions& options) {
  return OneSide(from, to, floor_mm, options).run();
}

DeviationResult surface_deviation(const TriangleMesh& from, const TriangleMesh& to, const DeviationOptions& options) {
  check(options);
  Bounds3 bounds;
  detail::check_distance_input(from, "surface_deviation: from", bounds);
  detail::check_distance_input(to, "surface_deviation: to", bounds);
  DeviationResult result;
  if (from.triangles.empty() && to.triangles.empty()) return result;
  if (from.triangles.empty() || to.triangles.empty())
    throw InvalidInput("surface_deviation: one of the surfaces has no triangles");

  constexpr double k_default_tolerance = 1e-6;
  const double absolute =
      options.absolute_tolerance_mm < 0 ? k_default_tolerance * bounds.diagonal() : options.absolute_tolerance_mm;
  const double floor = std::max(absolute, options.settled_below_mm);
  result.from_to = OneSide(from, TriangleBvh(to.positions, to.triangles), floor, options).run();
  if (options.two_sided)
    result.to_from = OneSide(to, TriangleBvh(from.positions, from.triangles), floor, options).run();
  return result;
}

}  // namespace papilla
