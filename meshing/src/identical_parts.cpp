// SPDX-License-Identifier: MIT
#include "papilla/meshing/identical_parts.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <tuple>

#include "check_mesh.hpp"
#include "exact_positions.hpp"
#include "mesh_attributes.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/cold_arrays.hpp"
#include "papilla/core/error.hpp"
#include "point_tree.hpp"

namespace papilla {
namespace {

/// p -> rotation p + translation.
struct Motion {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 translation;

  Vec3 turn(const Vec3& v) const noexcept { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vec3 operator()(const Vec3& p) const noexcept { return turn(p) + translation; }
  /// Undoes it.
  Vec3 back(const Vec3& p) const noexcept {
    const Vec3 v = p - translation;
    return v.x * rows[0] + v.y * rows[1] + v.z * rows[2];
  }
};

/// A triangle starting at its smallest place, so that equal ones compare equal whatever corner they start at.
struct CanonicalTriangle {
  Triangle places;
  Index triangle;
  std::uint8_t first;  ///< The corner that comes first in `places`.
  bool operator<(const CanonicalTriangle& other) const noexcept {
    return std::tie(places, triangle) < std::tie(other.places, other.triangle);
  }
};

CanonicalTriangle canonical(const Triangle& t, Index triangle) noexcept {
  const std::size_t first = t[0] < t[1] ? (t[0] < t[2] ? 0 : 2) : (t[1] < t[2] ? 1 : 2);
  return {{t[first], t[(first + 1) % 3], t[(first + 2) % 3]}, triangle, static_cast<std::uint8_t>(first)};
}

/// What does not change when a part is moved, and what comparing needs.
struct Shape {
  const TriangleMesh* mesh = nullptr;
  std::vector<Vec3> places;
  std::vector<Triangle> triangles;  ///< Between places; `sources` are their numbers in the mesh.
  std::vector<Index> sources;
  double area = 0, diagonal = 0;
  Vec3 centre;                                        ///< Of area.
  std::vector<std::pair<double, Index>> by_distance;  ///< Places by their distance from the centre.
  std::vector<double> distance;

  explicit Shape(const TriangleMesh& m) : mesh(&m) {
    const detail::ExactPositions exact = detail::exact_positions(m);
    for (const Index v : exact.first) places.push_back(m.positions[v]);
    Bounds3 bounds;
    for (const Vec3& p : places) bounds.add(p);
    diagonal = bounds.diagonal();
    for (Index t = 0; t < m.triangles.size(); ++t) {
      const Triangle& v = m.triangles[t];
      const Triangle moved{exact.of_position[v[0]], exact.of_position[v[1]], exact.of_position[v[2]]};
      if (detail::repeats_corner(moved)) continue;
      triangles.push_back(moved);
      sources.push_back(t);
    }
    measure();
  }

