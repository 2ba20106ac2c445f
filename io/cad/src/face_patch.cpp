// SPDX-License-Identifier: MIT
#include "face_patch.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace papilla::cad {

bool FacePatch::connect() {
  struct Side {
    Index low, high;
    HalfEdge h;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (HalfEdge h = 0; h < 3 * triangles.size(); ++h)
    sides.push_back({std::min(from(h), to(h)), std::max(from(h), to(h)), h});
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.low, a.high, a.h) < std::tie(b.low, b.high, b.h); });
  opposite_.assign(3 * triangles.size(), k_no_value);
  fixed_.resize(3 * triangles.size(), 0);
  bool manifold = true;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    const bool pair = end == i + 2 && from(sides[i].h) == to(sides[i + 1].h);
    if (pair) link(sides[i].h, sides[i + 1].h);
    manifold = manifold && (pair || end == i + 1);
    i = end;
  }
  return manifold;
}

void FacePatch::fix(HalfEdge h) {
  fixed_[h] = 1;
  if (!is_boundary(h)) fixed_[opposite_[h]] = 1;
}

void FacePatch::link(HalfEdge a, HalfEdge b) {
  if (a != k_no_value) opposite_[a] = b;
  if (b != k_no_value) opposite_[b] = a;
}

HalfEdge FacePatch::split(HalfEdge h, Index m) {
  // (a, b, c) becomes (a, m, c) and (m, b, c); on the other side (b, a, d) becomes (b, m, d) and (m, a, d).
  const auto cut = [&](HalfEdge edge) {
    const Index b = to(edge), c = apex(edge);
    const HalfEdge bc = next(edge), added = static_cast<HalfEdge>(3 * triangles.size());
    triangles.push_back({m, b, c});
    opposite_.resize(opposite_.size() + 3, k_no_value);
    fixed_.resize(fixed_.size() + 3, 0);
    triangles[bc / 3][bc % 3] = m;
    link(added + 1, opposite_[bc]);
    link(added + 2, bc);
    fixed_[added] = fixed_[edge];
    fixed_[added + 1] = fixed_[bc];
    fixed_[bc] = 0;
    return added;
  };
  const HalfEdge other = opposite_[h];
  const HalfEdge rest = cut(h);
  if (other == k_no_value) return rest;
  const HalfEdge other_rest = cut(other);
  link(h, other_rest);
  link(rest, other);
  return rest;
}

void FacePatch::insert(std::uint32_t triangle, Index m) {
  const auto [a, b, c] = triangles[triangle];
  const HalfEdge ab = 3 * triangle, bc = ab + 1, ca = ab + 2;
  const auto first = static_cast<HalfEdge>(3 * triangles.size()), second = first + 3;
  triangles[triangle] = {a, b, m};
  triangles.push_back({b, c, m});
  triangles.push_back({c, a, m});
  opposite_.resize(opposite_.size() + 6, k_no_value);
  fixed_.resize(fixed_.size() + 6, 0);
  link(first, opposite_[bc]);
  link(second, opposite_[ca]);
  fixed_[first] = std::exchange(fixed_[bc], std::uint8_t{0});
  fixed_[second] = std::exchange(fixed_[ca], std::uint8_t{0});
  link(bc, first + 2);
  link(first + 1, second + 2);
  link(second + 1, ca);
}

void FacePatch::flip(HalfEdge h) {
  // (a, b, c) and (b, a, d) become (c, d, b) and (d, c, a).
  const HalfEdge g = opposite_[h];
  const HalfEdge bc = next(h), ca = next(bc), ad = next(g), db = next(ad);
  const Index a = from(h), b = to(h), c = apex(h), d = apex(g);
  const std::array<HalfEdge, 4> outer = {opposite_[bc], opposite_[ca], opposite_[ad], opposite_[db]};
  const std::array<std::uint8_t, 4> fixed = {fixed_[bc], fixed_[ca], fixed_[ad], fixed_[db]};
  const auto set = [&](HalfEdge edge, Index start) { triangles[edge / 3][edge % 3] = start; };
  set(h, c), set(bc, d), set(ca, b);
  set(g, d), set(ad, c), set(db, a);
  link(bc, outer[3]), link(ca, outer[0]), link(ad, outer[1]), link(db, outer[2]);
  fixed_[bc] = fixed[3], fixed_[ca] = fixed[0], fixed_[ad] = fixed[1], fixed_[db] = fixed[2];
}

