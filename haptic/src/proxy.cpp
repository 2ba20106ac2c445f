// SPDX-License-Identifier: MIT
#include "papilla/haptic/proxy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "contact_triangles.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/friction.hpp"

namespace papilla {
namespace {

// The constants of the descent: unit, reason, source. ε = τ/4 is the shortest step, τ the tolerance of the surface,
// travel the way of the probe in the tick; all units scale with the scene or the motion. [g] follows from geometry or
// rounding, [b] is tuned: with it the long runs of papilla-bench-contact meet their targets of time and of distance to
// a slow reference descent.
constexpr double k_least_sine2 = 1e-8;  // sin²: planes within 0.1 mrad of parallel form no edge [g]
// Settle.
constexpr double k_least_gain = 0.02;   // ε: a round that gains less is the last; a step s gains s²/(2·depth) [b]
constexpr double k_held = 0.1;          // travel: in a crease, a proxy that moved less gets one more round [b]
constexpr double k_crept = 2;           // ε: a longer step along a crease may have reached the end of a wall [b]
constexpr double k_press = 8;           // ε: twice the error of a resting proxy, which is τ [g]
constexpr double k_same_normal = 0.95;  // cosine: normal of a plane that is found again [b]
// Steps along a crease, and along a relief against friction.
constexpr double k_same_way = 0.9;        // cosine between two steps that a secant may connect [b]
constexpr double k_longest_stride = 4;    // of the planes' step, where the secant has no root ahead [b]
constexpr double k_relief_stride = 1.25;  // of the step that friction leaves: 2 passes places that hold [b]
constexpr double k_relief_skins = 0.5;  // skin: not shorter than that; the skin rounds what is shorter than itself [b]
// Hops towards the nearest place.
constexpr double k_least_hop = 8;         // τ: a nearer place is left to the descent [b]
constexpr double k_far = 1.5;             // travel: longest hop; a proxy that moved farther slipped down a slope [b]
constexpr int k_hops = 6;                 // of that length, down a slope [b]
constexpr int k_hop_sweeps = 4 * k_hops;  // at most: up, along, down, around a rim [g]
constexpr int k_few = 8;                  // sweeps: a descent that took more followed the surface closely [b]
constexpr double k_lift = 0.25;           // skin: a shallower hollow holds no proxy (docs/contact.md) [b]
constexpr double k_around = 4;            // radii aside for one down: a chord that cuts 3 % of the radius [g]
constexpr double k_softest = 0.5;         // of the depth: how far aside a slope of the stiffness draws the proxy [b]
// Gathering, for speed; hops see only what is gathered.
constexpr double k_needed_travels = 0.3;  // travel: margin around the proxy that a sweep wants [b]
constexpr double k_wanted_travels = 3;    // travel: gathered radius, for this tick and the next ones [b]
constexpr double k_wanted_skins = 4;      // skin: the same of a probe at rest [b]
constexpr double k_lead = 0.5;            // of that radius: how far ahead of the proxy its centre lies [b]
constexpr int k_pieces = 3;               // gathers along one sweep, then the tree is searched [b]
constexpr double k_regrowth = 1.01;       // per tick: growth of the largest radius after more than fits [b]
constexpr std::uint32_t k_sparse = 64;    // blocks, of 512: with fewer a radius twice as large is tried [b]

constexpr std::uint32_t k_no_place = ContactTriangles::k_no_place;

/// A half-space that the proxy must not leave: normal · x ≥ offset.
struct HalfSpace {
  Vec3 normal;
  double offset = 0;
  std::uint32_t material = 0;
  std::uint32_t place = 0;  ///< Of the triangle.
};

/// The point of a few half-spaces that is closest to a goal.
struct ConstrainedPoint {
  Vec3 point;
  std::uint32_t active = 0;  ///< Bit i: half-space i carries load.
  int count = 0;             ///< Bits set in `active`, at most 3.
  bool found = false;
};

struct Candidate {
  Vec3 point;
  bool valid = false;  ///< All multipliers are ≥ 0.
};

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

/// argmin |x − goal|² subject to every half-space: of all sets of at most three active planes the first whose
/// multipliers are ≥ 0 and that violates no other plane by more than `slack` (Karush-Kuhn-Tucker conditions, sufficient
/// for a convex problem). At most 92 small systems for 8 planes.
ConstrainedPoint constrain(Vec3 goal, const HalfSpace* planes, int count, double slack) noexcept {
  ConstrainedPoint best;
  best.point = goal;
  const auto accept = [&](const Candidate& candidate, std::uint32_t active) noexcept {
    if (!candidate.valid) return false;
    for (int i = 0; i < count; ++i)
      if (!(active >> i & 1U) && dot(planes[i].normal, candidate.point) < planes[i].offset - slack) return false;
    best = {candidate.point, active, std::popcount(active), true};
    return true;
  };
  if (accept({goal, true}, 0)) return best;
  for (int i = 0; i < count; ++i)
    if (accept(on_one(goal, planes[i]), 1U << i)) return best;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if (accept(on_two(goal, planes[i], planes[j]), 1U << i | 1U << j)) return best;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      for (int k = j + 1; k < count; ++k)
        if (accept(on_three(goal, planes[i], planes[j], planes[k]), 1U << i | 1U << j | 1U << k)) return best;
  return best;
}

/// The planes of the contacts of a tick, relative to the proxy at its start.
struct Planes {
  HalfSpace plane[Proxy::k_planes];
  Vec3 found_at[Proxy::k_planes];
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

/// The last step along a crease or a relief, which bends while the step is straight.
struct Stride {
  Vec3 direction;
  double length = 0, wanted = 0;  ///< Length as taken, and as planes and friction gave it.
  bool stretched = false;         ///< It was another one than these gave.
  bool turned = false;            ///< A step against friction led back; the tick takes its steps as they are then.

