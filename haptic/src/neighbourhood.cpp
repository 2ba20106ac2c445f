// SPDX-License-Identifier: MIT
#include "neighbourhood.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "papilla/core/cpu_clones.hpp"

namespace papilla {
namespace {

constexpr float k_margin = 2e-6F;  // Relative; a dozen roundings of single precision.
constexpr float k_never = 2;       // A parameter beyond the segment.
constexpr float k_least = 1e-25F;  // Keeps a quotient finite.

constexpr float k_rounding = 4e-7F;  // Relative; a few roundings.

float size_of(Vec3 v) noexcept { return static_cast<float>(std::abs(v.x) + std::abs(v.y) + std::abs(v.z)); }

std::array<float, 3> floats_of(Vec3 v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

struct Neighbourhood::Loops {
  static void make_prisms(const Corners& t, Prisms& p) noexcept;
  static void make_box(const Corners& t, Box& box) noexcept;
  static std::uint32_t distances(const Prisms& t, const float* x, float distance, float* result) noexcept;
  struct Passing;
  struct Nearness;
  static Nearness nearness(const Prisms& t, const Passing& p, std::size_t i, float at) noexcept;
  static std::uint32_t first_bounds(const Prisms& t, const float* x, const float* w, float reach, float least,
                                    float until, float* earliest, Passing& p) noexcept;
  static std::uint32_t second_bounds(const Prisms& t, const Passing& p, float reach, float least,
                                     float* earliest) noexcept;
  struct InBox;
  static InBox along_axes(const Boxes& b, std::size_t i, float x, float y, float z) noexcept;
  static std::uint32_t box_distances(const Boxes& b, const float* x, float distance, float* result) noexcept;
  static std::uint32_t near_boxes(const Boxes& b, const float* x, const float* half, float reach) noexcept;
};

/// Plane and edge planes of each triangle. The offsets are taken from the corners, so rounded normals do no harm.
PAPILLA_CPU_CLONES("arch=x86-64-v3")
void Neighbourhood::Loops::make_prisms(const Corners& t, Prisms& p) noexcept {
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const float ax = t.x[0][i], ay = t.x[1][i], az = t.x[2][i];
    const float bx = t.x[3][i], by = t.x[4][i], bz = t.x[5][i];
    const float cx = t.x[6][i], cy = t.x[7][i], cz = t.x[8][i];
    const float ux = bx - ax, uy = by - ay, uz = bz - az;
    const float vx = cx - bx, vy = cy - by, vz = cz - bz;
    const float wx = ax - cx, wy = ay - cy, wz = az - cz;
    float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const float nl = 1 / std::sqrt(std::max(nx * nx + ny * ny + nz * nz, k_least));
    nx *= nl, ny *= nl, nz *= nl;
    // Out of the triangle, across each edge: e × n.
    float mx[3] = {uy * nz - uz * ny, vy * nz - vz * ny, wy * nz - wz * ny};
    float my[3] = {uz * nx - ux * nz, vz * nx - vx * nz, wz * nx - wx * nz};
    float mz[3] = {ux * ny - uy * nx, vx * ny - vy * nx, wx * ny - wy * nx};
    const float more = t.top[i] + k_margin * (std::abs(ax) + std::abs(ay) + std::abs(az) + std::abs(bx) + std::abs(by) +
                                              std::abs(bz) + std::abs(cx) + std::abs(cy) + std::abs(cz));
    for (std::size_t k = 0; k < 3; ++k) {
      const float ml = 1 / std::sqrt(std::max(mx[k] * mx[k] + my[k] * my[k] + mz[k] * mz[k], k_least));
      mx[k] *= ml, my[k] *= ml, mz[k] *= ml;
      const float am = mx[k] * ax + my[k] * ay + mz[k] * az, bm = mx[k] * bx + my[k] * by + mz[k] * bz;
      const float cm = mx[k] * cx + my[k] * cy + mz[k] * cz;
      p.m[3 * k][i] = mx[k], p.m[3 * k + 1][i] = my[k], p.m[3 * k + 2][i] = mz[k];
      p.beyond[k][i] = std::max(am, std::max(bm, cm)) + more;
    }
    const float an = nx * ax + ny * ay + nz * az, bn = nx * bx + ny * by + nz * bz, cn = nx * cx + ny * cy + nz * cz;
    const float low = std::min(an, std::min(bn, cn)), high = std::max(an, std::max(bn, cn));
    p.n[0][i] = nx, p.n[1][i] = ny, p.n[2][i] = nz;
    p.middle[i] = 0.5F * (low + high);
    p.thick[i] = 0.5F * (high - low) + more;
    // Along the longest edge, orthogonal to the rounded n.
    const float ul = ux * ux + uy * uy + uz * uz, vl = vx * vx + vy * vy + vz * vz, wl = wx * wx + wy * wy + wz * wz;
    const bool u = ul >= vl && ul >= wl, v = vl >= wl;
    const float lx = u ? mx[0] : v ? mx[1] : mx[2], ly = u ? my[0] : v ? my[1] : my[2];
    const float lz = u ? mz[0] : v ? mz[1] : mz[2];
    const float ex = ly * nz - lz * ny, ey = lz * nx - lx * nz, ez = lx * ny - ly * nx;
    const float ae = ex * ax + ey * ay + ez * az, be = ex * bx + ey * by + ez * bz, ce = ex * cx + ey * cy + ez * cz;
    const float first = std::min(ae, std::min(be, ce)), last = std::max(ae, std::max(be, ce));
    p.e[0][i] = ex, p.e[1][i] = ey, p.e[2][i] = ez;
    p.halfway[i] = 0.5F * (first + last);
    p.half[i] = 0.5F * (last - first) + more;
  }
}

/// Box along the mean normal and the coordinate axis that is most orthogonal to it: clusters are split along coordinate
/// axes. The centre is that of the corners.
PAPILLA_CPU_CLONES("arch=x86-64-v3")
void Neighbourhood::Loops::make_box(const Corners& t, Box& box) noexcept {
  float n0 = 0, n1 = 0, n2 = 0;
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const float ux = t.x[3][i] - t.x[0][i], uy = t.x[4][i] - t.x[1][i], uz = t.x[5][i] - t.x[2][i];
    const float vx = t.x[6][i] - t.x[0][i], vy = t.x[7][i] - t.x[1][i], vz = t.x[8][i] - t.x[2][i];
    n0 += uy * vz - uz * vy, n1 += uz * vx - ux * vz, n2 += ux * vy - uy * vx;
  }
  const float length2 = n0 * n0 + n1 * n1 + n2 * n2, by = 1 / std::sqrt(std::max(length2, k_least));
  const bool folded = !(length2 > k_least);
  const float n[3] = {folded ? 1 : by * n0, folded ? 0 : by * n1, folded ? 0 : by * n2};
  const float a0 = std::abs(n[0]), a1 = std::abs(n[1]), a2 = std::abs(n[2]);
  const std::size_t k = a0 <= a1 && a0 <= a2 ? 0 : a1 <= a2 ? 1 : 2;
  float u[3] = {-n[k] * n[0], -n[k] * n[1], -n[k] * n[2]};
  u[k] += 1;
  const float to_unit = 1 / std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);  // Of at least 2/3.
  for (float& v : u) v *= to_unit;
  box.axis = {n[0],
              n[1],
              n[2],
              u[0],
              u[1],
              u[2],
              n[1] * u[2] - n[2] * u[1],
              n[2] * u[0] - n[0] * u[2],
              n[0] * u[1] - n[1] * u[0]};
  float more = 0;
  for (std::size_t i = 0; i < k_lanes; ++i) more = std::max(more, t.top[i]);
  float low[3], high[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float e0 = box.axis[3 * axis], e1 = box.axis[3 * axis + 1], e2 = box.axis[3 * axis + 2];
    float least = t.x[0][0] * e0 + t.x[1][0] * e1 + t.x[2][0] * e2, most = least;
    for (std::size_t corner = 0; corner < 9; corner += 3)
      for (std::size_t i = 0; i < k_lanes; ++i) {
        const float at = t.x[corner][i] * e0 + t.x[corner + 1][i] * e1 + t.x[corner + 2][i] * e2;
        least = std::min(least, at);
        most = std::max(most, at);
      }
    low[axis] = least, high[axis] = most;
  }
  const float size = std::max(std::abs(low[0]), std::abs(high[0])) + std::max(std::abs(low[1]), std::abs(high[1])) +
                     std::max(std::abs(low[2]), std::abs(high[2]));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.half[axis] = 0.5F * (high[axis] - low[axis]) + more + k_margin * size;
    box.centre[axis] = 0.5F * ((high[0] + low[0]) * box.axis[axis] + (high[1] + low[1]) * box.axis[3 + axis] +
                               (high[2] + low[2]) * box.axis[6 + axis]);
  }
}

