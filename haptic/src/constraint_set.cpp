// SPDX-License-Identifier: MIT
#include "constraint_set.hpp"

#include <bit>

namespace papilla {
namespace {

constexpr double k_least_sine2 = 1e-8;  // Planes closer to parallel than 0.1 mrad don't form an edge.

struct Candidate {
  Vec3 point;
  bool valid = false;
};

bool allowed(Vec3 x, const HalfSpace* planes, int count, std::uint32_t active, double slack) noexcept {
  for (int i = 0; i < count; ++i)
    if (!(active >> i & 1U) && dot(planes[i].normal, x) < planes[i].offset - slack) return false;
  return true;
}

Candidate on_one(Vec3 goal, const HalfSpace& a) noexcept {
  const double need = a.offset - dot(a.normal, goal);
  return {goal + need * a.normal, need >= 0};
}

Candidate on_two(Vec3 goal, const HalfSpace& a, const HalfSpace& b) noexcept {
  const double c = dot(a.normal, b.normal), det = 1 - c * c;
  if (det < k_least_sine2) return {};
  const double ra = a.offset - dot(a.normal, goal), rb = b.offset - dot(b.normal, goal);
  const double la = (ra - c * rb) / det, lb = (rb - c * ra) / det;
  return {goal + la * a.normal + lb * b.normal, la >= 0 && lb >= 0};
}

Candidate on_three(Vec3 goal, const HalfSpace& a, const HalfSpace& b, const HalfSpace& c) noexcept {
  const Vec3 bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal), ab = cross(a.normal, b.normal);
  const double det = dot(a.normal, bc);
  if (det * det < k_least_sine2) return {};
  const Vec3 corner = (1 / det) * (a.offset * bc + b.offset * ca + c.offset * ab);
  // corner − goal = Σ λ n; the rows of the inverse of (na nb nc) are bc, ca, ab over det.
  const Vec3 d = corner - goal;
  return {corner, dot(d, bc) / det >= 0 && dot(d, ca) / det >= 0 && dot(d, ab) / det >= 0};
}

}  // namespace

ConstrainedPoint closest_point(Vec3 goal, const HalfSpace* planes, int count, double slack) noexcept {
  ConstrainedPoint best;
  best.point = goal;
  const auto take = [&](const Candidate& candidate, std::uint32_t active) noexcept {
    if (!candidate.valid || !allowed(candidate.point, planes, count, active, slack)) return false;
    best = {candidate.point, active, std::popcount(active), true};
    return true;
  };
  if (take({goal, true}, 0)) return best;
  for (int i = 0; i < count; ++i)
    if (take(on_one(goal, planes[i]), 1U << i)) return best;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if (take(on_two(goal, planes[i], planes[j]), 1U << i | 1U << j)) return best;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      for (int k = j + 1; k < count; ++k)
        if (take(on_three(goal, planes[i], planes[j], planes[k]), 1U << i | 1U << j | 1U << k)) return best;
  return best;
}

}  // namespace papilla