  void record(Vec3 step, double step_wanted) noexcept {
    length = norm(step);
    wanted = step_wanted;
    direction = length > 0 ? (1 / length) * step : Vec3{};
  }

  /// Ratio of the next step to that of planes and friction. That one shrinks in proportion to the way covered, so the
  /// secant through the last two leads to its root.
  /// @param farthest longest step.
  double factor(Vec3 step, double step_wanted, double farthest) const noexcept {
    const double along = dot(step, direction), fall = wanted - along;
    if (length == 0 || std::abs(along) < k_same_way * step_wanted) return 1;
    const double secant = fall > 0 ? std::abs(along) * length / fall : k_longest_stride * step_wanted;
    return std::min(secant, farthest) / step_wanted;
  }
};

/// How a hop ended: no nearer place, an obstacle on its way, or the proxy was moved.
enum class Hop { none, blocked, moved };

/// A series of hops: how the last one ended, and where they were aimed at.
struct Hops {
  Hop last = Hop::none;
  Vec3 aim{};
};

/// The data of one tick. Positions are relative to `start`: small numbers, full precision.
struct Tick {
  Vec3 start;           ///< Proxy of the tick before, in the frame of the scene.
  Vec3 goal;            ///< The probe.
  double travel = 0;    ///< Way of the probe in this tick.
  double farthest = 0;  ///< Longest hop.
  Vec3 press_normal;    ///< A proxy that friction holds is pressed against this direction,
  double press = 0;     ///< by this length; 0: it follows the probe.
  Vec3 x{}, slid{};     ///< The proxy, and its way along the surface.
  Planes planes{};
  ProxyState next{};  ///< The result.
  Hops first{};       ///< Hops at the start of the tick.
  Stride stride{};
  double nearest = std::numeric_limits<double>::infinity();  ///< Distance from the probe after the last round.
  bool free = false;                                         ///< No surface is between proxy and probe.
  bool hopped_again = false;                                 ///< After it had come to rest.
  bool crept = false;                                        ///< The last step led along a crease.
  bool extra_round = false;                                  ///< A round without gain was granted.
};

/// Where the planes let the proxy go.
struct Aim {
  ConstrainedPoint at;
  Vec3 step;
  double wanted = 0;     ///< |x* − x|.
  double held = 0;       ///< μδ: what friction takes from that.
  bool presses = false;  ///< The step leads along the normal instead.

