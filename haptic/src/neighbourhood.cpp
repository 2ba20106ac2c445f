// SPDX-License-Identifier: MIT
#include "papilla/haptic/neighbourhood.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

// The loops below are made once for each width of vectors, and the processor chooses. (Not with sanitizers, which can't
// run before the choice is made.)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PAPILLA_WIDE __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PAPILLA_WIDE
#endif

namespace papilla {
namespace {

constexpr float k_margin = 2e-6F;  // Relative; a dozen roundings of single precision.
constexpr float k_never = 2;
// Taken of a block: the second tells what a whole way only passes over. The piece at the start of a long one is too
// short.
constexpr int k_tangents = 2;
constexpr float k_least = 1e-25F;  // Keeps a quotient finite.

float size_of(Vec3 v) noexcept { return static_cast<float>(std::abs(v.x) + std::abs(v.y) + std::abs(v.z)); }

std::array<float, 3> floats_of(Vec3 v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

struct Neighbourhood::Loops {
  static void make_prisms(const Corners& t, Prisms& p) noexcept;
  static std::uint32_t meet(const Prisms& t, const float* x, const float* w, float reach, float least, float until,
                            float* earliest) noexcept;
  static void distances2(const Boxes& boxes, std::uint32_t count, const float* x, float* result) noexcept;
};

/// Plane and edge planes of each triangle. Whatever the rounded normals are, corners bound all that lies between them.
PAPILLA_WIDE void Neighbourhood::Loops::make_prisms(const Corners& t, Prisms& p) noexcept {
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
    // Along the longest edge, orthogonal to n whatever its rounding.
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

/// With g the distance to the prism at x + t·w, t = earliest, and p/g its slope along w, the distance at t' is at least
/// g + (t' − t)·p/g: reach c is not met before t + (g − c)·g/−p, and what lies below g + (1 − t)·min(p/g, 0) not at
/// all.
/// @returns a bit for each that may be met by `until`.
PAPILLA_WIDE std::uint32_t Neighbourhood::Loops::meet(const Prisms& t, const float* x, const float* w, float reach,
                                                      float least, float until, float* earliest) noexcept {
  const float w0 = w[0], w1 = w[1], w2 = w[2], o0 = x[0], o1 = x[1], o2 = x[2];
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const float at = earliest[i], x0 = o0 + at * w0, x1 = o1 + at * w1, x2 = o2 + at * w2;
    const float s = t.n[0][i] * x0 + t.n[1][i] * x1 + t.n[2][i] * x2 - t.middle[i];
    const float ds = std::max(s - t.thick[i], 0.0F) + std::min(s + t.thick[i], 0.0F);
    const float ws = t.n[0][i] * w0 + t.n[1][i] * w1 + t.n[2][i] * w2;
    const float m0 = t.m[0][i] * x0 + t.m[1][i] * x1 + t.m[2][i] * x2 - t.beyond[0][i];
    const float m1 = t.m[3][i] * x0 + t.m[4][i] * x1 + t.m[5][i] * x2 - t.beyond[1][i];
    const float m2 = t.m[6][i] * x0 + t.m[7][i] * x1 + t.m[8][i] * x2 - t.beyond[2][i];
    const float v0 = t.m[0][i] * w0 + t.m[1][i] * w1 + t.m[2][i] * w2;
    const float v1 = t.m[3][i] * w0 + t.m[4][i] * w1 + t.m[5][i] * w2;
    const float v2 = t.m[6][i] * w0 + t.m[7][i] * w1 + t.m[8][i] * w2;
    const float e = t.e[0][i] * x0 + t.e[1][i] * x1 + t.e[2][i] * x2 - t.halfway[i];
    const float we = t.e[0][i] * w0 + t.e[1][i] * w1 + t.e[2][i] * w2;
    const float m3 = std::abs(e) - t.half[i], v3 = e > 0 ? we : -we;
    const float m01 = std::max(m0, m1), v01 = m0 > m1 ? v0 : v1;
    const float m23 = std::max(m2, m3), v23 = m2 > m3 ? v2 : v3;
    const float dm = std::max(std::max(m01, m23), 0.0F), wm = m01 > m23 ? v01 : v23;
    const float g = std::sqrt(ds * ds + dm * dm);
    const float approach = std::max(-(ds * ws + dm * wm), k_least);
    const float met = at + std::max((g - reach) * g / approach * (1 - k_margin), 0.0F);
    earliest[i] = (g - least) * g > approach * std::max(1 - at, 0.0F) ? k_never : std::min(met, k_never);
  }
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < k_lanes; ++i) bits |= earliest[i] <= until ? 1U << i : 0U;
  return bits;
}

PAPILLA_WIDE void Neighbourhood::Loops::distances2(const Boxes& b, std::uint32_t count, const float* x,
                                                   float* result) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2];
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float d0 = std::max(std::max(b.low[0][i] - x0, x0 - b.high[0][i]), 0.0F);
    const float d1 = std::max(std::max(b.low[1][i] - x1, x1 - b.high[1][i]), 0.0F);
    const float d2 = std::max(std::max(b.low[2][i] - x2, x2 - b.high[2][i]), 0.0F);
    result[i] = d0 * d0 + d1 * d1 + d2 * d2;
  }
}

