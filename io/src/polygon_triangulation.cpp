// SPDX-License-Identifier: MIT
#include "polygon_triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// Twice the vector area (Newell): the direction from which the polygon turns counter-clockwise.
Vec3 newell_normal(std::span<const Vec3> corners) {
  Vec3 sum;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum = sum + cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return sum;
}

/// The polygon seen along its normal: drops the normal's largest coordinate, keeping the turning direction.
std::vector<Vec2> projected(std::span<const Vec3> corners) {
  const Vec3 n = newell_normal(corners);
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  std::vector<Vec2> result;
  result.reserve(corners.size());
  for (const Vec3& corner : corners) {
    const Vec3 p = corner - corners[0];
    Vec2 q = z >= x && z >= y ? Vec2{p.x, p.y} : x >= y ? Vec2{p.y, p.z} : Vec2{p.z, p.x};
    const double component = z >= x && z >= y ? n.z : x >= y ? n.x : n.y;
    if (component < 0) q = {q.y, q.x};
    result.push_back(q);
  }
  return result;
}

double turn(Vec2 a, Vec2 b, Vec2 c) { return cross(b - a, c - a); }

/// Convex and going round only once: no right turn, and the direction's x changes sign at most twice.
bool is_convex(const std::vector<Vec2>& p) {
  const std::size_t n = p.size();
  int changes = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = p[i], b = p[(i + 1) % n], c = p[(i + 2) % n];
    if (turn(a, b, c) < 0) return false;
    changes += (b.x - a.x > 0) != (c.x - b.x > 0);
  }
  return changes <= 2;
}

/// The polygon that is left while ears are cut off, as a ring of links.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vec2> points) : p_(std::move(points)), next_(p_.size()), previous_(p_.size()) {
    for (std::size_t i = 0; i < p_.size(); ++i) {
      next_[i] = (i + 1) % p_.size();
      previous_[next_[i]] = i;
    }
    for (std::size_t i = 0; i < p_.size(); ++i)
      if (is_reflex(i)) reflex_.push_back(i);
  }

  std::vector<std::array<std::size_t, 3>> run() {
    std::vector<std::array<std::size_t, 3>> triangles;
    std::size_t left = p_.size(), at = 0, rejected = 0;
    while (left > 3) {
      if (rejected < left && !is_ear(at)) {
        at = next_[at];
        ++rejected;
        continue;
      }
      triangles.push_back({previous_[at], at, next_[at]});
      at = cut(at);
      --left;
      rejected = 0;
    }
    triangles.push_back({previous_[at], at, next_[at]});
    return triangles;
  }

 private:
  bool is_reflex(std::size_t i) const { return turn(p_[previous_[i]], p_[i], p_[next_[i]]) <= 0; }

  bool is_ear(std::size_t i) const {
    const Vec2 a = p_[previous_[i]], b = p_[i], c = p_[next_[i]];
    if (turn(a, b, c) <= 0) return false;
    return std::none_of(reflex_.begin(), reflex_.end(), [&](std::size_t r) {
      const Vec2 q = p_[r];
      if (q == a || q == b || q == c) return false;
      return turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0;
    });
  }

  /// Takes a corner out and returns where to go on.
  std::size_t cut(std::size_t i) {
    const std::size_t before = previous_[i], after = next_[i];
    next_[before] = after;
    previous_[after] = before;
    std::erase_if(reflex_, [&](std::size_t r) { return r == i || ((r == before || r == after) && !is_reflex(r)); });
    return after;
  }

  std::vector<Vec2> p_;
  std::vector<std::size_t> next_, previous_, reflex_;
};

std::vector<std::array<std::size_t, 3>> fan(std::size_t corners) {
  std::vector<std::array<std::size_t, 3>> triangles;
  for (std::size_t i = 1; i + 1 < corners; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangulate_polygon(std::span<const Vec3> corners) {
  if (corners.size() == 3) return fan(3);
  std::vector<Vec2> points = projected(corners);
  if (is_convex(points)) return fan(corners.size());
  if (corners.size() > k_max_concave_corners)
    throw InvalidInput("a concave polygon of " + std::to_string(corners.size()) + " corners; at most " +
                       std::to_string(k_max_concave_corners) + " are supported");
  return EarClipper(std::move(points)).run();
}

}  // namespace papilla
