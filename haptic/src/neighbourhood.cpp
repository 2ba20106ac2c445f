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

constexpr float k_margin = 2e-6F;  // Relative; a dozen roundings of single precision.
constexpr float k_never = 2;
constexpr float k_least = 1e-25F;  // Keeps a quotient finite.

float size_of(Vec3 v) noexcept { return static_cast<float>(std::abs(v.x) + std::abs(v.y) + std::abs(v.z)); }

std::array<float, 3> floats_of(Vec3 v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

/// Whole blocks: what stands behind the last triangle is computed and not looked at.
struct Neighbourhood::Loops {
  static void make_prisms(const Corners& t, Prisms& p) noexcept;
  static void meet(const Prisms& t, const float* x, const float* w, float reach, float least, float* earliest) noexcept;
  static void distances(const Prisms* prisms, std::uint32_t blocks, const float* x, float* least) noexcept;
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
    const float hx = (ax + bx + cx) / 3, hy = (ay + by + cy) / 3, hz = (az + bz + cz) / 3;
    const auto from_hub2 = [=](float x, float y, float z) {
      return (x - hx) * (x - hx) + (y - hy) * (y - hy) + (z - hz) * (z - hz);
    };
    p.hub[0][i] = hx, p.hub[1][i] = hy, p.hub[2][i] = hz;
    p.radius[i] =
        std::sqrt(std::max(from_hub2(ax, ay, az), std::max(from_hub2(bx, by, bz), from_hub2(cx, cy, cz)))) + more;
  }
}

/// With g the distance to the prism at x and p/g its slope along w, the distance at x + t·w is at least g + t·p/g:
/// reach c is not met before t = (g − c)·g/−p, and what lies below g + p/g not at all.
PAPILLA_WIDE void Neighbourhood::Loops::meet(const Prisms& t, const float* x, const float* w, float reach, float least,
                                             float* earliest) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2], w0 = w[0], w1 = w[1], w2 = w[2];
#pragma GCC ivdep
  for (std::size_t i = 0; i < k_lanes; ++i) {
    const float s = t.n[0][i] * x0 + t.n[1][i] * x1 + t.n[2][i] * x2 - t.middle[i];
    const float ds = std::max(s - t.thick[i], 0.0F) + std::min(s + t.thick[i], 0.0F);
    const float ws = t.n[0][i] * w0 + t.n[1][i] * w1 + t.n[2][i] * w2;
    const float m0 = t.m[0][i] * x0 + t.m[1][i] * x1 + t.m[2][i] * x2 - t.beyond[0][i];
    const float m1 = t.m[3][i] * x0 + t.m[4][i] * x1 + t.m[5][i] * x2 - t.beyond[1][i];
    const float m2 = t.m[6][i] * x0 + t.m[7][i] * x1 + t.m[8][i] * x2 - t.beyond[2][i];
    const float v0 = t.m[0][i] * w0 + t.m[1][i] * w1 + t.m[2][i] * w2;
    const float v1 = t.m[3][i] * w0 + t.m[4][i] * w1 + t.m[5][i] * w2;
    const float v2 = t.m[6][i] * w0 + t.m[7][i] * w1 + t.m[8][i] * w2;
    const float h0 = x0 - t.hub[0][i], h1 = x1 - t.hub[1][i], h2 = x2 - t.hub[2][i];
    const float up = t.n[0][i] * h0 + t.n[1][i] * h1 + t.n[2][i] * h2;
    const float l0 = h0 - up * t.n[0][i], l1 = h1 - up * t.n[1][i], l2 = h2 - up * t.n[2][i];
    const float across = std::sqrt(std::max(l0 * l0 + l1 * l1 + l2 * l2, k_least));
    const float m3 = across - t.radius[i], v3 = (l0 * w0 + l1 * w1 + l2 * w2) / across;
    const float m01 = std::max(m0, m1), v01 = m0 > m1 ? v0 : v1;
    const float m23 = std::max(m2, m3), v23 = m2 > m3 ? v2 : v3;
    const float dm = std::max(std::max(m01, m23), 0.0F), wm = m01 > m23 ? v01 : v23;
    const float g = std::sqrt(ds * ds + dm * dm);
    const float approach = std::max(-(ds * ws + dm * wm), k_least);
    const float met = std::max((g - reach) * g / approach * (1 - k_margin), 0.0F);
    earliest[i] = (g - least) * g > approach ? k_never : met;
  }
}

