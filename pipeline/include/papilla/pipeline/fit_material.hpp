// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/pipeline/stroke_recording.hpp"

namespace papilla {

/// Where the surface is that a recorded stroke touched.
enum class StrokeSurface {
  automatic,  ///< `recorded` where the recording has proxies, else `plane`.
  recorded,   ///< At the recorded proxies.
  plane,      ///< An unknown plane, found with the material.
};

/// Where the forces of a recording come from.
enum class StrokeForces {
  automatic,  ///< The player where the recording has proxies, else a sensor.
  player,     ///< They went through its ForceGuard: faded in, limited in size and rate.
  sensor,
};

/// Options of fit_material().
struct FitOptions {
  StrokeSurface surface = StrokeSurface::automatic;
  StrokeForces forces = StrokeForces::automatic;
  double max_force_n = std::numeric_limits<double>::infinity();  ///< Of the player's device.
  std::size_t most_samples = 200'000;                            ///< Later ones are left out.
};

/// A number with its 95 % interval.
struct FittedNumber {
  double value = 0, low = 0, high = 0;
};

/// What of the material the recording does not tell, and why.
struct NotIdentified {
  std::string parameter;  ///< "stiffness", "damping", "static_friction", …, "roughness", "hurst"
  std::string reason;     ///< One sentence.
};

/// The heights under the probe's way.
struct FittedRoughness {
  FittedNumber rms_m;                 ///< Root mean square about a parabola over the longest wave.
  std::optional<FittedNumber> hurst;  ///< H, where a power law holds; the surface has the dimension 3 − H.
  double shortest_wave_m = 0, longest_wave_m = 0;  ///< Waves that the numbers are of.
};

/// Measured and fitted force at a sample.
struct FittedForce {
  double t_s = 0;
  double normal_n = 0, along_n = 0;                ///< Measured: out of the surface, and against the way.
  double fitted_normal_n = 0, fitted_along_n = 0;  ///< By the model.
  double load_n = 0;                               ///< k·δ of the model, which friction is a part of.
  double slip_m_per_s = 0;                         ///< Smoothed speed at which the contact slips; 0 while it holds.
};

/// What fit_material() returns. A number that the recording does not tell is absent and in `not_identified`.
struct MaterialFit {
  std::optional<FittedNumber> stiffness;  ///< N/m
  std::optional<FittedNumber> damping;    ///< N·s/m
  std::optional<FittedNumber> static_friction;
  std::optional<FittedNumber> dynamic_friction;   ///< Where only one speed was slid at: the friction at that speed.
  std::optional<FittedNumber> stribeck_velocity;  ///< m/s
  std::optional<FittedRoughness> roughness;
  std::vector<NotIdentified> not_identified;
  StrokeSurface surface = StrokeSurface::plane;  ///< Which one was taken.
  Vec3 normal;                                   ///< Of the plane, or the mean of the recorded surface, unit.
  std::size_t samples = 0;                       ///< All that were looked at.
  std::size_t outliers = 0;                      ///< Of them with less than half of their weight.
  double rms_residual_n = 0;                     ///< Root mean square of the vector of force that is not explained.
  double slowest_slip_m_per_s = 0, fastest_slip_m_per_s = 0;  ///< 5 % and 95 % of the slipping samples; 0: none slip.
  StopReason stop = StopReason::converged;
  Trace trace;                      ///< Weighted root mean square residual in newtons over the iterations.
  std::vector<FittedForce> forces;  ///< Of every sample.
  std::vector<std::string> warnings;
};

/// The material of a surface from a recorded stroke: of all materials, that which the player renders with the least
/// error of force, along the path of the recording. The model is the player's (force_model.hpp, friction.hpp): with n
/// the normal, δ the depth of the probe behind the surface, v its velocity,
///     F = n·max(0, k·δ − b·(v·n)) + f,     f = −k·z,   z ← z + Δx,   |z| ≤ μ(s)·δ
///     μ(s) = μd + (μs − μd)·exp(−(s/vs)²), s the speed at which z is cut off, smoothed over 10 ms
/// and, where the player made the forces, what its guard makes of F (safety.hpp): the force of the first contact fades
/// in, and the device's largest force and rate are kept.
/// δ = n·(proxy − probe) − g where the recording has proxies, n their direction without the part along the way and g a
/// gap (the skin of the contact); δ = d − n·probe for a plane with unknown n and d. v is the recorded velocity, or the
/// difference of the places smoothed over 1 ms, as in the player.
///
/// Least squares of all three components by Ceres (Levenberg-Marquardt, central differences), repeated with Huber's
/// weights (k = 3 robust deviations), so that samples which the model does not describe count little. μs and vs join
/// where that makes the fit better than chance (F test, 1 %) and the stroke slipped slower and faster than vs. The
/// intervals are 1.96 deviations of the larger of two covariances: that of independent errors, and that of errors which
/// hang together within 50 ms (sandwich); no force counts as better than a thousandth of the root mean square force.
///
/// A number is left out where its interval is wider than the number itself (half of it more than 50 %; frictions more
/// than 0.05 and damping more than 0.25 N·s/m beside), and `not_identified` says what the stroke lacks. A stroke that
/// identifies all comes from the air, presses deeper and less deep at some centimetres a second, rests, and slides from
/// a crawl to a decimetre a second.
///
/// Roughness: heights h = n·probe + δ + ΔF·n/k, ΔF what the model leaves of the force, against the way of the probe
/// while it slips, in windows of at most 20 mm and a fifth of the way, each less its parabola; rms² less the noise of
/// the force (of samples without contact or at rest) over k². H is the mean slope of log rms second difference over log
/// lag, with Student's interval over the windows, where it bends by less than a tenth of a decade.
///
/// Breaks down where the model does: bristle friction, stimuli, two layers, surfaces that bend within the stroke and
/// have no recorded proxies; where the player's largest force is not told and was reached, or
/// passivity control softened forces; noise of the *positions* biases stiffness down. A recording of the player has the
/// stiffness that the device was given, not what the tag wanted.
///
/// Cost: about 2 µs a sample and iteration, some ten iterations. Deterministic. Source of the model: see the headers
/// named; intervals: White, Maximum likelihood estimation of misspecified models, Econometrica 50, 1982; Huber, Robust
/// estimation of a location parameter, Annals of Mathematical Statistics 35, 1964.
/// @param name of the recording in messages.
/// @throws InvalidInput when it has fewer than 50 samples, never presses, or has no proxies and options.surface asks
/// for them; SolverFailure when no parameters fit.
MaterialFit fit_material(std::span<const StrokeSample> stroke, const FitOptions& options, const std::string& name,
                         const ProgressCallback& progress = {});

}  // namespace papilla
