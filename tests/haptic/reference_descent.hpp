// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bvh.hpp"
#include "papilla/haptic/contact_mesh.hpp"

namespace papilla::testing {

/// A slow and simple reference of the proxy in double precision: descends |x − goal|² in steps of at most an eighth of
/// the clearance and keeps that clearance to every triangle. The tree only collects near triangles.
class ReferenceDescent {
 public:
  ReferenceDescent(const ContactMesh& mesh, double clearance_m) : mesh_(&mesh), clearance_(clearance_m) {
    items_.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < items_.size(); ++t) {
      items_[t].item = t;
      for (const std::uint32_t v : mesh.triangles[t]) {
        const Vec3 p = mesh.positions[v];
        const std::array<float, 3> f{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        items_[t].box.add(Box3f{f, f});
      }
    }
    tree_ = Bvh(items_);
  }

  /// Distance of `proxy` from the local minimum that a point reaches from `from` towards `goal`. The descent is
  /// repeated with perturbations of up to 0.05 and up to 0.25 of the clearance, because its steps zigzag in creases and
  /// stop early; the nearest of the three minima counts. 0 for a proxy that is nearer to the goal than the descent.
  double gap(Vec3 from, Vec3 goal, Vec3 proxy) {
    Vec3 x = descend(from, goal);
    double least = norm(proxy - x);
    for (const double push : {0.05, 0.25}) {
      x = perturbed(x, goal, push);
      least = std::min(least, norm(proxy - x));
    }
    return norm(goal - proxy) <= norm(goal - x) ? 0 : least;
  }

  /// The least gap() for goals shifted by `aside_m` along an axis. Below the rim of an open sheet, and where a fall
  /// line forks, the minimum is discontinuous in the goal, and both sides are right.
  double gap_shifted(Vec3 from, Vec3 goal, Vec3 proxy, double aside_m) {
    double least = gap(from, goal, proxy);
    for (std::size_t k = 0; k < k_axes; ++k)
      least = std::min(least, gap(from, goal + aside_m * k_directions[k], proxy));
    return least;
  }

  /// The nearest point of all triangles.
  Vec3 nearest(Vec3 p) const {
    double best = 1e3;
    Vec3 found;
    tree_.within(p, best, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        const Vec3 c = closest(items_[i].item, p);
        if (norm(p - c) < best) best = norm(p - c), found = c;
      }
    });
    return found;
  }

 private:
  static constexpr double k_around_m = 3e-4;
  static constexpr std::size_t k_axes = 6;  // The first of the pushes.
  static constexpr std::array<Vec3, 14> k_directions{{{1, 0, 0},
                                                      {-1, 0, 0},
                                                      {0, 1, 0},
                                                      {0, -1, 0},
                                                      {0, 0, 1},
                                                      {0, 0, -1},
                                                      {1, 1, 1},
                                                      {1, 1, -1},
                                                      {1, -1, 1},
                                                      {1, -1, -1},
                                                      {-1, 1, 1},
                                                      {-1, 1, -1},
                                                      {-1, -1, 1},
                                                      {-1, -1, -1}}};

  /// The descent from x, repeated until no perturbation of up to `most` leads nearer to the goal.
  Vec3 perturbed(Vec3 x, Vec3 goal, double most) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const double push : {0.1 * most, most})
        for (std::size_t k = 0; k < k_directions.size() && !moved; ++k) {
          const Vec3 next = descend(x + push * clearance_ * k_directions[k], goal);
          moved = norm(next - goal) < norm(x - goal) - 1e-7;
          if (moved) x = next;
        }
    }
    return x;
  }

  Vec3 descend(Vec3 from, Vec3 goal) {
    Vec3 x = with_clearance(from);
    double now = norm(goal - x);
    for (double longest = clearance_ / 8; longest > 1e-9;) {
      const Vec3 way = allowed(x, goal - x);
      const double length = norm(way);
      if (length < 1e-10) break;
      const Vec3 next = with_clearance(x + std::min(1.0, longest / length) * way);
      const double then = norm(goal - next);
      if (then < now - 1e-12) {
        x = next;
        now = then;
      } else {
        longest *= 0.5;
      }
    }
    return x;
  }

  /// Closest point of a triangle: on the plane where that is inside, else on the edges.
  Vec3 closest(std::uint32_t t, Vec3 p) const {
    const auto& corner = mesh_->triangles[t];
    const Vec3 a = mesh_->positions[corner[0]], b = mesh_->positions[corner[1]], c = mesh_->positions[corner[2]];
    // Slivers are treated as their edges.
    const Vec3 n = cross(b - a, c - a);
    const double longest2 = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    if (norm(n) > 1e-9 * longest2 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
        dot(cross(a - c, p - c), n) >= 0)
      return p - (dot(p - a, n) / dot(n, n)) * n;
    Vec3 best = a;
    for (const auto& [u, v] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const Vec3 e = v - u;
      const double length2 = dot(e, e);
      const Vec3 q = length2 > 0 ? u + std::clamp(dot(p - u, e) / length2, 0.0, 1.0) * e : u;
      if (norm(p - q) < norm(p - best)) best = q;
    }
    return best;
  }

  void collect_near(Vec3 x) {
    if (!near_.empty() && norm(x - centre_) < 0.5 * k_around_m) return;
    near_.clear();
    centre_ = x;
    double radius = k_around_m + clearance_;
    tree_.within(x, radius, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) near_.push_back(items_[i].item);
    });
  }

  Vec3 with_clearance(Vec3 x) {
    for (int round = 0; round < 50; ++round) {
      collect_near(x);
      double least = clearance_ - 1e-10;
      Vec3 at;
      for (const std::uint32_t t : near_) {
        const Vec3 c = closest(t, x);
        if (const double d = norm(x - c); d < least) least = d, at = c;
      }
      if (!(least < clearance_ - 1e-10) || least == 0) break;
      x = at + (clearance_ / least) * (x - at);
    }
    return x;
  }

  /// `way` projected on the cone of directions that enter no touched triangle (Hildreth).
  Vec3 allowed(Vec3 x, Vec3 way) {
    collect_near(x);
    normals_.clear();
    for (const std::uint32_t t : near_) {
      const Vec3 d = x - closest(t, x);
      if (norm(d) < clearance_ + 1e-8) normals_.push_back(normalized(d));
    }
    weights_.assign(normals_.size(), 0);
    for (int round = 0; round < 200; ++round)
      for (std::size_t i = 0; i < normals_.size(); ++i) {
        const double next = std::max(0.0, weights_[i] - dot(way, normals_[i]));
        way = way + (next - weights_[i]) * normals_[i];
        weights_[i] = next;
      }
    return way;
  }

  const ContactMesh* mesh_;
  double clearance_;
  std::vector<BoxedItem> items_;
  Bvh tree_;
  Vec3 centre_;
  std::vector<std::uint32_t> near_;
  std::vector<Vec3> normals_;
  std::vector<double> weights_;
};

}  // namespace papilla::testing
