// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "box_tree.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// The point of the segment a, a + ab closest to p; ab may be zero.
inline Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& ab) noexcept {
  const double length2 = dot(ab, ab);
  return length2 > 0 ? a + std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) * ab : a;
}

/// A triangle ready for distance queries, of any shape.
struct TriangleFrame {
  Vec3 a, ab, ac;
  bool thin = false;  ///< Its altitude is lost in rounding: taken as its three edges.

  TriangleFrame() = default;
  TriangleFrame(const Vec3& p0, const Vec3& p1, const Vec3& p2) noexcept : a(p0), ab(p1 - p0), ac(p2 - p0) {
    // altitude / longest edge < 1e-8; the edges then miss the true distance by less than that.
    constexpr double k_thin = 1e-16;
    const Vec3 n = cross(ab, ac);
    const double longest2 = std::max({dot(ab, ab), dot(ac, ac), dot(ac - ab, ac - ab)});
    thin = !(dot(n, n) > k_thin * longest2 * longest2);
  }
};

/// The foot of ap on the plane of ab and ac, exact up to rounding for needles: an orthogonal frame of that plane,
/// orthogonalized twice, has no large products to cancel.
inline Vec3 foot_on_plane(const Vec3& ap, const TriangleFrame& t) noexcept {
  const bool ab_longer = dot(t.ab, t.ab) >= dot(t.ac, t.ac);
  const Vec3 e = normalized(ab_longer ? t.ab : t.ac);
  Vec3 h = ab_longer ? t.ac : t.ab;
  h = h - dot(h, e) * e;
  h = h - dot(h, e) * e;
  return dot(ap, e) * e + (dot(ap, h) / dot(h, h)) * h;
}

/// The point of the triangle closest to p, by the regions of [Ericson 2005, Real-Time Collision Detection, 5.1.5].
/// Always a point of the triangle up to rounding, so that the distance to it is never below the true one.
inline Vec3 closest_on_triangle(const Vec3& p, const TriangleFrame& t) noexcept {
  const Vec3 ap = p - t.a;
  if (t.thin) {
    Vec3 best = closest_on_segment(p, t.a, t.ab);
    for (const Vec3& q : {closest_on_segment(p, t.a, t.ac), closest_on_segment(p, t.a + t.ab, t.ac - t.ab)})
      if (dot(q - p, q - p) < dot(best - p, best - p)) best = q;
    return best;
  }
  const double d1 = dot(t.ab, ap), d2 = dot(t.ac, ap);
  if (d1 <= 0 && d2 <= 0) return t.a;
  const Vec3 bp = ap - t.ab;
  const double d3 = dot(t.ab, bp), d4 = dot(t.ac, bp);
  if (d3 >= 0 && d4 <= d3) return t.a + t.ab;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.a + (d1 / (d1 - d3)) * t.ab;
  const Vec3 cp = ap - t.ac;
  const double d5 = dot(t.ab, cp), d6 = dot(t.ac, cp);
  if (d6 >= 0 && d5 <= d6) return t.a + t.ac;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.a + (d2 / (d2 - d6)) * t.ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return t.a + t.ab + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t.ac - t.ab);
  constexpr double k_needle = 1e-4;  // (altitude / edge)² below which the products above cancel too far
  if (va + vb + vc < k_needle * dot(t.ab, t.ab) * dot(t.ac, t.ac)) return foot_on_plane(ap, t) + t.a;
  const double scale = 1 / (va + vb + vc);
  return t.a + (vb * scale) * t.ab + (vc * scale) * t.ac;
}

inline double squared_distance(const Vec3& p, const TriangleFrame& t) noexcept {
  const Vec3 d = closest_on_triangle(p, t) - p;
  return dot(d, d);
}

/// A point of a surface and how far it is from the point asked for.
struct ClosestPoint {
  double squared_distance = std::numeric_limits<double>::infinity();
  Index triangle = k_no_value;
};

/// Where the open segment a + t d, 0 < t < 1, cuts the triangle [Möller & Trumbore 1997]; 0 when it does not, as those
/// parallel to it.
inline double cut_at(const Vec3& a, const Vec3& d, const TriangleFrame& t) noexcept {
  const Vec3 h = cross(d, t.ac);
  const double det = dot(t.ab, h);
  if (!(std::abs(det) > 0)) return 0;
  const double inverse = 1 / det;
  const Vec3 s = a - t.a;
  const double u = inverse * dot(s, h);
  if (!(u >= 0 && u <= 1)) return 0;
  const Vec3 q = cross(s, t.ab);
  const double v = inverse * dot(d, q);
  if (!(v >= 0 && u + v <= 1)) return 0;
  const double along = inverse * dot(t.ac, q);
  return along > 0 && along < 1 ? along : 0;
}

/// The cut of a segment nearest to its start, the least number of several there.
struct FirstCut {
  double at = 1;
  Index triangle = k_no_value;

  /// @param t  as from cut_at().
  void add(double t, Index number) noexcept {
    if (!(t > 0) || !(t < at || (t == at && number < triangle))) return;
    at = t;
    triangle = number;
  }
};

/// A list of triangles for closest points and for sight lines, those in double precision. Own code because the known
/// libraries lack what the callers live on: a start bound for the search ("nearer than this?", from the neighbour's
/// answer) and answers in double precision. About 116 bytes a triangle, up to twice that when most are slanted slivers.
/// Any triangle shape is fine.
class TriangleBvh {
 public:
  /// @param positions Finite. @param triangles With indices in range; the positions are copied.
  TriangleBvh(std::span<const Vec3> positions, std::span<const Triangle> triangles);

  std::size_t size() const noexcept { return slot_of_.size(); }

  /// The closest point if it is nearer than `start`, else `start`. The search ends with any point whose squared
  /// distance is at most `enough`: where many boxes overlap, as those of a fan of slivers, proving it the closest costs
  /// most.
  ClosestPoint closest(const Vec3& p, ClosestPoint start = {}, double enough = 0) const noexcept;

  /// Does a triangle other than `ignored` cut the open segment from a to b?
  bool blocks(const Vec3& a, const Vec3& b, Index ignored = k_no_value) const noexcept;

  /// The triangle that cuts the open segment from a to b nearest to a, the least number of several there; k_no_value
  /// when none does.
  Index first_cut(const Vec3& a, const Vec3& b) const noexcept;

  /// The triangle with this number in the list.
  const TriangleFrame& frame(Index triangle) const noexcept { return prims_[slot_of_[triangle]].frame; }

 private:
  struct Prim {                                 ///< A box of a triangle.
    [[no_unique_address]] TriangleFrame frame;  // The number takes the bytes that its flag leaves.
    Index triangle = 0;
  };

  BoxTree tree_;
  std::vector<Prim> prims_;
  std::vector<Index> slot_of_;
};

}  // namespace papilla::detail
