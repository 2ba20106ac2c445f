// SPDX-License-Identifier: MIT
#include "papilla/haptic/proxy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constraint_set.hpp"
#include "papilla/haptic/friction.hpp"

namespace papilla {
namespace {

/// Of the shortest step. Near the end a step of s brings only s²/2·depth.
constexpr double k_least_gain = 0.02;
// Of the probe's way in the tick: what a tick needs around the proxy, and what is gathered for the ticks to come.
constexpr double k_needed_travels = 0.3, k_wanted_travels = 3;
constexpr double k_lead = 0.5;   // Of what is gathered: how far before the proxy its centre lies.
constexpr int k_pieces = 3;      // Of a way, each with what is gathered where it begins; what is longer asks the tree.
constexpr double k_far = 1.5;    // Of the probe's way: a proxy that goes farther slips down a slope.
constexpr int k_hops = 6;        // Down a slope.
constexpr double k_lift = 0.25;  // Of the skin: how deep a hollow may be that holds no proxy.
constexpr int k_leap_sweeps = 4 * k_hops;  // At most: up, along, down, and off a rim.
// Radii aside for one down: a straight way around a rim that cuts 3 % of the radius off.
constexpr double k_around = 4;
constexpr int k_few = 8;             // Sweeps; one that took more of them has felt its way.
constexpr double k_held = 0.1;       // Of the probe's way: a proxy that goes no farther is held.
constexpr double k_regrowth = 1.01;  // Per tick, after more was asked for than fits.
constexpr double k_same_normal = 0.95;
constexpr double k_same_way = 0.9;      // Cosine of the angle between two steps along a crease.
constexpr double k_longest_stride = 4;  // Of what the planes say, where a crease goes on and on.
constexpr double k_drop = 8;            // Of the shortest step: twice as far as a resting proxy can be off.

}  // namespace

/// What came of one hop: nothing nearer is there, the way is not free, or the proxy was moved.
enum class Proxy::Hop { none, blocked, moved };

/// Where the proxy was, where the probe is seen from there, how far that has come, and how far one hop may lead.
struct Proxy::Tick {
  Vec3 start, goal;
  double travel, farthest;
};

/// What came of a few hops: how the last one ended, and the place they were aimed at.
struct Proxy::Leap {
  Hop last = Hop::none;
  Vec3 aim{};
};

/// The step before along a crease, which bends while the step is straight.
struct Proxy::Stride {
  Vec3 direction;
  double length = 0, wanted = 0;  ///< As far as it went, and as far as the planes said.

  void take(Vec3 step, double step_wanted) noexcept {
    length = norm(step);
    wanted = step_wanted;
    direction = (1 / length) * step;
  }

  /// How much longer or shorter the next step has to be than the planes say. From one to the next, what they say
  /// changes in proportion to the way that was gone, so that the secant leads to where they say that it is there.
  /// @param farthest how far it may go at most.
  double factor(Vec3 step, double step_wanted, double farthest) const noexcept {
    const double along = dot(step, direction), fall = wanted - along;
    if (length == 0 || std::abs(along) < k_same_way * step_wanted) return 1;
    const double secant = fall > 0 ? std::abs(along) * length / fall : k_longest_stride * step_wanted;
    return std::min(secant, farthest) / step_wanted;
  }
};

/// The half-spaces found in this tick, in coordinates around the proxy of the tick's start.
struct Proxy::Planes {
  HalfSpace plane[k_planes];
  Vec3 found_at[k_planes];
  int count = 0;

  void add(const HalfSpace& found, Vec3 at) noexcept {
    found_at[count] = at;
    plane[count++] = found;
  }

