// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/safety.hpp"
#include "papilla/pipeline/fit_material.hpp"
#include "papilla/pipeline/stroke_recording.hpp"

namespace papilla {

/// What a fit looks for. Frictions and speed as they are; the plane turns about its first normal.
struct StrokeParameters {
  enum Index { stiffness, offset, damping, dynamic_friction, friction_drop, stribeck, tilt_u, tilt_v, count };
  /// ln k, g or d [m], b, μd, μs − μd, ln vs, two angles.
  std::array<double, count> x{};
};

/// The force of the model at a sample.
struct ModelForce {
  Vec3 force_n, normal;
  double load_n = 0;        ///< k·δ; 0 without contact.
  double slip_m_per_s = 0;  ///< 0 while it holds.
  Vec3 velocity_m_per_s;    ///< That damping acts on.
};

/// Largest g: a skin in a scene of hundreds of metres.
inline constexpr double k_widest_gap_m = 1e-3;

/// The path of a stroke with the surface that it touched, on which the model of fit_material() is evaluated.
class StrokeModel {
 public:
  /// @param surface `recorded` or `plane`. @param guard of the player; nothing: forces are as they are.
  StrokeModel(std::span<const StrokeSample> stroke, StrokeSurface surface, double contact_force_n,
              const std::optional<SafetyLimits>& guard);

  /// The forces of all samples, in order. Deterministic; cost: 100 ns a sample.
  void evaluate(const StrokeParameters& parameters, std::vector<ModelForce>& forces) const;

  StrokeSurface surface() const { return surface_; }
  /// Depth of a sample behind the surface whose offset is 0, and its normal where that of the plane is `plane`.
  double depth(std::size_t sample, Vec3 plane) const;
  Vec3 normal_at(std::size_t sample, Vec3 plane) const;
  /// For a plane: turns it first to that normal. Offsets count from the middle of the contact.
  void set_normal(Vec3 normal);
  Vec3 normal(const StrokeParameters& parameters) const;  ///< Of the plane; of a recorded surface the mean.
  std::span<const StrokeSample> stroke() const { return stroke_; }

 private:
  std::span<const StrokeSample> stroke_;
  StrokeSurface surface_;
  std::optional<SafetyLimits> guard_;
  Vec3 middle_, normal_{0, 0, 1}, along_u_, along_v_;
  /// What recorded proxies tell of a sample.
  struct Recorded {
    Vec3 normal, lag;  ///< Of the surface; of the proxy along it.
    bool slips = false;
    double slip_m_per_s = 0;  ///< Smoothed, before this sample.
  };
  std::vector<Recorded> recorded_;
  std::vector<Vec3> velocity_;

  Vec3 recorded_friction(std::size_t i, const ContactMaterial& material, double depth_m, double& slip_m_per_s) const;
  static std::vector<Recorded> recorded_of(std::span<const StrokeSample> stroke);
};

/// Where a descent may begin.
struct FirstGuess {
  StrokeParameters parameters;  ///< With constant friction.
  Vec3 normal;                  ///< Of a plane.
};

/// Normals by the mean force with and without its part along the way; stiffness by regression of force on depth, and
/// as the quotient of both from where the contact seems to begin.
std::vector<FirstGuess> first_guesses(StrokeModel& model, double contact_force_n);

}  // namespace papilla
