// SPDX-License-Identifier: MIT
#include "papilla/haptic/neighbourhood.hpp"

#include <algorithm>
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

constexpr int k_block = 16;  // Whole vectors: what stands behind the last triangle is computed and not looked at.
static_assert(Neighbourhood::k_capacity % k_block == 0);
constexpr float k_margin = 2e-6F;  // Relative; a dozen roundings of single precision.
constexpr float k_least = 1e-30F;  // Keeps a quotient finite.

float size_of(Vec3 v) noexcept { return static_cast<float>(std::abs(v.x) + std::abs(v.y) + std::abs(v.z)); }

/// What the loops read and write.
struct Corners {
  const float* x[9];
  const float* top;
};
template <class Float>
struct Prisms {
  Float *n[3], *m[9], *middle, *thick, *beyond[3];
};

/// Plane and edge planes of each triangle. Whatever the rounded normals are, corners bound all that lies between them.
PAPILLA_WIDE void make_prisms(const Corners& t, const Prisms<float>& p, int count) {
  for (int block = 0; block < count; block += k_block)
#pragma GCC ivdep
    for (int i = block; i < block + k_block; ++i) {
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
      const float more =
          t.top[i] + k_margin * (std::abs(ax) + std::abs(ay) + std::abs(az) + std::abs(bx) + std::abs(by) +
                                 std::abs(bz) + std::abs(cx) + std::abs(cy) + std::abs(cz));
      for (int k = 0; k < 3; ++k) {
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
    }
}

/// With g the distance to the prism at x and p = min(0, g·(its slope along w)): the distance along the way is at least
/// g + p·t/g, so a triangle is out of reach c when g > c and g² + p > c·g.
PAPILLA_WIDE void mark(const Prisms<const float>& t, int count, const float* x, const float* w, float reach,
                       std::int32_t* mask) {
  const float x0 = x[0], x1 = x[1], x2 = x[2], w0 = w[0], w1 = w[1], w2 = w[2], reach2 = reach * reach;
  for (int block = 0; block < count; block += k_block)
#pragma GCC ivdep
    for (int i = block; i < block + k_block; ++i) {
      const float s = t.n[0][i] * x0 + t.n[1][i] * x1 + t.n[2][i] * x2 - t.middle[i];
      const float ds = std::max(s - t.thick[i], 0.0F) + std::min(s + t.thick[i], 0.0F);
      const float ws = t.n[0][i] * w0 + t.n[1][i] * w1 + t.n[2][i] * w2;
      const float m0 = t.m[0][i] * x0 + t.m[1][i] * x1 + t.m[2][i] * x2 - t.beyond[0][i];
      const float m1 = t.m[3][i] * x0 + t.m[4][i] * x1 + t.m[5][i] * x2 - t.beyond[1][i];
      const float m2 = t.m[6][i] * x0 + t.m[7][i] * x1 + t.m[8][i] * x2 - t.beyond[2][i];
      const float v0 = t.m[0][i] * w0 + t.m[1][i] * w1 + t.m[2][i] * w2;
      const float v1 = t.m[3][i] * w0 + t.m[4][i] * w1 + t.m[5][i] * w2;
      const float v2 = t.m[6][i] * w0 + t.m[7][i] * w1 + t.m[8][i] * w2;
      const float m01 = m0 > m1 ? m0 : m1, v01 = m0 > m1 ? v0 : v1;
      const float dm = std::max(m01 > m2 ? m01 : m2, 0.0F), wm = m01 > m2 ? v01 : v2;
      const float g2 = ds * ds + dm * dm;
      const float left = g2 + std::min(ds * ws + dm * wm, 0.0F);
      const bool apart = (g2 > reach2) & (left > 0.0F) & (left * left > reach2 * g2);
      mask[i] = apart ? 0 : 1;
    }
}

template <class Float, std::size_t N, class Array>
void point_to(Float* (&to)[N], Array& from) noexcept {
  for (std::size_t i = 0; i < N; ++i) to[i] = from[i].data();
}

}  // namespace

void Neighbourhood::begin(Vec3 centre, double reach_m) noexcept {
  centre_ = centre;
  frame_ = {static_cast<float>(centre.x), static_cast<float>(centre.y), static_cast<float>(centre.z)};
  reach_ = reach_m;
  count_ = 0;
}

void Neighbourhood::add(const std::array<float, 3>& a, const std::array<float, 3>& b, const std::array<float, 3>& c,
                        float top, std::uint32_t place) noexcept {
  const std::uint32_t i = count_++;
  for (std::size_t k = 0; k < 3; ++k) {
    corner_[k][i] = a[k] - frame_[k];
    corner_[3 + k][i] = b[k] - frame_[k];
    corner_[6 + k][i] = c[k] - frame_[k];
  }
  top_[i] = top;
  place_[i] = place;
}

void Neighbourhood::finish() noexcept {
  Corners corners{};
  point_to(corners.x, corner_);
  corners.top = top_.data();
  Prisms<float> prisms{};
  point_to(prisms.n, n_);
  point_to(prisms.m, m_);
  point_to(prisms.beyond, beyond_);
  prisms.middle = middle_.data();
  prisms.thick = thick_.data();
  make_prisms(corners, prisms, static_cast<int>(count_));
}

void Neighbourhood::near_way(Vec3 from, Vec3 way, double contact, Mask& mask) const noexcept {
  const Vec3 a =
      from - Vec3{static_cast<double>(frame_[0]), static_cast<double>(frame_[1]), static_cast<double>(frame_[2])};
  const float x[3] = {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
  const float w[3] = {static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z)};
  const auto c = static_cast<float>(contact);
  const float reach = c + 4 * k_margin * (c + size_of(a) + size_of(way));
  Prisms<const float> prisms{};
  point_to(prisms.n, n_);
  point_to(prisms.m, m_);
  point_to(prisms.beyond, beyond_);
  prisms.middle = middle_.data();
  prisms.thick = thick_.data();
  mark(prisms, static_cast<int>(count_), x, w, reach, mask.data());
}

}  // namespace papilla