  void keep(std::uint32_t active) noexcept {
    int kept = 0;
    for (int i = 0; i < count; ++i)
      if (active >> i & 1U) {
        found_at[kept] = found_at[i];
        plane[kept++] = plane[i];
      }
    count = kept;
  }
};

void Proxy::reset(Vec3 position) noexcept {
  state_ = ProxyState{};
  state_.proxy = position;
  probe_ = position;
  near_.clear();
  held_count_ = turn_count_ = 0;
  slide_speed_ = 0;
  started_ = true;
}

double Proxy::friction(const ContactMaterial& m) const noexcept {
  return m.friction == FrictionModel::coulomb ? friction_coefficient(m, slide_speed_) : 0;
}

/// Remembers the planes that hold the proxy at x, if all of them were found there.
void Proxy::remember(const Planes& planes, std::uint32_t active, Vec3 x) noexcept {
  for (int i = 0; i < planes.count; ++i) {
    if (!(active >> i & 1U)) continue;
    const HalfSpace& plane = planes.plane[i];
    if (!(x == planes.found_at[i])) {
      held_count_ = 0;
      return;
    }
    held_[static_cast<std::size_t>(held_count_++)] = {plane.normal, plane.offset - dot(plane.normal, x),
                                                      plane.material};
  }
}

/// The planes that held the proxy when the tick before ended: it hasn't moved since, so they need not be found anew as
/// long as the probe pulls into them.
void Proxy::recall(Vec3 goal, Planes& planes) noexcept {
  bool pulls = false;
  for (int i = 0; i < held_count_; ++i) {
    const Held& held = held_[static_cast<std::size_t>(i)];
    planes.add({held.normal, held.offset, held.material}, {});
    pulls = pulls || dot(held.normal, goal) < held.offset;
  }
  if (!pulls) planes.count = 0;
  held_count_ = 0;
}

/// Says what holds the proxy when it wants to go to `aim` and would like to be at `goal`.
void Proxy::hold(const ConstrainedPoint& aim, const Planes& planes, Vec3 goal, ProxyState& next) const noexcept {
  const Vec3 behind = aim.point - goal;
  const double depth = norm(behind);
  int loaded = 0;
  while (!(aim.active >> loaded & 1U)) ++loaded;
  next.in_contact = true;
  next.constraints = aim.count;
  next.normal = depth > 0 ? (1 / depth) * behind : planes.plane[loaded].normal;
  next.load_m = std::max(0.0, depth - surface_->skin_m());
  next.material = planes.plane[loaded].material;
}

void Proxy::turn(Vec3 at) noexcept { turns_[static_cast<std::size_t>(turn_count_++)] = at; }

/// Sees to it that what lies within `needed` of `from` is gathered, unless that is too much.
void Proxy::look_around(Vec3 from, double needed, double travel) noexcept {
  if (surface_->margin(from, near_) < needed) gather(from, needed, travel);
}

void Proxy::gather(Vec3 from, double needed, double travel) noexcept {
  const double radius = std::min(k_wanted_travels * travel + 4 * surface_->skin_m(), widest_m_);
  if ((1 - k_lead) * radius < needed) {
    near_.forget_place();
    widest_m_ *= k_regrowth;
  } else if (!surface_->gather(from + (k_lead * radius) * ahead_, radius, near_)) {
    widest_m_ = 0.5 * radius;
  } else if (near_.blocks() < Neighbourhood::k_blocks / 8) {
    widest_m_ = std::max(widest_m_, 2 * radius);
  }
}

/// ContactSurface::sweep(); a way that leaves what is gathered goes on with what is gathered where it does.
std::optional<SweepHit> Proxy::sweep(Vec3 from, Vec3 way, double travel) noexcept {
  double seen = 0;
  for (int piece = 0; piece < k_pieces; ++piece) {
    const double here = std::min(travel, norm(way));
    look_around(from + seen * way, k_needed_travels * here + surface_->skin_m(), here);
    const double before = seen;
    const auto hit = surface_->sweep(from, from + way, near_, seen);
    if (hit || seen >= 1) return hit;
    if (!(seen > before)) break;
  }
  return surface_->sweep(from, from + way);
}

/// Whether the planes that hold the proxy in a crease are still there: it may have slid past what one was found on.
bool Proxy::all_stand(const Planes& planes, std::uint32_t active, Vec3 start, Vec3 x, ProxyState& next) noexcept {
  const double drop = 2 * surface_->tolerance_m();
  for (int i = 0; i < planes.count; ++i) {
    if (!(active >> i & 1U) || norm(x - planes.found_at[i]) <= drop || next.sweeps == k_steps) continue;
    ++next.sweeps;
    const auto hit = surface_->sweep(start + x, start + x - drop * planes.plane[i].normal, near_);
    if (!hit || dot(hit->normal, planes.plane[i].normal) < k_same_normal) return false;
  }
  return true;
}

/// What stopped the proxy at x on its way is a constraint from now on.
void Proxy::touch(const SweepHit& hit, Vec3 way, Planes& planes, Vec3& x, ProxyState& next) const noexcept {
  next.in_contact = true;
  // Out of what the sweep lets a probe sink in; far less than the skin, so nothing is passed.
  const double tolerance = surface_->tolerance_m(), first = std::clamp(hit.penetration_m, 0.0, tolerance);
  if (hit.beside && planes.count + 2 <= k_planes) {
    const auto& beside = *hit.beside;
    const double second =
        dot(beside.normal, (beside.t - hit.t) * way) + std::clamp(beside.penetration_m, 0.0, tolerance);
    // The shortest way into the crease, where both are touched.
    const double c = dot(hit.normal, beside.normal), s = 1 - c * c;
    const Vec3 out = ((first - c * second) / s) * hit.normal + ((second - c * first) / s) * beside.normal;
    if (norm(out) <= tolerance) {
      x = x + out;
      planes.add({hit.normal, dot(hit.normal, x), hit.material}, x);
      planes.add({beside.normal, dot(beside.normal, x), beside.material}, x);
      return;
    }
  }
  x = x + first * hit.normal;
  planes.add({hit.normal, dot(hit.normal, x), hit.material}, x);
}

/// What holds the proxy at the nearest place of all: the goal lies straight behind what is touched. Where that is the
/// rim of a sheet nothing does, and the proxy slips around it.
void Proxy::rest_on(const Tick& tick, const ContactSurface::Rest& aim, Planes& planes, Vec3& x,
                    ProxyState& next) noexcept {
  const Vec3 out = normalized(x - tick.goal);
  const Vec3 aside = aim.off - dot(aim.off, out) * out;
  if (!(aside == Vec3{})) {
    const double radius = surface_->contact_radius_m();
    const Vec3 around = (k_around / norm(aside) * radius) * aside - radius * out;
    ++next.sweeps;
    if (!sweep(tick.start + x, around, tick.travel)) {
      if (norm(x + around - tick.goal) >= norm(x - tick.goal)) return;
      x = x + around;
      turn(tick.start + x);
      return;
    }
  }
  planes.add({out, dot(out, x), aim.material}, x);
}

/// Goes towards a place to rest by a free way along the surface, whose normal is given, and one down, if that leads
/// nearer to the goal; then `planes` is what the proxy rests on there, as far as it is known.
Proxy::Hop Proxy::hop(const Tick& tick, const ContactSurface::Rest& aim, Vec3 normal, double lift_m, Planes& planes,
                      Vec3& x, ProxyState& next) noexcept {
  const double now = norm(tick.goal - x), tolerance = surface_->tolerance_m();
  const Vec3 rest = aim.place - tick.start, up = lift_m * normal;
  Vec3 over = rest - std::min(dot(normal, rest - x), 0.0) * normal;
  const double way = norm(over - x);
  if (way <= k_drop * tolerance) return Hop::none;
  if (way > tick.farthest) over = x + (tick.farthest / way) * (over - x);
  over = over + up;
  if (lift_m > 0) {
    ++next.sweeps;
    if (sweep(tick.start + x, up, tick.travel)) return Hop::blocked;
  }
  ++next.sweeps;
  if (sweep(tick.start + x + up, over - x - up, tick.travel)) return Hop::blocked;
  ++next.sweeps;
  const Vec3 down = rest - over;
  const auto hit = sweep(tick.start + over, down, tick.travel);
  const Vec3 there = over + (hit ? hit->t : 1) * down;
  if (norm(tick.goal - there) >= now - tolerance) return Hop::none;
  if (lift_m > 0) turn(tick.start + x + up);
  turn(tick.start + over);
  turn(tick.start + there);
  x = there;
  planes.count = 0;
  next.in_contact = true;
  if (hit) {
    touch(*hit, down, planes, x, next);
  } else {
    rest_on(tick, aim, planes, x, next);
  }
  return Hop::moved;
}

/// Tries whether the nearest place of all can be reached by hops.
Proxy::Leap Proxy::leap(const Tick& tick, Vec3 normal, double lift_m, Planes& planes, Vec3& x,
                        ProxyState& next) noexcept {
  // A hop's length around, or as much as is likely to fit.
  look_around(tick.start + x, std::min(tick.farthest, (1 - k_lead) * widest_m_), tick.travel);
  const double now = norm(tick.goal - x), tolerance = surface_->tolerance_m();
  const auto aim = surface_->likely_rest(tick.start + tick.goal, now - 2 * tolerance, normal, near_);
  if (!aim) return {};
  Leap leap{Hop::moved, aim->place - tick.start};
  for (int i = 0; i < k_hops && leap.last == Hop::moved; ++i) {
    leap.last = hop(tick, *aim, normal, lift_m, planes, x, next);
    normal = normalized(x - tick.goal);
  }
  return leap;
}

const ProxyState& Proxy::update(Vec3 probe, double period_s) noexcept {
  if (!ContactSurface::is_place(probe)) return state_;
  if (!started_) reset(probe);
  const double shortest = surface_->tolerance_m() / 4;
  const double travel = norm(probe - probe_);
  ahead_ = travel > shortest ? (1 / travel) * (probe - probe_) : Vec3{};
  probe_ = probe;
  const Vec3 start = state_.proxy;  // Everything below is relative to it: small numbers, full precision.
  const Vec3 goal = probe - start;

  turn_count_ = 0;
  ProxyState next;
  Planes planes;
  recall(goal, planes);
  Vec3 x{}, slid{};
  bool free = false, leapt = false, crept = false, again = false;
  // What friction holds is pressed back along the normal: on the straight way to the probe it would creep along.
  Vec3 normal = state_.normal;
  double drop = state_.in_contact && friction(surface_->material(state_.material)) > 0 ? k_drop * shortest : 0;
  // Along smooth ground the nearest place is at hand most often: two ways lead there, whatever the edges between.
  const Tick tick{start, goal, travel, k_far * travel + surface_->skin_m()};
  Leap first;
  Stride stride;
  if (state_.in_contact && drop == 0 && travel > shortest) {
    first = leap(tick, state_.normal, 0, planes, x, next);
    slid = x;
  }
  double nearest = planes.count > 0 ? norm(goal - x) : std::numeric_limits<double>::infinity();
  for (;;) {
    const ConstrainedPoint aim = closest_point(goal, planes.plane, planes.count, shortest);
    if (!aim.found) break;
    Vec3 step = aim.point - x;
    const double wanted = norm(step);
    const bool drops = aim.count == 0 && drop > 0;
    if (drops) {
      step = -drop * normal;
    } else if (aim.count > 0) {
      hold(aim, planes, goal, next);
      const double held = friction(surface_->material(next.material)) * next.load_m;
      if (wanted - held <= shortest) {
        const bool stays = aim.count == 1 || all_stand(planes, aim.active, start, x, next);
        if (!stays) {
          planes.count = 0;
          continue;
        }
        const bool walled = first.last == Hop::blocked && norm(first.aim - x) > travel;
        const bool slipped = next.sweeps <= k_few && norm(x) > k_far * travel;
        if (!leapt && held == 0 && (walled || slipped) && next.sweeps + k_leap_sweeps <= k_steps) {
          leapt = true;
          const Vec3 before = x;
          leap(tick, next.normal, walled ? k_lift * surface_->skin_m() : 0, planes, x, next);
          if (!(x == before)) continue;
        }
        if (aim.count > 1) remember(planes, aim.active, x);
        break;
      }
      step = (1 - held / wanted) * step;
      // Beyond its aim by s the step rises by s²/2·depth: half a tolerance is let pass. Relief says too little from
      // step to step.
      if (aim.count > 1 && held == 0 && surface_->tallest_relief_m() == 0)
        step = stride.factor(step, wanted, wanted + std::sqrt(norm(goal - x) * surface_->tolerance_m())) * step;
    } else {
      free = wanted == 0;
      // A round that started from here and came back no nearer: converged to within the tolerance. Only a proxy that is
      // held in a crease, and has crept a little along it, may have come to where a wall falls away: a round later it's
      // seen.
      const bool no_nearer = planes.count == 0 && wanted > nearest - k_least_gain * shortest;
      if (free || (no_nearer && (again || !crept || norm(x) > k_held * travel))) break;
      again = again || no_nearer;
      if (planes.count == 0) nearest = wanted;
    }
    if (next.sweeps == k_steps) break;
    ++next.sweeps;
    const auto hit = sweep(start + x, step, travel);
    drop = 0;
    if (drops && !hit) continue;
    const Vec3 way = step;
    step = (hit ? hit->t : 1) * step;
    x = x + step;
    turn(start + x);
    if (aim.count > 0) slid = slid + step;
    free = !hit && planes.count == 0;
    if (free) break;
    if (!hit) {
      if (friction(surface_->material(next.material)) > 0) drop = norm(step) + k_drop * shortest;
      normal = next.normal;
      crept = aim.count > 1 && norm(step) > 2 * shortest;
      if (aim.count > 1) stride.take(step, wanted);
      planes.count = 0;
      continue;
    }
    if (norm(step) > shortest) planes.keep(aim.active);
    if (planes.count == k_planes) break;
    touch(*hit, way, planes, x, next);
  }
  if (free) next = ProxyState{};
  next.felt_normal = next.normal;
  if (next.in_contact && surface_->material(next.material).shading)
    next.felt_normal = surface_->shaded_normal(start + x, next.normal);
  const double distance = norm(slid);
  next.sliding = next.in_contact && distance > surface_->tolerance_m();
  if (period_s > 0) slide_speed_ += friction_memory_share(period_s) * (distance / period_s - slide_speed_);
  next.proxy = start + x;
  state_ = next;
  return state_;
}

}  // namespace papilla
