// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla {

/// The proxy after a tick.
struct ProxyState {
  Vec3 proxy;                  ///< m; centre of the probe's ball where the surfaces allow it.
  Vec3 normal;                 ///< n, unit: direction in which the surfaces hold the proxy; zero when free.
  Vec3 shaded_normal;          ///< n, smoothed over facets where the material asks for force shading.
  double load_m = 0;           ///< δ, m: depth of the probe behind the surfaces along n, without the skin.
  bool in_contact = false;     ///< At least one constraint is active.
  bool sliding = false;        ///< The proxy moved along the surface in this tick.
  int constraints = 0;         ///< Active constraints, 0 to 3. A crease flatter than the tolerance can be one.
  int sweeps = 0;              ///< Swept tests of the tick, at most Proxy::k_steps.
  std::uint32_t material = 0;  ///< Material of the surface that carries the load.
  ContactConstants constants;  ///< In contact: of that material at the proxy, as its maps say.
};

/// The god object of Zilles and Salisbury [A constraint-based god-object method for haptic display, 1995] with the
/// radius of a ball, swept [Ruspini, Kolarov and Khatib, The haptic display of complex graphical environments, 1997].
/// The proxy x follows the probe p through free space and stays on the side of every surface from which it came.
///
/// With f_T the clearance of triangle T (contact_surface.hpp) and s the skin, a tick searches, along a swept path from
/// the x of the tick before, the local solution of
///     min |x − p|²   subject to   f_T(x) ≥ 0 for every T
/// by repeating four steps:
///     aim       x* = argmin |x − p|² subject to n_i·x ≥ d_i, the planes of the contacts found so far. At most k_planes
///               planes, at most three of them active (Karush-Kuhn-Tucker conditions of every subset).
///               n = (x* − p)/|x* − p|,   δ = max(0, |x* − p| − s)
///     settle    at rest when |x* − x| − μδ ≤ τ/4, τ the tolerance of the surface, or when a round brings x no nearer.
///     friction  Coulomb's cone: x moves by (1 − μδ/|x* − x|)·(x* − x), and sticks while |x* − x| ≤ μδ.
///     sweep     x moves up to the first contact on the step, which becomes a plane; in a crease both faces do. Planes
///               that are not active are dropped when x moves; all are dropped when a step ends without contact, so
///               that surfaces which fall away release the proxy.
/// so that no speed tunnels. Constants are those of the material's maps at x, friction
/// and pull those where x was in the tick before. Where the stiffness k has a slope, p is
/// the probe less (∂W/∂k)·∇k·δ/N, at most δ/2, with W the energy of the spring and N its force (force_model.hpp), so
/// that x rests where W(k(x), |x − p|) is least: without it a hand would gain (∂W/∂k)·Δk on each way from soft to hard.
/// The place of the tick before gives ∇k and δ. The friction coefficient follows the smoothed sliding speed v
/// [Stribeck]:
///     μ = μd + (μs − μd)·exp(−(v/vs)²),   v ← v + (1 − exp(−T/10 ms))·(|Δx|/T − v)
/// Frictional memory (10 ms is assumed; frictional lag: Armstrong-Hélouvry, Dupont and Canudas de Wit 1994) keeps a
/// proxy without mass from sticking and slipping at the rate of the loop; sliding is steady while δ·|dμ/dv| is below
/// it. Force shading replaces n by ContactSurface::shaded_normal(). force_model.hpp has the force.
///
/// Shortcuts, which leave that result: without friction x first hops along the surface to
/// ContactTriangles::rest_candidate(), which takes two sweeps where the descent takes two for each facet; x that stops
/// behind an obstacle, or much farther away than the probe went, tries that once more, over hollows of up to a quarter
/// of the skin. The planes that held x in a crease are kept for the next tick. Steps along a crease are stretched by
/// the secant of the two before. A proxy held by friction that lost contact by rounding is pressed back along n, so
/// that it does not creep towards the probe.
///
/// Units: m, s, N. Guarantees: noexcept but for the constructor, no allocation, no lock, no system call in update();
/// the proxy never passes a triangle; deterministic, the same bits on the same input. Cost: most ticks 2 to 25 sweeps,
/// never more than k_steps; 3 µs among two million triangles (median). Memory: 230 KiB.
/// Limits: a proxy that would need more sweeps goes on in the next tick. Where a map's steepest slope leaves doubt, a
/// relief is sampled every half texel, and features between two samples are missed. Friction lags by half a tick of
/// travel. reset() takes its position as free even when it is inside a solid. Under the rim of an open sheet, and
/// where two places are equally near, the path decides which one is reached.
class Proxy {
 public:
  static constexpr int k_planes = 8;
  static constexpr int k_steps = 64;

  /// @param surface must outlive the proxy; it may be moved.
  explicit Proxy(const ContactSurface& surface);
  Proxy(Proxy&&) noexcept;
  Proxy& operator=(Proxy&&) noexcept;
  ~Proxy();

  /// Puts proxy and probe to `position`, free.
  void reset(Vec3 position) noexcept;

  /// One tick of `period_s` with the probe at `probe`. Nothing changes where ContactSurface::is_valid_position() is
  /// false. The first call after construction resets.
  const ProxyState& update(Vec3 probe, double period_s) noexcept;

  const ProxyState& state() const noexcept;

  /// The vertices of the proxy's path in the last tick, without its ends; every piece was swept.
  std::span<const Vec3> waypoints() const noexcept;

 private:
  class Descent;
  std::unique_ptr<Descent> descent_;
};

}  // namespace papilla
