// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla {

struct ConstrainedPoint;

/// Where the proxy stands after a tick.
struct ProxyState {
  Vec3 proxy;                  ///< Centre of the probe as the surface allows it.
  Vec3 normal;                 ///< Unit direction in which the surfaces hold it; zero when free.
  Vec3 felt_normal;            ///< `normal`, smoothed over facets where the material asks for that.
  double load_m = 0;           ///< Depth along `normal`: distance of the probe behind the surfaces, without the skin.
  bool in_contact = false;     ///< At least one constraint acts.
  bool sliding = false;        ///< The proxy was moved along the surface in this tick.
  int constraints = 0;         ///< Constraints that act: 1 to 3. A crease flatter than the tolerance can be one.
  int sweeps = 0;              ///< Swept tests that the tick took.
  std::uint32_t material = 0;  ///< Of the surface that carries the load.
};

/// The god-object [Zilles and Salisbury 1995] with a ball's radius [Ruspini, Kolarov and Khatib 1997]: the proxy
/// follows the probe through free space and stays on the side of every surface from which it came.
///
/// Each tick descends |proxy − probe|² from the proxy of the tick before. A step goes straight to the nearest point
/// that the constraints found so far allow (the closest point of up to k_planes half-spaces, at most three of which can
/// act) and is swept, so that no speed tunnels; what stops it becomes a constraint, in a crease both of its faces;
/// constraints that no longer act are dropped when the proxy moves, and all are forgotten and found again when a step
/// ends free, so that surfaces which fall away let go; in a crease, planes that were found farther back are asked for
/// again before the proxy stops. The tick ends when a step is shorter than a quarter of the surface's tolerance, or
/// after k_steps sweeps; then the proxy still is outside and goes on in the next tick.
///
/// A proxy without friction first hops towards ContactSurface::likely_rest(): by a free way along the surface, no
/// longer than about the probe's own, and one down, until it is there or the way is blocked; two sweeps instead of two
/// for each facet. There it rests without asking what holds it, where the surface goes on all around; off the rim of a
/// sheet it slips. Once a tick one that has come to rest elsewhere tries the same again: one that went much farther
/// than the probe, as it may be in the farther of two hollows, and one that was blocked and is farther from that place
/// than the probe went, from a quarter of the skin higher up: a hollow that is flatter holds no proxy. One that two or
/// three planes held starts from these; one that is held in a crease goes on for a round more than its gain is worth,
/// as a wall may have fallen away. Along a crease without relief, whose bend the planes don't know, steps are stretched
/// by the secant of the two before: where it bends about the probe, each would be a small part of what is left.
///
/// Friction is Coulomb's on the load: the proxy sticks while the step it wants is at most μ·load, and is moved only
/// until it equals μ·load. μ fades from static to dynamic with the sliding speed v as μd + (μs − μd)·exp(−(v/vs)²)
/// [Stribeck]. v is the way along the surface smoothed over the memory of friction, 10 ms (assumed; frictional lag:
/// [Armstrong-Hélouvry, Dupont and Canudas de Wit 1994]): without it a proxy without mass would stick and slip at the
/// rate of the loop; with it sliding is steady as long as depth·|dμ/dv| stays below the memory. A proxy that friction
/// holds and that has lost touch by a rounding or a bulge is pressed back along the normal, not towards the probe, so
/// that it doesn't creep by a little in every tick. Where a relief holds it in a notch until it springs out, the place
/// where it lands depends on the rate all the same.
///
/// Guarantees: noexcept, no allocation, no lock; never passes a triangle; deterministic.
/// Limits: where a map's steepest slope leaves doubt, a relief is looked at every half texel; what rises and falls
/// between two looks is passed. The start of reset() is taken as free even when it lies within a solid.
class Proxy {
 public:
  static constexpr int k_planes = 8;
  static constexpr int k_steps = 64;

  /// @param surface must outlive the proxy.
  explicit Proxy(const ContactSurface& surface) noexcept : surface_(&surface) {}

  /// Puts proxy and probe to `position`, free.
  void reset(Vec3 position) noexcept;

  /// One tick of `period_s` with the probe at `probe`. Where ContactSurface::is_place() says that no probe can be,
  /// everything stays as it was. The first call after construction resets.
  const ProxyState& update(Vec3 probe, double period_s) noexcept;

  const ProxyState& state() const noexcept { return state_; }

  /// Where the proxy was between the pieces of its way in the last tick, each of which was swept.
  std::span<const Vec3> turns() const noexcept { return {turns_.data(), static_cast<std::size_t>(turn_count_)}; }

 private:
  struct Tick;
  struct Planes;
  struct Stride;
  enum class Hop;
  struct Leap;
  /// A plane that holds the proxy, relative to it.
  struct Held {
    Vec3 normal;
    double offset = 0;
    std::uint32_t material = 0;
  };
  void remember(const Planes& planes, std::uint32_t active, Vec3 x) noexcept;
  void recall(Vec3 goal, Planes& planes) noexcept;
  void hold(const ConstrainedPoint& aim, const Planes& planes, Vec3 goal, ProxyState& next) const noexcept;
  bool all_stand(const Planes& planes, std::uint32_t active, Vec3 start, Vec3 x, ProxyState& next) noexcept;
  void touch(const SweepHit& hit, Vec3 way, Planes& planes, Vec3& x, ProxyState& next) const noexcept;
  void rest_on(const Tick& tick, const ContactSurface::Rest& aim, Planes& planes, Vec3& x, ProxyState& next) noexcept;
  Hop hop(const Tick& tick, const ContactSurface::Rest& aim, Vec3 normal, double lift_m, Planes& planes, Vec3& x,
          ProxyState& next) noexcept;
  Leap leap(const Tick& tick, Vec3 normal, double lift_m, Planes& planes, Vec3& x, ProxyState& next) noexcept;
  double friction(const ContactMaterial& material) const noexcept;
  std::optional<SweepHit> sweep(Vec3 from, Vec3 way, double travel) noexcept;
  void look_around(Vec3 from, double needed, double travel) noexcept;
  void gather(Vec3 from, double needed, double travel) noexcept;
  void turn(Vec3 at) noexcept;

  const ContactSurface* surface_;
  ProxyState state_;
  double slide_speed_ = 0;  // m/s, of the tick before.
  bool started_ = false;
  Vec3 probe_;                  // Of the tick before.
  Vec3 ahead_;                  // Unit direction of the probe's way in this tick; zero when that is short.
  std::array<Held, 3> held_{};  // Planes of the tick before, relative to the proxy.
  int held_count_ = 0;
  std::array<Vec3, k_steps> turns_{};  // One for each sweep at most.
  int turn_count_ = 0;
  Neighbourhood near_;
  double widest_m_ = 1;  // Radius that is likely to fit into near_.
};

}  // namespace papilla