void FacePatch::merge(const std::vector<Index>& same) {
  if (same.size() < 2) return;
  for (Triangle& t : triangles)
    for (Index& node : t)
      if (std::find(same.begin(), same.end(), node) != same.end()) node = same.front();
}

bool FacePatch::remove(const std::vector<std::uint8_t>& gone) {
  fixed_.resize(3 * triangles.size(), 0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (gone[i] != 0) continue;
    std::copy_n(fixed_.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                fixed_.begin() + static_cast<std::ptrdiff_t>(3 * kept));
    triangles[kept++] = triangles[i];
  }
  triangles.resize(kept);
  fixed_.resize(3 * kept);
  return connect();
}

std::vector<HalfEdge> FacePatch::around(HalfEdge h) const {
  std::vector<HalfEdge> ring;
  HalfEdge g = h;
  do {
    ring.push_back(g);
    g = opposite_[next(next(g))];
  } while (g != h && g != k_no_value);
  if (g == k_no_value)
    for (g = opposite_[h]; g != k_no_value; g = opposite_[g]) ring.push_back(g = next(g));
  return ring;
}

void FacePatch::collapse(HalfEdge h) {
  // (v, w, c) and (w, v, d) collapse onto the edges w-c and w-d.
  const Index w = to(h);
  for (const HalfEdge g : around(h)) triangles[g / 3][g % 3] = w;
  for (const HalfEdge side : {h, opposite_[h]}) {
    const HalfEdge one = next(side), other = next(one);
    const std::uint8_t fixed = fixed_[one] | fixed_[other];
    for (const HalfEdge outer : {opposite_[one], opposite_[other]})
      if (outer != k_no_value) fixed_[outer] = fixed;
    link(opposite_[one], opposite_[other]);
    triangles[side / 3] = {w, w, w};
  }
}

std::vector<std::uint32_t> FacePatch::in_rings() const {
  std::vector<std::uint32_t> order;
  order.reserve(triangles.size());
  std::vector<std::uint8_t> reached(triangles.size(), 0);
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (reached[first] != 0) continue;
    reached[first] = 1;
    order.push_back(first);
    for (std::size_t i = order.size() - 1; i < order.size(); ++i)
      for (HalfEdge h = 3 * order[i]; h < 3 * order[i] + 3; ++h) {
        if (is_boundary(h) || reached[opposite(h) / 3] != 0) continue;
        reached[opposite(h) / 3] = 1;
        order.push_back(opposite(h) / 3);
      }
  }
  return order;
}

Vec2 FacePatch::uv_in(std::uint32_t triangle, const std::array<double, 3>& w) const {
  double u = 0, v = 0, u_weight = 0, v_weight = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const PatchNode& node = nodes[triangles[triangle][k]];
    if (!node.free_u) u += w[k] * node.uv.x, u_weight += w[k];
    if (!node.free_v) v += w[k] * node.uv.y, v_weight += w[k];
  }
  const PatchNode& first = nodes[triangles[triangle][0]];
  return {u_weight > 0 ? u / u_weight : first.uv.x, v_weight > 0 ? v / v_weight : first.uv.y};
}

Vec2 FacePatch::corner_uv(std::uint32_t triangle, std::size_t k) const {
  const PatchNode& node = nodes[triangles[triangle][k]];
  Vec2 uv = node.uv;
  if (!node.is_singular()) return uv;
  std::array<double, 3> others = {0.5, 0.5, 0.5};
  others[k] = 0;
  const Vec2 mean = uv_in(triangle, others);
  if (node.free_u) uv.x = mean.x;
  if (node.free_v) uv.y = mean.y;
  return uv;
}

Vec2 FacePatch::middle_uv(Index a, Index b) const {
  const PatchNode &p = nodes[a], &q = nodes[b];
  const auto middle = [](double x, bool x_free, double y, bool y_free) {
    return x_free == y_free ? 0.5 * (x + y) : x_free ? y : x;
  };
  return {middle(p.uv.x, p.free_u, q.uv.x, q.free_u), middle(p.uv.y, p.free_v, q.uv.y, q.free_v)};
}

Vec3 FacePatch::point_in(std::uint32_t triangle, const std::array<double, 3>& w) const {
  const Triangle& t = triangles[triangle];
  return w[0] * nodes[t[0]].position + w[1] * nodes[t[1]].position + w[2] * nodes[t[2]].position;
}

}  // namespace papilla::cad
