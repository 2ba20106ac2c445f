// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "contact_sweep.hpp"

namespace papilla {
namespace {

constexpr int k_march_steps = 512;      // Most steps over a relief, whatever the number of its texels.
constexpr double k_nearer = 0.5;        // Of the rest of the segment: next share tried by stays_clear().
constexpr int k_level_steps = 24;       // Bound of the regula falsi.
constexpr double k_above_level = 1e-4;  // Of the tolerance: accuracy of the level.

}  // namespace

/// The clearance at a parameter of the segment.
struct ContactTriangles::WaySample {
  double t, value;
  Vec3 gradient;
};

/// Whether a segment, from `a` to `b` relative to the place of the sample that is known, provably stays clear. The
/// triangle lies behind the plane through the foot orthogonal to `d`, which bounds the distance from below; the foot
/// moves no farther than the probe does along the face, which bounds the relief by its steepest slope; and the cosine
/// is at most that of the highest point of the segment at that distance. All three are largest or least at an end. The
/// skin makes the relief no steeper.
bool ContactTriangles::stays_clear(const KnownFace& known, Vec3 a, Vec3 b) const noexcept {
  const Clearance& now = known.clearance;
  const Face& face = known.face;
  const double nearest = now.distance + std::min({0.0, dot(now.d, a), dot(now.d, b)}) / now.distance;
  const double room = nearest - contact_radius_m();
  if (!(room > 0)) return false;
  const double up_a = dot(face.normal, a), up_b = dot(face.normal, b);
  const double highest = dot(face.normal, now.d) + std::max({0.0, up_a, up_b});
  const double cosine = std::clamp(highest / nearest, 0.0, 1.0);
  const double slide = std::sqrt(std::max({0.0, dot(a, a) - up_a * up_a, dot(b, b) - up_b * up_b}));
  return room > cosine * std::min(face.top, now.lift + face.steepest * slide) + tolerance_m();
}

/// The value of the clearance at x from the tangent of the place beside it that is known; nothing when that is farther
/// than the tolerance.
std::optional<double> ContactTriangles::foretold(const KnownFace& known, Vec3 x) const noexcept {
  const Vec3 off = x - known.x;  // Not a number for a face that is new.
  if (!(dot(off, off) <= tolerance_m() * tolerance_m())) return std::nullopt;
  return known.clearance.value + dot(known.clearance.gradient, off);
}

/// Marches over the relief, each time as far as stays_clear() proves or half a texel, and refines the contact in the
/// step that enters.
void ContactTriangles::sweep_relief(std::uint32_t place, Sweep& sweep) const noexcept {
  std::optional<KnownFace> lone;
  KnownFace& known = sweep.known != nullptr ? sweep.known->of(place) : lone.emplace();
  if (known.place != place) known = known_face(place);
  const Face& face = known.face;
  const Vec3 from = sweep.from, way = sweep.way;
  double begin = 0, t_max = sweep.until();
  if (!limit_to_room(known, from, way, begin, t_max)) return;
  const double length = norm(way), reach = contact_radius_m() + face.top;
  const auto clear_from = [&](double t, double to) noexcept {
    return stays_clear(known, from + t * way - known.x, from + to * way - known.x);
  };
  if (known.clearance.distance > 0 && clear_from(begin, t_max)) return;
  WaySample now{begin, 0, known.clearance.gradient};
  if (const auto value = foretold(known, from + begin * way); value && known.clearance.distance <= reach) {
    now.value = *value;
  } else {
    Approach entry;
    move_approach(face.t, from, way, begin, entry);
    if (!advance(face.t, from, way, reach, reach - tolerance_m(), t_max, entry)) return;
    now = sample(known, from, way, entry.t);
  }
  const Vec2 weights = face.weights_of(way);
  const double texels = norm(weights.x * face.texel_v + weights.y * face.texel_w);
  const double finest = std::max(0.5 / std::max(texels, 0.5), 1.0 / k_march_steps);

  // In a hollow every tangent enters at once: half the tolerance lets the probe move on.
  const double level = -0.5 * tolerance_m(), close = k_above_level * tolerance_m();
  WaySample outside = now;
  double allowed = -tolerance_m();
  bool has_guessed = false;
  for (bool first = true;; first = false) {
    const double descent = -dot(now.gradient, way);
    // A probe that is too deep at the start may rise.
    if (now.value < allowed && (!first || descent > 0)) break;
    allowed = std::min(-tolerance_m(), now.value);
    if (now.value >= level) outside = now;
    if (now.t >= t_max) return;
    // Never past the base, behind which the clearance grows again.
    const double base = std::max(0.5 * known.clearance.distance, tolerance_m());
    double next = std::min(t_max, now.t + std::min(finest, base / length));
    if (!(next > now.t)) break;  // The step is below the resolution of t.
    if (now.value > tolerance_m()) {
      if (clear_from(now.t, t_max)) return;
      double clear = k_nearer * (t_max - now.t);
      while (now.t + clear > next && !clear_from(now.t, now.t + clear)) clear *= k_nearer;
      next = std::max(next, now.t + clear);
    }
    // Most ways down end where the tangent of their start says.
    const double above = now.value - level - close;
    const bool guesses = !has_guessed && above > close && above < (next - now.t) * descent;
    has_guessed = has_guessed || guesses;
    now = sample(known, from, way, guesses ? now.t + above / descent : next);
    if (guesses && std::abs(now.value - level - close) <= close && (t_max - now.t) * descent > tolerance_m()) {
      outside = now;
      break;
    }
  }
  const WaySample there = find_level(known, from, way, level, outside, now);
  sweep.add({there.t, normalized(there.gradient), -there.value, source_of(place), material_of(place), place, {}},
            false);
}

ContactTriangles::WaySample ContactTriangles::sample(KnownFace& known, Vec3 from, Vec3 way, double t) const noexcept {
  known.x = from + t * way;
  known.clearance = clearance_of(known.face, known.x);
  return {t, known.clearance.value, known.clearance.gradient};
}

/// The sample between two where the clearance falls to the level, at most k_above_level above it: regula falsi with
/// halved weights of the end that stays (Illinois) [Dowell and Jarratt, BIT 11, 1971].
ContactTriangles::WaySample ContactTriangles::find_level(KnownFace& known, Vec3 from, Vec3 way, double level,
                                                         WaySample outside, const WaySample& inside) const noexcept {
  const double close = k_above_level * tolerance_m(), target = level + close;
  double above = outside.value - target, below = inside.value - target, end = inside.t;
  bool moved_outside = false, moved_inside = false;
  for (int step = 0; step < k_level_steps && outside.value > target + close && end - outside.t > 1e-9; ++step) {
    const double at = outside.t + (end - outside.t) * above / (above - below);
    const WaySample now = sample(known, from, way, at);
    if (now.value >= level) {
      if (moved_outside) below *= 0.5;
      outside = now;
      above = now.value - target;
    } else {
      if (moved_inside) above *= 0.5;
      end = at;
      below = now.value - target;
    }
    moved_outside = outside.t == at;
    moved_inside = !moved_outside;
  }
  return outside;
}

}  // namespace papilla