  double left() const noexcept { return wanted - held; }
};

enum class Next { done, aim, sweep };

}  // namespace

class Proxy::Descent {
 public:
  explicit Descent(const ContactTriangles& surface) noexcept
      : surface_(&surface), shortest_(surface.tolerance_m() / 4) {}

  void reset(Vec3 position) noexcept;
  const ProxyState& update(Vec3 probe, double period_s) noexcept;
  const ProxyState& state() const noexcept { return state_; }
  std::span<const Vec3> waypoints() const noexcept { return {waypoints_.data(), waypoint_count_}; }

 private:
  Tick begin_tick(Vec3 probe) noexcept;
  Aim aim(Tick& tick) noexcept;
  Next settle(Tick& tick, const Aim& aim) noexcept;
  Next settle_held(Tick& tick, const Aim& aim) noexcept;
  static void apply_friction(Aim& aim) noexcept;
  void stretch(Tick& tick, Aim& aim) const noexcept;
  bool follows_relief(const Aim& aim) const noexcept;
  bool overshot(const Tick& tick, const Aim& aim) const noexcept;
  bool sweep_step(Tick& tick, const Aim& aim) noexcept;
  const ProxyState& end_tick(Tick& tick, double period_s) noexcept;

  double friction_of(const ProxyState& state) const noexcept;
  Vec3 towards_softer() const noexcept;
  void read_constants(std::uint32_t place, Vec3 x) noexcept;
  void save_planes(const Planes& planes, std::uint32_t active, Vec3 x) noexcept;
  void restore_planes(Vec3 goal, Planes& planes) noexcept;
  bool crease_holds(Tick& tick, std::uint32_t active) noexcept;
  void add_contact(Tick& tick, const SweepHit& hit, Vec3 way) const noexcept;
  void add_rest(Tick& tick, const ContactTriangles::Rest& rest) noexcept;
  Hop hop(Tick& tick, const ContactTriangles::Rest& rest, Vec3 normal, double lift_m) noexcept;
  Hops hop_to_nearest(Tick& tick, Vec3 normal, double lift_m) noexcept;
  std::optional<SweepHit> sweep(Vec3 from, Vec3 way, double travel) noexcept;
  void ensure_gathered(Vec3 from, double needed, double travel) noexcept;
  void add_waypoint(Vec3 at) noexcept { waypoints_[waypoint_count_++] = at; }