/// @returns a bit for each triangle that is nearer than `distance`.
PAPILLA_CPU_CLONES("arch=x86-64-v4", "arch=x86-64-v3")
std::uint32_t Neighbourhood::Loops::distances(const Prisms& t, const float* x, float distance, float* result) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2];
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const float s = t.n[0][i] * x0 + t.n[1][i] * x1 + t.n[2][i] * x2 - t.middle[i];
    const float ds = std::max(std::abs(s) - t.thick[i], 0.0F);
    const float m0 = t.m[0][i] * x0 + t.m[1][i] * x1 + t.m[2][i] * x2 - t.beyond[0][i];
    const float m1 = t.m[3][i] * x0 + t.m[4][i] * x1 + t.m[5][i] * x2 - t.beyond[1][i];
    const float m2 = t.m[6][i] * x0 + t.m[7][i] * x1 + t.m[8][i] * x2 - t.beyond[2][i];
    const float e = t.e[0][i] * x0 + t.e[1][i] * x1 + t.e[2][i] * x2 - t.halfway[i];
    const float m3 = std::abs(e) - t.half[i];
    const float dm = std::max(std::max(std::max(m0, m1), std::max(m2, m3)), 0.0F);
    result[i] = std::sqrt(ds * ds + dm * dm);
  }
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < k_lanes; ++i) bits |= result[i] < distance ? 1U << i : 0U;
  return bits;
}

