// SPDX-License-Identifier: MIT
#include "papilla/haptic/textured_normal.hpp"

#include "papilla/haptic/force_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace papilla {
namespace {

constexpr int k_rings = 2, k_around = 6, k_descents = 2;
constexpr int k_evaluations = 24;          // Of a descent.
constexpr double k_settled = 1e-4;         // Of the depth: a shorter step is the last.
constexpr double k_sufficient = 1e-4;      // Armijo.
constexpr double k_least_gradient = 1e-6;  // Of the distance.

/// Squared distance from the probe to the textured point above a place of the base.
struct Textured {
  Vec3 base;
  Vec3 way;                                               ///< From the probe.
  Vec2 gradient;                                          ///< Of |way|²/2 along the two tangents of the search.
  double half = std::numeric_limits<double>::infinity();  ///< |way|²/2.
};

class Search {
 public:
  Search(const ContactSurface& surface, Vec3 probe, const SurfacePoint& foot, double depth) noexcept
      : surface_(&surface), probe_(probe), normal_(foot.face_normal), depth_(depth) {
    const Vec3 axis = std::abs(normal_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    u_ = normalized(cross(normal_, axis));
    v_ = cross(normal_, u_);
  }

  Textured at(Vec3 place) const noexcept {
    Textured result;
    result.base = place;
    const auto near =
        surface_->closest_point(place, depth_ + surface_->contact_radius_m() + surface_->tallest_relief_m());
    if (!near || dot(near->face_normal, normal_) <= 0) return result;
    result.base = near->point;
    result.way = near->point + (near->height_m + surface_->probe_radius_m()) * near->face_normal - probe_;
    result.half = 0.5 * dot(result.way, result.way);
    const Vec3 rise = dot(result.way, near->face_normal) * near->slope;
    const Vec3 flat = result.way - dot(result.way, near->face_normal) * near->face_normal;
    result.gradient = {dot(flat + rise, u_), dot(flat + rise, v_)};
    return result;
  }

  Vec3 around(Vec3 base, double radius, double angle) const noexcept {
    return base + radius * (std::cos(angle) * u_ + std::sin(angle) * v_);
  }

  Textured descended(Textured now) const noexcept {
    double a = 1, b = 0, c = 1;  // The inverse Hessian (a b; b c).
    for (int i = 0; i < k_evaluations;) {
      const Vec2 g = now.gradient;
      if (!(norm(g) > k_least_gradient * depth_)) break;
      Vec2 step{-(a * g.x + b * g.y), -(b * g.x + c * g.y)};
      if (!(dot(step, g) < 0)) a = c = 1, b = 0, step = -1 * g;
      if (const double length = norm(step); length > depth_) step = (depth_ / length) * step;
      Textured next;
      for (; i < k_evaluations; ++i, step = 0.5 * step) {
        next = at(now.base + step.x * u_ + step.y * v_);
        if (next.half <= now.half + k_sufficient * dot(step, g)) break;
      }
      ++i;
      if (!(next.half < now.half)) break;
      const Vec2 y = next.gradient - g;
      const double sy = dot(step, y);
      now = next;
      if (norm(step) < k_settled * depth_) break;
      if (!(sy > 0)) {
        a = c = 1, b = 0;
        continue;
      }
      // B ← (1 − s yᵀ/sy) B (1 − y sᵀ/sy) + s sᵀ/sy
      const Vec2 by{a * y.x + b * y.y, b * y.x + c * y.y};
      const double factor = (1 + dot(y, by) / sy) / sy;
      a += factor * step.x * step.x - 2 * by.x * step.x / sy;
      b += factor * step.x * step.y - (by.x * step.y + by.y * step.x) / sy;
      c += factor * step.y * step.y - 2 * by.y * step.y / sy;
    }
    return now;
  }

 private:
  const ContactSurface* surface_;
  Vec3 probe_, normal_, u_, v_;
  double depth_;
};

}  // namespace

Vec3 way_to_textured_surface(const ContactSurface& surface, const ProxyState& state, Vec3 probe) noexcept {
  if (!state.in_contact) return {};
  const Vec3 to_proxy = state.load_m * state.normal;
  const double reach = norm(state.proxy - probe) + surface.contact_radius_m() + surface.tallest_relief_m();
  const auto foot = surface.closest_point(probe, reach);
  if (!foot || dot(foot->face_normal, state.normal) <= 0) return to_proxy;

  const double above = dot(probe - foot->point, foot->face_normal);
  const bool in_front = above >= 0;
  const double radius = surface.probe_radius_m();
  const Vec3 outside = foot->point + (foot->height_m + surface.contact_radius_m()) * foot->face_normal;
  if (surface.crossings(state.proxy, outside) != 0) return to_proxy;
  const double cosine = foot->on_border && foot->distance_m > 0 ? above / foot->distance_m : 1;
  const double depth =
      radius + (in_front ? cosine * foot->height_m - foot->distance_m : foot->height_m + foot->distance_m);
  if (!(depth > 0)) return {};

  const Search search(surface, probe, *foot, depth);
  std::array<Textured, 2 + k_rings * k_around> places;
  places[0] = search.at(foot->point);
  places[1] = search.at(state.proxy - dot(state.proxy - foot->point, foot->face_normal) * foot->face_normal);
  const double below = std::max(0.0, radius - above);
  const double farthest = std::sqrt(std::max(0.0, depth * depth - below * below));
  for (int ring = 0, i = 2; ring < k_rings; ++ring)
    for (int k = 0; k < k_around; ++k, ++i)
      places[static_cast<std::size_t>(i)] = search.at(search.around(
          foot->point, farthest * (ring + 1) / (k_rings + 1), 2 * std::numbers::pi * (k + 0.5 * ring) / k_around));
  std::partial_sort(places.begin(), places.begin() + k_descents, places.end(),
                    [](const Textured& a, const Textured& b) noexcept { return a.half < b.half; });
  Textured best;
  for (std::size_t i = 0; i < k_descents; ++i)
    if (const Textured found = search.descended(places[i]); found.half < best.half) best = found;
  return std::isfinite(best.half) ? best.way : to_proxy;
}

Vec3 textured_normal_force(const ContactMaterial& material, Vec3 way, Vec3 velocity) noexcept {
  const double depth = norm(way);
  if (!(depth > 0)) return {};
  const Vec3 n = (1 / depth) * way;
  const double spring = spring_force(material, material.stiffness, depth);
  return (spring - std::clamp(material.damping * dot(velocity, n), -spring, spring)) * n;
}

}  // namespace papilla