 private:
  void measure() {
    if (places.empty()) return;
    const Vec3 origin = places[0];
    Vec3 moment;
    for (const Triangle& t : triangles) {
      const Vec3 a = places[t[0]] - origin, b = places[t[1]] - origin, c = places[t[2]] - origin;
      const double twice = norm(cross(b - a, c - a));
      area += twice / 2;
      moment = moment + (twice / 6) * (a + b + c);
    }
    centre = area > 0 ? origin + (1 / area) * moment : origin;
    for (Index i = 0; i < places.size(); ++i) {
      distance.push_back(norm(places[i] - centre));
      by_distance.emplace_back(distance.back(), i);
    }
    std::sort(by_distance.begin(), by_distance.end());
  }
};

/// The places whose distance from the centre is within `tolerance` of `d`.
std::span<const std::pair<double, Index>> shell(const Shape& shape, double d, double tolerance) {
  const auto& list = shape.by_distance;
  const auto begin = std::lower_bound(list.begin(), list.end(), std::pair{d - tolerance, Index{0}});
  const auto end = std::upper_bound(begin, list.end(), std::pair{d + tolerance, k_no_value});
  return {begin, end};
}

/// Two places that fix a frame with the centre, in the smallest shells that stand well off.
struct Anchors {
  Index a = k_no_value, b = k_no_value;
};

Anchors choose_anchors(const Shape& shape, double tolerance) {
  constexpr double k_far = 0.25;  // of the largest distance: nearer ones fix the frame too loosely
  Anchors anchors;
  const auto choose = [&](const auto& reach) {
    double largest = 0;
    for (Index i = 0; i < shape.places.size(); ++i) largest = std::max(largest, reach(i));
    Index best = k_no_value;
    std::size_t best_size = std::numeric_limits<std::size_t>::max();
    for (Index i = 0; i < shape.places.size(); ++i) {
      if (!(reach(i) > k_far * largest)) continue;
      const std::size_t size = shell(shape, shape.distance[i], tolerance).size();
      if (size < best_size || (size == best_size && reach(i) > reach(best))) {
        best = i;
        best_size = size;
      }
    }
    return largest > tolerance ? best : k_no_value;
  };
  anchors.a = choose([&](Index i) { return shape.distance[i]; });
  if (anchors.a == k_no_value) return anchors;
  const Vec3 axis = normalized(shape.places[anchors.a] - shape.centre);
  anchors.b = choose([&](Index i) { return norm(cross(axis, shape.places[i] - shape.centre)); });
  return anchors;
}

/// The rotation and translation that take (centre, a, b) to the same points of another part.
Motion align(const Vec3& centre, const Vec3& a, const Vec3& b, const Vec3& to_centre, const Vec3& to_a,
             const Vec3& to_b) {
  const auto frame = [](const Vec3& x, const Vec3& y) {
    const Vec3 e1 = normalized(x), e3 = normalized(cross(x, y));
    return std::array<Vec3, 3>{e1, cross(e3, e1), e3};
  };
  const auto from = frame(a - centre, b - centre), to = frame(to_a - to_centre, to_b - to_centre);
  const auto row = [&](double Vec3::*axis) {
    return to[0].*axis * from[0] + to[1].*axis * from[1] + to[2].*axis * from[2];
  };
  Motion motion{{row(&Vec3::x), row(&Vec3::y), row(&Vec3::z)}, {}};
  motion.translation = to_centre - motion.turn(centre);
  return motion;
}

template <class T, class Same>
bool same_corners(const CornerAttribute<T>& a, const CornerAttribute<T>& b, Index t, Index u, std::size_t first_t,
                  std::size_t first_u, const Same& same) {
  if (a.empty() != b.empty()) return false;
  if (a.empty()) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Index i = a.indices[t][(first_t + k) % 3], j = b.indices[u][(first_u + k) % 3];
    if ((i == k_no_value) != (j == k_no_value)) return false;
    if (i != k_no_value && !same(a.values[i], b.values[j])) return false;
  }
  return true;
}

bool same_attributes(const TriangleMesh& a, const TriangleMesh& b, const CanonicalTriangle& t,
                     const CanonicalTriangle& u, const Motion& motion) {
  constexpr double k_uv = 1e-6, k_color = 1e-5, k_normal = 1e-3;
  const auto same_uv = [](const Vec2& x, const Vec2& y) { return norm(x - y) <= k_uv * (1 + norm(x)); };
  const auto same_color = [](const Color& x, const Color& y) {
    const auto near = [](float p, float q) { return std::abs(double(p) - double(q)) <= k_color; };
    return near(x.r, y.r) && near(x.g, y.g) && near(x.b, y.b) && near(x.a, y.a);
  };
  const auto same_normal = [&](const Vec3& x, const Vec3& y) { return norm(motion.turn(x) - y) <= k_normal; };
  const auto slot = [](const TriangleMesh& m, Index i) { return m.material.empty() ? 0u : m.material[i]; };
  const auto compare = [&](const auto& x, const auto& y, const auto& same) {
    return same_corners(x, y, t.triangle, u.triangle, t.first, u.first, same);
  };
  return slot(a, t.triangle) == slot(b, u.triangle) && compare(a.uv, b.uv, same_uv) && compare(a.uv1, b.uv1, same_uv) &&
         compare(a.colors, b.colors, same_color) && compare(a.normals, b.normals, same_normal);
}

/// Whether area and distances from the centre let a part be a copy. Ordered by size, the distances of a copy differ by
/// no more than those of corresponding places do.
/// @pre as many places.
bool may_be_copy(const Shape& original, const Shape& part, const IdenticalOptions& options) {
  constexpr double k_slack = 16;  // Of the tolerance: the centres inherit it, weighted by areas that do, too.
  if (std::abs(part.area - original.area) > 4 * options.relative_tolerance * original.area) return false;
  const double most = k_slack * options.relative_tolerance * original.diagonal;
  return std::equal(original.by_distance.begin(), original.by_distance.end(), part.by_distance.begin(),
                    [&](const auto& a, const auto& b) { return std::abs(a.first - b.first) <= most; });
}

std::vector<Index> all_places(const Shape& shape) {
  std::vector<Index> all(shape.places.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// A part that others are compared with.
struct Original {
  Original(const Shape& s, const IdenticalOptions& options)
      : shape(s),
        tolerance(options.relative_tolerance * s.diagonal),
        anchors(choose_anchors(s, tolerance)),
        tree(s.places, all_places(s)) {}

  const Shape& shape;
  double tolerance;
  Anchors anchors;
  detail::PointTree tree;
};

/// Compares an original with one part. @pre it has anchors.
class Comparer {
 public:
  Comparer(const Original& original, const Shape& part, const IdenticalOptions& options)
      : original_(original.shape),
        tolerance_(original.tolerance),
        anchors_(original.anchors),
        tree_(original.tree),
        part_(part),
        options_(options),
        taken_(original_.places.size(), 0),
        place_of_(original_.places.size()) {}

  /// Fills `copy` and returns true when the part is the original moved.
  bool is_copy(PartCopy& copy) {
    if (is_copy_at(anchors_.a, anchors_.b, copy)) return true;

    // The centres and distances inherit the tolerance of the vertices.
    const double slack = 4 * tolerance_;
    const double apart = norm(original_.places[anchors_.a] - original_.places[anchors_.b]);
    const auto near_a = shell(part_, original_.distance[anchors_.a], slack);
    const auto near_b = shell(part_, original_.distance[anchors_.b], slack);
    std::uint64_t pairs = 0;
    constexpr std::uint64_t k_pairs_per_trial = 100;
    for (const auto& [da, a] : near_a)
      for (const auto& [db, b] : near_b) {
        if (++pairs > k_pairs_per_trial * options_.most_trials || trial_ > options_.most_trials) return false;
        if (std::abs(norm(part_.places[a] - part_.places[b]) - apart) > slack) continue;
        if (is_copy_at(a, b, copy)) return true;
      }
    return false;
  }

 private:
  bool is_copy_at(Index a, Index b, PartCopy& copy) {
    ++trial_;
    const Motion motion = align(original_.centre, original_.places[anchors_.a], original_.places[anchors_.b],
                                part_.centre, part_.places[a], part_.places[b]);
    double farthest = 0;
    if (!match_places(motion, farthest) || !match_triangles(motion)) return false;
    copy.max_distance_mm = farthest;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& row = motion.rows[i];
      const Vec3& t = motion.translation;
      const double values[4] = {row.x, row.y, row.z, i == 0 ? t.x : i == 1 ? t.y : t.z};
      std::copy(values, values + 4, copy.motion.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
    return true;
  }

  /// One to one, each within the tolerance.
  bool match_places(const Motion& motion, double& farthest) {
    for (Index i = 0; i < part_.places.size(); ++i) {
      const Vec3 p = motion.back(part_.places[i]);
      double best = tolerance_;
      Index found = k_no_value;
      tree_.near_point(p, tolerance_, [&](Index j, const Vec3&) {
        const double d = norm(original_.places[j] - p);
        if (d <= best && taken_[j] != trial_) {
          best = d;
          found = j;
        }
      });
      if (found == k_no_value) return false;
      taken_[found] = trial_;
      place_of_[found] = i;
      farthest = std::max(farthest, best);
    }
    return true;
  }

  bool match_triangles(const Motion& motion) const {
    std::vector<CanonicalTriangle> ours, theirs;
    for (std::size_t t = 0; t < original_.triangles.size(); ++t) {
      const Triangle& v = original_.triangles[t];
      ours.push_back(canonical({place_of_[v[0]], place_of_[v[1]], place_of_[v[2]]}, original_.sources[t]));
    }
    for (std::size_t t = 0; t < part_.triangles.size(); ++t)
      theirs.push_back(canonical(part_.triangles[t], part_.sources[t]));
    std::sort(ours.begin(), ours.end());
    std::sort(theirs.begin(), theirs.end());
    for (std::size_t t = 0; t < ours.size(); ++t)
      if (ours[t].places != theirs[t].places ||
          (options_.compare_attributes && !same_attributes(*original_.mesh, *part_.mesh, ours[t], theirs[t], motion)))
        return false;
    return true;
  }

  const Shape& original_;
  double tolerance_;
  const Anchors& anchors_;
  const detail::PointTree& tree_;
  const Shape& part_;
  const IdenticalOptions& options_;
  std::vector<std::uint32_t> taken_;  ///< Per place of the original: the trial that took it last.
  std::uint32_t trial_ = 0;
  std::vector<Index> place_of_;  ///< Of the part, per place of the original.
};

/// Compares parts that may be alike: the first that is none's copy is the original of those behind it that are its own.
void compare_group(std::vector<std::uint32_t> left, const std::vector<std::unique_ptr<Shape>>& shapes,
                   const IdenticalOptions& options, std::vector<PartCopy>& copies) {
  for (; !left.empty(); std::erase_if(left, [&](std::uint32_t i) { return copies[i].original != k_no_value; })) {
    const std::uint32_t first = left.front();
    copies[first].original = first;
    std::vector<std::uint32_t> candidates;
    for (std::size_t k = 1; k < left.size(); ++k)
      if (may_be_copy(*shapes[first], *shapes[left[k]], options)) candidates.push_back(left[k]);
    if (candidates.empty()) continue;
    const Original original(*shapes[first], options);
    if (original.anchors.b == k_no_value) continue;
    oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t c) {
      PartCopy& copy = copies[candidates[c]];
      if (Comparer(original, *shapes[candidates[c]], options).is_copy(copy)) copy.original = first;
    });
  }
}

/// @throws InvalidInput naming the first part that has no mesh or one that can't be compared.
void check_parts(std::span<const ComparedPart> parts) {
  std::vector<std::string> faults(parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const std::string name = "find_identical_parts: parts[" + std::to_string(i) + "]";
    try {
      if (parts[i].mesh == nullptr) throw InvalidInput(name + " has no mesh");
      detail::check_mesh(*parts[i].mesh, name);
      Bounds3 bounds;
      detail::check_distance_input(*parts[i].mesh, name + ".mesh", bounds);
    } catch (const InvalidInput& fault) {
      faults[i] = fault.what();
    }
  });
  for (const std::string& fault : faults)
    if (!fault.empty()) throw InvalidInput(fault);
}

}  // namespace

std::vector<PartCopy> find_identical_parts(std::span<const ComparedPart> parts, const IdenticalOptions& options) {
  constexpr double k_loosest = 1e-2;
  if (!(options.relative_tolerance > 0 && options.relative_tolerance <= k_loosest))
    throw InvalidInput("find_identical_parts: options.relative_tolerance is not in (0, 1e-2]");
  check_parts(parts);
  std::vector<std::unique_ptr<Shape>> shapes(parts.size());
  {
    const ColdArrays waiting;
    oneapi::tbb::parallel_for(std::size_t{0}, parts.size(),
                              [&](std::size_t i) { shapes[i] = std::make_unique<Shape>(*parts[i].mesh); });
  }

  using Key = std::tuple<std::uint64_t, std::size_t, std::size_t>;
  std::map<Key, std::vector<std::uint32_t>> by_key;
  for (std::uint32_t i = 0; i < parts.size(); ++i)
    by_key[{parts[i].label, shapes[i]->places.size(), shapes[i]->triangles.size()}].push_back(i);
  std::vector<const std::vector<std::uint32_t>*> groups;
  for (const auto& [key, members] : by_key) groups.push_back(&members);

  std::vector<PartCopy> copies(parts.size());
  for (PartCopy& copy : copies) copy.original = k_no_value;
  oneapi::tbb::parallel_for(std::size_t{0}, groups.size(),
                            [&](std::size_t g) { compare_group(*groups[g], shapes, options, copies); });
  return copies;
}

}  // namespace papilla