/// Signed distances of x to the planes of each prism, and their derivatives for a velocity w: plane, edge planes,
/// middle of the longest edge.
struct Neighbourhood::Loops::Passing {
  Lanes n, m0, m1, m2, e;
  Lanes wn, w0, w1, w2, we;
};

/// g, the distance to a prism at t, and its descent −g·dg/dt.
struct Neighbourhood::Loops::Nearness {
  float g, descent;
};

[[gnu::always_inline]] inline Neighbourhood::Loops::Nearness Neighbourhood::Loops::nearness(const Prisms& t,
                                                                                            const Passing& p,
                                                                                            std::size_t i,
                                                                                            float at) noexcept {
  const float s = p.n[i] + at * p.wn[i], e = p.e[i] + at * p.we[i];
  const float m0 = p.m0[i] + at * p.w0[i], m1 = p.m1[i] + at * p.w1[i], m2 = p.m2[i] + at * p.w2[i];
  const float m3 = std::abs(e) - t.half[i], w3 = e > 0 ? p.we[i] : -p.we[i];
  const float m01 = std::max(m0, m1), w01 = m0 > m1 ? p.w0[i] : p.w1[i];
  const float m23 = std::max(m2, m3), w23 = m2 > m3 ? p.w2[i] : w3;
  const float ds = std::max(s - t.thick[i], 0.0F) + std::min(s + t.thick[i], 0.0F);
  const float dm = std::max(std::max(m01, m23), 0.0F), wm = m01 > m23 ? w01 : w23;
  return {std::sqrt(ds * ds + dm * dm), -(ds * p.wn[i] + dm * wm)};
}