void Neighbourhood::clear() noexcept {
  forget_place();
  made_.fill(k_no_block);
}

void Neighbourhood::begin(Vec3 centre, double reach_m) noexcept {
  centre_ = centre;
  reach_ = reach_m;
  count_ = 0;
}

bool Neighbourhood::add(std::uint32_t block, const Box3f& box) noexcept {
  if (count_ == k_blocks) return false;
  for (std::size_t k = 0; k < 3; ++k) boxes_.low[k][count_] = box.low[k], boxes_.high[k][count_] = box.high[k];
  block_[count_++] = block;
  return true;
}

void Neighbourhood::make(std::uint32_t i, const std::array<float, 3>& origin, const Corners& corners) noexcept {
  Loops::make_prisms(corners, prisms_[next_]);
  origin_[next_] = origin;
  made_[next_] = block_[i];
  slots_[block_[i] % k_remembered] = static_cast<std::uint16_t>(next_);
  next_ = (next_ + 1) % k_made;
}

std::uint32_t Neighbourhood::within(Vec3 from, double distance, Numbers& found) const noexcept {
  const std::array<float, 3> x = floats_of(from);
  alignas(64) std::array<float, k_blocks> distance2;
  Loops::distances2(boxes_, count_, x.data(), distance2.data());
  const float most = static_cast<float>(distance) * (1 + k_margin) + k_margin * size_of(from);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    found[count] = static_cast<std::uint16_t>(i);
    count += distance2[i] <= most * most ? 1U : 0U;
  }
  return count;
}

std::uint32_t Neighbourhood::near_way(std::uint32_t i, Vec3 from, Vec3 way, double contact, double deep, double until,
                                      Lanes& earliest) const noexcept {
  const std::array<float, 3>& o = origin_[slot(i)];
  const Vec3 at = from - Vec3{static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
  const std::array<float, 3> x = floats_of(at), w = floats_of(way);
  const auto c = static_cast<float>(contact), last = static_cast<float>(until) * (1 + k_margin);
  const float error = 4 * k_margin * (c + size_of(at) + size_of(way));
  std::uint32_t met = 0;
  earliest.fill(0);
  for (int tangent = 0; tangent < k_tangents; ++tangent) {
    met = Loops::meet(prisms_[slot(i)], x.data(), w.data(), c + error, c + error - static_cast<float>(deep), last,
                      earliest.data());
    if (std::popcount(met) < 2 || until < 1) break;
  }
  return met;
}

}  // namespace papilla