  const ContactTriangles* surface_;
  double shortest_;  // ε
  ProxyState state_;
  double slide_speed_ = 0;  // m/s, smoothed.
  bool started_ = false;
  LocalConstants felt_;                    // At the proxy, or where it first touched the triangle in this tick.
  std::uint32_t felt_place_ = k_no_place;  // Of that triangle.
  Vec3 probe_;                             // Of the tick before.
  Vec3 ahead_;                             // Unit direction of the probe's way in this tick; zero when that is short.
  std::array<HalfSpace, 3> held_{};        // Planes that held the proxy in a crease, relative to it.
  std::size_t held_count_ = 0;
  std::array<Vec3, k_steps> waypoints_{};  // At most one for each sweep.
  std::size_t waypoint_count_ = 0;
  Neighbourhood near_;
  ContactTriangles::KnownFaces known_;
  double widest_m_ = 1;  // Radius that is likely to fit into near_.
};

void Proxy::Descent::reset(Vec3 position) noexcept {
  state_ = ProxyState{};
  state_.proxy = position;
  probe_ = position;
  near_.clear();
  known_.clear();
  held_count_ = waypoint_count_ = 0;
  felt_place_ = k_no_place;
  slide_speed_ = 0;
  started_ = true;
}

const ProxyState& Proxy::Descent::update(Vec3 probe, double period_s) noexcept {
  if (!ContactSurface::is_valid_position(probe)) return state_;
  if (!started_) reset(probe);
  Tick tick = begin_tick(probe);
  for (;;) {
    Aim aim = this->aim(tick);
    const Next next = settle(tick, aim);
    if (next == Next::done) break;
    if (next == Next::aim) continue;
    apply_friction(aim);
    stretch(tick, aim);
    if (!sweep_step(tick, aim)) break;
  }
  return end_tick(tick, period_s);
}

/// Starts from the planes of the tick before. Without friction the nearest place is tried first: on smooth ground two
/// sweeps lead there, whatever the edges between.
Tick Proxy::Descent::begin_tick(Vec3 probe) noexcept {
  Tick tick;
  tick.travel = norm(probe - probe_);
  ahead_ = tick.travel > shortest_ ? (1 / tick.travel) * (probe - probe_) : Vec3{};
  probe_ = probe;
  tick.start = state_.proxy;
  tick.goal = probe - tick.start + towards_softer();
  tick.farthest = k_far * tick.travel + surface_->skin_m();
  waypoint_count_ = 0;
  restore_planes(tick.goal, tick.planes);
  tick.press_normal = state_.normal;
  if (state_.in_contact && friction_of(state_) > 0) tick.press = k_press * shortest_;
  if (state_.in_contact && tick.press == 0 && tick.travel > shortest_) {
    tick.first = hop_to_nearest(tick, state_.normal, 0);
    tick.slid = tick.x;
  }
  if (tick.planes.count > 0) tick.nearest = norm(tick.goal - tick.x);
  return tick;
}

/// The closest point that the planes allow; with active planes it gives normal, load and material of the contact.
Aim Proxy::Descent::aim(Tick& tick) noexcept {
  Aim aim{constrain(tick.goal, tick.planes.plane, tick.planes.count, shortest_), {}};
  if (!aim.at.found) return aim;
  aim.step = aim.at.point - tick.x;
  aim.wanted = norm(aim.step);
  aim.presses = aim.at.count == 0 && tick.press > 0;
  if (aim.presses) aim.step = -tick.press * tick.press_normal;
  if (aim.at.count == 0) return aim;

  const Vec3 behind = aim.at.point - tick.goal;
  const double depth = norm(behind);
  const HalfSpace& loaded = tick.planes.plane[std::countr_zero(aim.at.active)];
  ProxyState& next = tick.next;
  next.in_contact = true;
  next.constraints = aim.at.count;
  next.normal = depth > 0 ? (1 / depth) * behind : loaded.normal;
  next.load_m = std::max(0.0, depth - surface_->skin_m());
  next.material = loaded.material;
  if (loaded.place != felt_place_) read_constants(loaded.place, tick.start + tick.x);
  next.constants = felt_.constants;
  aim.held = friction_of(next) * next.load_m;
  return aim;
}

/// Whether the proxy is at rest. Without active planes it is when it reached the probe, or when a round that started
/// from here led back and no nearer. A proxy that crept a little along a crease gets one round more, because a wall may
/// have ended there.
Next Proxy::Descent::settle(Tick& tick, const Aim& aim) noexcept {
  if (!aim.at.found) return Next::done;
  if (aim.presses) return Next::sweep;
  if (aim.at.count > 0) return aim.left() <= shortest_ && !overshot(tick, aim) ? settle_held(tick, aim) : Next::sweep;
  tick.free = aim.wanted == 0;
  const bool no_nearer = tick.planes.count == 0 && aim.wanted > tick.nearest - k_least_gain * shortest_;
  const bool may_go_on = tick.crept && !tick.extra_round && norm(tick.x) <= k_held * tick.travel;
  if (tick.free || (no_nearer && !may_go_on)) return Next::done;
  tick.extra_round = tick.extra_round || no_nearer;
  if (tick.planes.count == 0) tick.nearest = aim.wanted;
  return Next::sweep;
}

/// The step that is left is too short. The proxy is at rest if the planes of a crease still exist, and if no hop leads
/// nearer: tried once, when the first hops were blocked far from here, or when the proxy slipped far in a few sweeps.
Next Proxy::Descent::settle_held(Tick& tick, const Aim& aim) noexcept {
  if (aim.at.count > 1 && !crease_holds(tick, aim.at.active)) {
    tick.planes.count = 0;
    return Next::aim;
  }
  const bool blocked = tick.first.last == Hop::blocked && norm(tick.first.aim - tick.x) > tick.travel;
  const bool slipped = tick.next.sweeps <= k_few && norm(tick.x) > k_far * tick.travel;
  if (!tick.hopped_again && aim.held == 0 && (blocked || slipped) && tick.next.sweeps + k_hop_sweeps <= k_steps) {
    tick.hopped_again = true;
    const Vec3 before = tick.x;
    hop_to_nearest(tick, tick.next.normal, blocked ? k_lift * surface_->skin_m() : 0);
    if (!(tick.x == before)) return Next::aim;
  }
  if (aim.at.count > 1) save_planes(tick.planes, aim.at.active, tick.x);
  return Next::done;
}

/// Coulomb's cone: the step ends where the rest of it is μδ.
void Proxy::Descent::apply_friction(Aim& aim) noexcept {
  if (aim.at.count > 0) aim.step = (1 - aim.held / aim.wanted) * aim.step;
}

/// Whether the step leads along a relief against friction, where the next steps have much the same direction.
bool Proxy::Descent::follows_relief(const Aim& aim) const noexcept {
  return aim.at.count == 1 && aim.held > 0 && surface_->tallest_relief_m() > 0;
}

/// Whether a stretched step led beyond where friction holds the proxy: it goes back then.
bool Proxy::Descent::overshot(const Tick& tick, const Aim& aim) const noexcept {
  return tick.stride.stretched && follows_relief(aim) && aim.wanted > 0 && aim.left() < -shortest_;
}

/// Stretches a step by the secant. Along a crease of plain faces without friction: s beyond the aim the proxy rises by
/// s²/(2·depth), and half a tolerance is allowed; creases of relief turn too much. Along a relief: a step that
/// overshoots is taken back once as far as the secant says, so the proxy rests where it would after many short steps.
void Proxy::Descent::stretch(Tick& tick, Aim& aim) const noexcept {
  if (aim.presses) return;
  Stride& stride = tick.stride;
  stride.stretched = false;
  const double left = std::abs(aim.left());
  double farthest = std::max(k_relief_stride * left, k_relief_skins * surface_->skin_m());
  if (aim.at.count > 1 && aim.held == 0 && surface_->tallest_relief_m() == 0)
    farthest = left + std::sqrt(norm(tick.goal - tick.x) * surface_->tolerance_m());
  else if (!follows_relief(aim) || stride.turned)
    return;
  stride.turned = aim.left() < 0;
  const double factor = stride.factor(aim.step, left, farthest);
  stride.stretched = factor != 1;
  aim.step = factor * aim.step;
}

/// Moves the proxy up to the first contact of the step. @returns false when the tick ends there.
bool Proxy::Descent::sweep_step(Tick& tick, const Aim& aim) noexcept {
  if (tick.next.sweeps == k_steps) return false;
  ++tick.next.sweeps;
  const auto hit = sweep(tick.start + tick.x, aim.step, tick.travel);
  tick.press = 0;
  if (aim.presses && !hit) return true;
  const Vec3 moved = (hit ? hit->t : 1) * aim.step;
  tick.x = tick.x + moved;
  add_waypoint(tick.start + tick.x);
  if (aim.at.count > 0) tick.slid = tick.slid + moved;
  if (hit && follows_relief(aim)) tick.stride.length = 0, tick.stride.stretched = false;
  tick.free = !hit && tick.planes.count == 0;
  if (tick.free) return false;
  if (!hit) {
    if (friction_of(tick.next) > 0) tick.press = norm(moved) + k_press * shortest_;
    tick.press_normal = tick.next.normal;
    tick.crept = aim.at.count > 1 && norm(moved) > k_crept * shortest_;
    if (aim.at.count > 1 || follows_relief(aim)) tick.stride.record(moved, std::abs(aim.left()));
    tick.planes.count = 0;
    return true;
  }
  if (norm(moved) > shortest_) tick.planes.keep(aim.at.active);
  if (tick.planes.count == k_planes) return false;
  add_contact(tick, *hit, aim.step);
  return true;
}

const ProxyState& Proxy::Descent::end_tick(Tick& tick, double period_s) noexcept {
  ProxyState& next = tick.next;
  if (tick.free) next = ProxyState{};
  next.proxy = tick.start + tick.x;
  if (!next.in_contact)
    felt_place_ = k_no_place;
  else if (felt_place_ != k_no_place && !(tick.x == Vec3{}) && surface_->material(next.material).channels)
    read_constants(felt_place_, next.proxy), next.constants = felt_.constants;
  next.shaded_normal = next.normal;
  if (next.in_contact && surface_->material(next.material).shading)
    next.shaded_normal = surface_->shaded_normal(next.proxy, next.normal);
  const double distance = norm(tick.slid);
  next.sliding = next.in_contact && distance > surface_->tolerance_m();
  if (period_s > 0) slide_speed_ += friction_memory_share(period_s) * (distance / period_s - slide_speed_);
  state_ = next;
  return state_;
}

/// μ at the present sliding speed; 0 for other models than Coulomb's, which leave the proxy free.
double Proxy::Descent::friction_of(const ProxyState& state) const noexcept {
  const ContactMaterial& m = surface_->material(state.material);
  const bool holds = m.friction == FrictionModel::coulomb && m.model != ForceModel::textured_normal;
  return holds ? friction_coefficient(state.constants, slide_speed_) : 0;
}

void Proxy::Descent::read_constants(std::uint32_t place, Vec3 x) noexcept {
  felt_ = surface_->constants_at(place, x);
  felt_place_ = place;
}

/// From the probe to where the proxy is drawn: (∂W/∂k)·∇k/N·δ against the slope of the stiffness. The proxy then rests
/// where the energy W(k(x), |x − p|) of the spring is least, not its length: a hand that slides from soft to hard has
/// to put in what the stiffer spring stores.
Vec3 Proxy::Descent::towards_softer() const noexcept {
  const double depth = state_.load_m;
  if (!state_.in_contact || !(depth > 0) || felt_.stiffness_slope == Vec3{}) return {};
  const ContactMaterial& m = surface_->material(state_.material);
  const double force = spring_force(m, state_.constants.stiffness, depth);
  if (!(force > 0)) return {};
  const Vec3 way = (-energy_by_stiffness(m, depth) * depth / force) * felt_.stiffness_slope;
  const double length = norm(way), most = k_softest * depth;
  return length > most ? (most / length) * way : way;
}

/// Keeps the active planes for the next tick, if all of them were found at x.
void Proxy::Descent::save_planes(const Planes& planes, std::uint32_t active, Vec3 x) noexcept {
  for (int i = 0; i < planes.count; ++i) {
    if (!(active >> i & 1U)) continue;
    const HalfSpace& plane = planes.plane[i];
    if (!(x == planes.found_at[i])) {
      held_count_ = 0;
      return;
    }
    held_[held_count_++] = {plane.normal, plane.offset - dot(plane.normal, x), plane.material, plane.place};
  }
}

/// The planes of save_planes(), if the probe still pulls into one of them: the proxy has not moved since.
void Proxy::Descent::restore_planes(Vec3 goal, Planes& planes) noexcept {
  bool pulls = false;
  for (std::size_t i = 0; i < held_count_; ++i) {
    planes.add(held_[i], {});
    pulls = pulls || dot(held_[i].normal, goal) < held_[i].offset;
  }
  if (!pulls) planes.count = 0;
  held_count_ = 0;
}

/// Whether the surfaces behind the planes of a crease still exist at x: the proxy may have slid past one of them.
bool Proxy::Descent::crease_holds(Tick& tick, std::uint32_t active) noexcept {
  const double drop = k_press * shortest_;
  for (int i = 0; i < tick.planes.count; ++i) {
    const Vec3 normal = tick.planes.plane[i].normal, from = tick.start + tick.x;
    if (!(active >> i & 1U) || norm(tick.x - tick.planes.found_at[i]) <= drop || tick.next.sweeps == k_steps) continue;
    ++tick.next.sweeps;
    const auto hit = surface_->sweep(from, from - drop * normal, near_, known_);
    if (!hit || dot(hit->normal, normal) < k_same_normal) return false;
  }
  return true;
}

/// Adds the plane of a contact at x on the step `way`; in a crease the planes of both faces.
void Proxy::Descent::add_contact(Tick& tick, const SweepHit& hit, Vec3 way) const noexcept {
  tick.next.in_contact = true;
  // Undoes the penetration that the sweep allows; far less than the skin, so nothing is passed.
  const double tolerance = surface_->tolerance_m(), first = std::clamp(hit.penetration_m, 0.0, tolerance);
  if (hit.crease && tick.planes.count + 2 <= k_planes) {
    const auto& crease = *hit.crease;
    const double second =
        dot(crease.normal, (crease.t - hit.t) * way) + std::clamp(crease.penetration_m, 0.0, tolerance);
    // The shortest way to where both are touched.
    const double c = dot(hit.normal, crease.normal), s = 1 - c * c;
    const Vec3 out = ((first - c * second) / s) * hit.normal + ((second - c * first) / s) * crease.normal;
    if (norm(out) <= tolerance) {
      tick.x = tick.x + out;
      tick.planes.add({hit.normal, dot(hit.normal, tick.x), hit.material, hit.place}, tick.x);
      tick.planes.add({crease.normal, dot(crease.normal, tick.x), crease.material, crease.place}, tick.x);
      return;
    }
  }
  tick.x = tick.x + first * hit.normal;
  tick.planes.add({hit.normal, dot(hit.normal, tick.x), hit.material, hit.place}, tick.x);
}

/// Adds the plane that holds the proxy at the nearest place: the goal lies straight behind the touched point. The rim
/// of a sheet holds nothing; there the proxy goes around it.
void Proxy::Descent::add_rest(Tick& tick, const ContactTriangles::Rest& rest) noexcept {
  const Vec3 out = normalized(tick.x - tick.goal);
  const Vec3 aside = rest.off - dot(rest.off, out) * out;
  if (!(aside == Vec3{})) {
    const double radius = surface_->contact_radius_m();
    const Vec3 around = (k_around / norm(aside) * radius) * aside - radius * out;
    ++tick.next.sweeps;
    if (!sweep(tick.start + tick.x, around, tick.travel)) {
      if (norm(tick.x + around - tick.goal) >= norm(tick.x - tick.goal)) return;
      tick.x = tick.x + around;
      add_waypoint(tick.start + tick.x);
      return;
    }
  }
  tick.planes.add({out, dot(out, tick.x), rest.material, rest.triangle}, tick.x);
}

/// Moves towards a place to rest: up by lift_m along `normal`, along the surface, and down. Only if these ways are free
/// and lead nearer to the goal; then the planes are those found there.
Hop Proxy::Descent::hop(Tick& tick, const ContactTriangles::Rest& rest, Vec3 normal, double lift_m) noexcept {
  const Vec3 x = tick.x, place = rest.place - tick.start, up = lift_m * normal;
  const double now = norm(tick.goal - x);
  Vec3 over = place - std::min(dot(normal, place - x), 0.0) * normal;
  const double way = norm(over - x);
  if (way <= k_least_hop * surface_->tolerance_m()) return Hop::none;
  if (way > tick.farthest) over = x + (tick.farthest / way) * (over - x);
  over = over + up;
  if (lift_m > 0) {
    ++tick.next.sweeps;
    if (sweep(tick.start + x, up, tick.travel)) return Hop::blocked;
  }
  ++tick.next.sweeps;
  if (sweep(tick.start + x + up, over - x - up, tick.travel)) return Hop::blocked;
  ++tick.next.sweeps;
  const Vec3 down = place - over;
  const auto hit = sweep(tick.start + over, down, tick.travel);
  const Vec3 there = over + (hit ? hit->t : 1) * down;
  if (norm(tick.goal - there) >= now - surface_->tolerance_m()) return Hop::none;
  if (lift_m > 0) add_waypoint(tick.start + x + up);
  add_waypoint(tick.start + over);
  add_waypoint(tick.start + there);
  tick.x = there;
  tick.planes.count = 0;
  tick.next.in_contact = true;
  if (hit) {
    add_contact(tick, *hit, down);
  } else {
    add_rest(tick, rest);
  }
  return Hop::moved;
}

Hops Proxy::Descent::hop_to_nearest(Tick& tick, Vec3 normal, double lift_m) noexcept {
  // Gathers what a hop can reach, or as much as is likely to fit.
  ensure_gathered(tick.start + tick.x, std::min(tick.farthest, (1 - k_lead) * widest_m_), tick.travel);
  const double now = norm(tick.goal - tick.x), tolerance = surface_->tolerance_m();
  const auto rest = surface_->rest_candidate(tick.start + tick.goal, now - 2 * tolerance, normal, near_);
  if (!rest) return {};
  Hops hops{Hop::moved, rest->place - tick.start};
  for (int i = 0; i < k_hops && hops.last == Hop::moved; ++i) {
    hops.last = hop(tick, *rest, normal, lift_m);
    normal = normalized(tick.x - tick.goal);
  }
  return hops;
}

/// First contact on from + t·way. Where the segment leaves the gathered ball, more is gathered.
std::optional<SweepHit> Proxy::Descent::sweep(Vec3 from, Vec3 way, double travel) noexcept {
  double seen = 0;
  for (int piece = 0; piece < k_pieces; ++piece) {
    const double here = std::min(travel, norm(way));
    ensure_gathered(from + seen * way, k_needed_travels * here + surface_->skin_m(), here);
    const double before = seen;
    const auto hit = surface_->sweep(from, from + way, near_, known_, seen);
    if (hit || seen >= 1) return hit;
    if (!(seen > before)) break;
  }
  return surface_->sweep(from, from + way);
}

/// Gathers what lies within `needed` of `from`, unless it is there already or does not fit.
void Proxy::Descent::ensure_gathered(Vec3 from, double needed, double travel) noexcept {
  if (surface_->margin(from, near_) >= needed) return;
  const double radius = std::min(k_wanted_travels * travel + k_wanted_skins * surface_->skin_m(), widest_m_);
  if ((1 - k_lead) * radius < needed) {
    near_.clear_boxes();
    widest_m_ *= k_regrowth;
  } else if (!surface_->gather(from + (k_lead * radius) * ahead_, radius, near_)) {
    widest_m_ = 0.5 * radius;
  } else if (near_.blocks() < k_sparse) {
    widest_m_ = std::max(widest_m_, 2 * radius);
  }
}

Proxy::Proxy(const ContactSurface& surface) : descent_(std::make_unique<Descent>(*surface.triangles_)) {}
Proxy::Proxy(Proxy&&) noexcept = default;
Proxy& Proxy::operator=(Proxy&&) noexcept = default;
Proxy::~Proxy() = default;

void Proxy::reset(Vec3 position) noexcept { descent_->reset(position); }
const ProxyState& Proxy::update(Vec3 probe, double period_s) noexcept { return descent_->update(probe, period_s); }
const ProxyState& Proxy::state() const noexcept { return descent_->state(); }
std::span<const Vec3> Proxy::waypoints() const noexcept { return descent_->waypoints(); }

}  // namespace papilla