/// First bound. The distance g is convex: at t' it is at least g − (t' − t)·descent/g. So the distance c is not reached
/// before t + (g − c)·g/descent, and no distance below g − (1 − t)·max(descent, 0)/g is reached at all.
/// @returns a bit for each triangle with earliest ≤ until; the search starts at the parameter in `earliest`.
PAPILLA_CPU_CLONES("arch=x86-64-v4", "arch=x86-64-v3")
std::uint32_t Neighbourhood::Loops::first_bounds(const Prisms& t, const float* x, const float* w, float reach,
                                                 float least, float until, float* earliest, Passing& p) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2], w0 = w[0], w1 = w[1], w2 = w[2];
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    p.n[i] = t.n[0][i] * x0 + t.n[1][i] * x1 + t.n[2][i] * x2 - t.middle[i];
    p.wn[i] = t.n[0][i] * w0 + t.n[1][i] * w1 + t.n[2][i] * w2;
    p.m0[i] = t.m[0][i] * x0 + t.m[1][i] * x1 + t.m[2][i] * x2 - t.beyond[0][i];
    p.m1[i] = t.m[3][i] * x0 + t.m[4][i] * x1 + t.m[5][i] * x2 - t.beyond[1][i];
    p.m2[i] = t.m[6][i] * x0 + t.m[7][i] * x1 + t.m[8][i] * x2 - t.beyond[2][i];
    p.w0[i] = t.m[0][i] * w0 + t.m[1][i] * w1 + t.m[2][i] * w2;
    p.w1[i] = t.m[3][i] * w0 + t.m[4][i] * w1 + t.m[5][i] * w2;
    p.w2[i] = t.m[6][i] * w0 + t.m[7][i] * w1 + t.m[8][i] * w2;
    p.e[i] = t.e[0][i] * x0 + t.e[1][i] * x1 + t.e[2][i] * x2 - t.halfway[i];
    p.we[i] = t.e[0][i] * w0 + t.e[1][i] * w1 + t.e[2][i] * w2;
    const float at = earliest[i];
    const auto [g, descent] = nearness(t, p, i, at);
    const float down = std::max(descent, k_least);
    const float met = at + std::max((g - reach) * g / down * (1 - k_margin), 0.0F);
    earliest[i] = (g - least) * g > down * std::max(1 - at, 0.0F) ? k_never : std::min(met, k_never);
  }
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < k_lanes; ++i) bits |= earliest[i] <= until ? 1U << i : 0U;
  return bits;
}

/// Second bound, for segments up to t = 1: from the tangents of the distance at `earliest`, at the end, and where these
/// two cross. The minimum is not below the crossings of neighbouring tangents, and is the end's if g still falls there.
PAPILLA_CPU_CLONES("arch=x86-64-v4", "arch=x86-64-v3")
std::uint32_t Neighbourhood::Loops::second_bounds(const Prisms& t, const Passing& p, float reach, float least,
                                                  float* earliest) noexcept {
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const float at = earliest[i], left = std::max(1 - at, 0.0F);
    const auto [g, descent] = nearness(t, p, i, at);
    const auto [g1, descent1] = nearness(t, p, i, 1);
    const float down = std::max(descent, k_least) / std::max(g, k_least);
    const float up = std::max(-descent1, 0.0F) / std::max(g1, k_least);
    const float turned = std::clamp((g - g1 + up * left) / std::max(down + up, k_least), 0.0F, left);
    const auto [g2, descent2] = nearness(t, p, i, at + turned);
    const float slope2 = -descent2 / std::max(g2, k_least);
    // From the middle tangent to the outer one on the side where the distance falls.
    const float other = slope2 > 0 ? down : up, over = slope2 > 0 ? g - turned * down : g1 - (left - turned) * up;
    const float lower = g2 - (g2 - over) * std::abs(slope2) / std::max(std::abs(slope2) + other, k_least);
    const float bottom = descent1 >= 0 ? g1 : lower;
    const float met = at + std::max((g - reach) / down * (1 - k_margin), 0.0F);
    earliest[i] = bottom > least || at > 1 ? k_never : std::min(met, k_never);
  }
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < k_lanes; ++i) bits |= earliest[i] <= 1 ? 1U << i : 0U;
  return bits;
}

/// A vector in the frame of box i.
struct Neighbourhood::Loops::InBox {
  float x, y, z;
};

[[gnu::always_inline]] inline Neighbourhood::Loops::InBox Neighbourhood::Loops::along_axes(const Boxes& b,
                                                                                           std::size_t i, float x,
                                                                                           float y, float z) noexcept {
  return {b.axis[0][i] * x + b.axis[1][i] * y + b.axis[2][i] * z,
          b.axis[3][i] * x + b.axis[4][i] * y + b.axis[5][i] * z,
          b.axis[6][i] * x + b.axis[7][i] * y + b.axis[8][i] * z};
}