PAPILLA_WIDE void Neighbourhood::Loops::distances(const Prisms* prisms, std::uint32_t blocks, const float* x,
                                                  float* least) noexcept {
  const float x0 = x[0], x1 = x[1], x2 = x[2];
  for (std::uint32_t block = 0; block < blocks; ++block) {
    const Prisms& t = prisms[block];
    float least2 = 1e30F;
    for (std::size_t i = 0; i < k_lanes; ++i) {
      const float s = t.n[0][i] * x0 + t.n[1][i] * x1 + t.n[2][i] * x2 - t.middle[i];
      const float ds = std::max(std::abs(s) - t.thick[i], 0.0F);
      const float m0 = t.m[0][i] * x0 + t.m[1][i] * x1 + t.m[2][i] * x2 - t.beyond[0][i];
      const float m1 = t.m[3][i] * x0 + t.m[4][i] * x1 + t.m[5][i] * x2 - t.beyond[1][i];
      const float m2 = t.m[6][i] * x0 + t.m[7][i] * x1 + t.m[8][i] * x2 - t.beyond[2][i];
      const float h0 = x0 - t.hub[0][i], h1 = x1 - t.hub[1][i], h2 = x2 - t.hub[2][i];
      const float up = t.n[0][i] * h0 + t.n[1][i] * h1 + t.n[2][i] * h2;
      const float l0 = h0 - up * t.n[0][i], l1 = h1 - up * t.n[1][i], l2 = h2 - up * t.n[2][i];
      const float m3 = std::sqrt(l0 * l0 + l1 * l1 + l2 * l2) - t.radius[i];
      const float dm = std::max(std::max(std::max(m0, m1), std::max(m2, m3)), 0.0F);
      least2 = std::min(least2, ds * ds + dm * dm);
    }
    least[block] = std::sqrt(least2);
  }
}

void Neighbourhood::begin(Vec3 centre, double reach_m) noexcept {
  centre_ = centre;
  frame_ = {static_cast<float>(centre.x), static_cast<float>(centre.y), static_cast<float>(centre.z)};
  reach_ = reach_m;
  count_ = cluster_count_ = 0;
}

bool Neighbourhood::add_cluster(std::uint32_t cluster) noexcept {
  if (cluster_count_ == k_clusters) return false;
  cluster_[cluster_count_++] = cluster;
  return true;
}

bool Neighbourhood::add(const std::array<float, 3>& a, const std::array<float, 3>& b, const std::array<float, 3>& c,
                        float top, std::uint32_t place) noexcept {
  if (count_ == k_capacity) return false;
  const std::uint32_t lane = count_ % k_lanes;
  for (std::size_t k = 0; k < 3; ++k) {
    corners_.x[k][lane] = a[k] - frame_[k];
    corners_.x[3 + k][lane] = b[k] - frame_[k];
    corners_.x[6 + k][lane] = c[k] - frame_[k];
  }
  corners_.top[lane] = top;
  place_[count_++] = place;
  if (count_ % k_lanes == 0) Loops::make_prisms(corners_, prisms_[count_ / k_lanes - 1]);
  return true;
}

void Neighbourhood::finish() noexcept {
  if (count_ % k_lanes != 0) Loops::make_prisms(corners_, prisms_[count_ / k_lanes]);
  focus(centre_);
}

Vec3 Neighbourhood::in_frame(Vec3 p) const noexcept {
  return p - Vec3{static_cast<double>(frame_[0]), static_cast<double>(frame_[1]), static_cast<double>(frame_[2])};
}

void Neighbourhood::focus(Vec3 centre) noexcept {
  focus_centre_ = centre;
  const Vec3 at = in_frame(centre);
  const std::array<float, 3> x = floats_of(at);
  Loops::distances(prisms_.data(), block_count(), x.data(), least_.data());
  const float error = 4 * k_margin * size_of(at);
  for (std::uint32_t b = 0; b < block_count(); ++b) least_[b] = least_[b] * (1 - k_margin) - error;
}

std::uint32_t Neighbourhood::blocks(Vec3 from, double distance, Blocks& numbers) const noexcept {
  const auto most = static_cast<float>((off_focus(from) + distance) * (1 + static_cast<double>(k_margin)));
  std::uint32_t count = 0;
  for (std::uint32_t b = 0; b < block_count(); ++b) {
    numbers[count] = b;
    count += least_[b] <= most ? 1U : 0U;
  }
  return count;
}

void Neighbourhood::near_way(std::uint32_t block, Vec3 from, Vec3 way, double contact, double deep,
                             std::array<float, k_lanes>& earliest) const noexcept {
  const Vec3 at = in_frame(from);
  const std::array<float, 3> x = floats_of(at), w = floats_of(way);
  const auto c = static_cast<float>(contact);
  const float error = 4 * k_margin * (c + size_of(at) + size_of(way));
  Loops::meet(prisms_[block], x.data(), w.data(), c + error, c + error - static_cast<float>(deep), earliest.data());
}

}  // namespace papilla