/// @returns a bit for each of k_lanes boxes that is nearer to x than `distance`.
PAPILLA_CPU_CLONES("arch=x86-64-v4", "arch=x86-64-v3")
std::uint32_t Neighbourhood::Loops::box_distances(const Boxes& b, const float* x, float distance,
                                                  float* result) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2];
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const auto [q0, q1, q2] = along_axes(b, i, x0 - b.centre[0][i], x1 - b.centre[1][i], x2 - b.centre[2][i]);
    const float d0 = std::max(std::abs(q0) - b.half[0][i], 0.0F);
    const float d1 = std::max(std::abs(q1) - b.half[1][i], 0.0F);
    const float d2 = std::max(std::abs(q2) - b.half[2][i], 0.0F);
    result[i] = std::sqrt(d0 * d0 + d1 * d1 + d2 * d2);
  }
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < k_lanes; ++i) bits |= result[i] < distance ? 1U << i : 0U;
  return bits;
}

/// With d from a box to x, the middle of the segment from x − half to x + half, no point of it is nearer to the box
/// than |d| − |d·half|/|d|. @returns a bit for each of k_lanes boxes where that is at most `reach`.
PAPILLA_CPU_CLONES("arch=x86-64-v4", "arch=x86-64-v3")
std::uint32_t Neighbourhood::Loops::near_boxes(const Boxes& b, const float* x, const float* half,
                                               float reach) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2], h0 = half[0], h1 = half[1], h2 = half[2];
  float beyond[k_lanes];
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const auto [q0, q1, q2] = along_axes(b, i, x0 - b.centre[0][i], x1 - b.centre[1][i], x2 - b.centre[2][i]);
    const float d0 = std::max(q0 - b.half[0][i], 0.0F) - std::max(-q0 - b.half[0][i], 0.0F);
    const float d1 = std::max(q1 - b.half[1][i], 0.0F) - std::max(-q1 - b.half[1][i], 0.0F);
    const float d2 = std::max(q2 - b.half[2][i], 0.0F) - std::max(-q2 - b.half[2][i], 0.0F);
    const float g2 = d0 * d0 + d1 * d1 + d2 * d2;
    const auto [a0, a1, a2] = along_axes(b, i, h0, h1, h2);
    const float along = d0 * a0 + d1 * a1 + d2 * a2;
    beyond[i] = g2 - std::abs(along) - reach * std::sqrt(g2);
  }
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < k_lanes; ++i) bits |= beyond[i] <= 0 ? 1U << i : 0U;
  return bits;
}

void Neighbourhood::clear() noexcept {
  clear_boxes();
  made_.fill(k_no_block);
}

void Neighbourhood::begin(Vec3 centre, double reach_m) noexcept {
  centre_ = centre;
  reach_ = reach_m;
  count_ = 0;
}

void Neighbourhood::set_box(std::uint32_t i, const Box& box) noexcept {
  Boxes& to = boxes_[i / k_lanes];
  const std::size_t lane = i % k_lanes;
  for (std::size_t k = 0; k < 3; ++k) to.centre[k][lane] = box.centre[k], to.half[k][lane] = box.half[k];
  for (std::size_t k = 0; k < 9; ++k) to.axis[k][lane] = box.axis[k];
}

void Neighbourhood::add(std::uint32_t block, const Box3f& box) noexcept {
  Box level;
  for (std::size_t k = 0; k < 3; ++k) {
    level.centre[k] = 0.5F * (box.low[k] + box.high[k]);
    level.half[k] = 0.5F * (box.high[k] - box.low[k]) + k_rounding * (std::abs(box.low[k]) + std::abs(box.high[k]));
  }
  set_box(count_, level);
  block_[count_++] = block;
}

bool Neighbourhood::add_known(std::uint32_t block) noexcept {
  block_[count_] = block;
  if (!has_prisms(count_)) return false;
  set_box(count_, made_box_[slot(count_)]);
  ++count_;
  return true;
}

void Neighbourhood::make(std::uint32_t i, const std::array<float, 3>& origin, const Corners& corners) noexcept {
  Loops::make_prisms(corners, prisms_[next_]);
  Box& box = made_box_[next_];
  Loops::make_box(corners, box);
  for (std::size_t k = 0; k < 3; ++k) {
    box.centre[k] += origin[k];
    box.half[k] += k_rounding * (std::abs(origin[0]) + std::abs(origin[1]) + std::abs(origin[2]));
  }
  set_box(i, box);
  origin_[next_] = origin;
  made_[next_] = block_[i];
  slots_[block_[i] % k_remembered] = static_cast<std::uint16_t>(next_);
  next_ = (next_ + 1) % k_made;
}

std::uint32_t Neighbourhood::along(Vec3 from, Vec3 way, double distance, Numbers& found) const noexcept {
  const Vec3 half = 0.5 * way, middle = from + half;
  const std::array<float, 3> x = floats_of(middle), h = floats_of(half);
  const auto reach = static_cast<float>(distance);
  // Rounding turns the direction to a box beyond `reach` by less than error/reach.
  const float error = k_margin * size_of(middle);
  const float most = reach * (1 + k_margin) + error + (error / reach + k_margin) * size_of(half);
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < count_; first += k_lanes) {
    std::uint32_t near = Loops::near_boxes(boxes_[first / k_lanes], x.data(), h.data(), most);
    if (count_ - first < k_lanes) near &= (1U << (count_ - first)) - 1;
    for (; near != 0; near &= near - 1)
      found[count++] = static_cast<std::uint16_t>(first + static_cast<std::uint32_t>(std::countr_zero(near)));
  }
  return count;
}

std::uint32_t Neighbourhood::around(Vec3 x, double distance, Numbers& found, Distances& least) const noexcept {
  const std::array<float, 3> at = floats_of(x);
  const float error = k_margin * size_of(x), most = static_cast<float>(distance) * (1 + k_margin) + error;
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < count_; first += k_lanes) {
    Lanes distances;
    std::uint32_t near = Loops::box_distances(boxes_[first / k_lanes], at.data(), most, distances.data());
    if (count_ - first < k_lanes) near &= (1U << (count_ - first)) - 1;
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      least[count] = distances[lane] * (1 - k_margin) - error;
      found[count++] = static_cast<std::uint16_t>(first + lane);
    }
  }
  return count;
}

std::uint32_t Neighbourhood::distances(std::uint32_t i, Vec3 from, double distance, Lanes& least) const noexcept {
  const std::array<float, 3>& o = origin_[slot(i)];
  const std::array<float, 3> x =
      floats_of(from - Vec3{static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])});
  return Loops::distances(prisms_[slot(i)], x.data(), static_cast<float>(distance) * (1 + k_margin), least.data());
}

void Neighbourhood::bound_contacts(Vec3 from, Vec3 way, double contact, double deep, double since, double until,
                                   ContactBounds& bounds) const noexcept {
  const std::array<float, 3> w = floats_of(way);
  const auto c = static_cast<float>(contact), d = static_cast<float>(deep);
  const float last = static_cast<float>(until) * (1 + k_margin), first = static_cast<float>(since) * (1 - k_margin);
  std::array<Loops::Passing, k_together> passing;
  std::array<float, k_together> error;
  for (std::uint32_t i = 0; i < bounds.count; ++i) {
    const std::uint32_t at = slot(bounds.block[i]);
    const std::array<float, 3>& o = origin_[at];
    const Vec3 start = from - Vec3{static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
    const std::array<float, 3> x = floats_of(start);
    error[i] = 4 * k_margin * (c + size_of(start) + size_of(way));
    bounds.earliest[i].fill(first);
    bounds.met[i] = Loops::first_bounds(prisms_[at], x.data(), w.data(), c + error[i], c + error[i] - d, last,
                                        bounds.earliest[i].data(), passing[i]);
  }
  // A single triangle is tested at once.
  int met = 0;
  for (std::uint32_t i = 0; i < bounds.count; ++i) met += std::popcount(bounds.met[i]);
  if (until < 1 || met < 2) return;
  for (std::uint32_t i = 0; i < bounds.count; ++i)
    if (bounds.met[i] != 0)
      bounds.met[i] = Loops::second_bounds(prisms_[slot(bounds.block[i])], passing[i], c + error[i], c + error[i] - d,
                                           bounds.earliest[i].data());
}

}  // namespace papilla
