// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "papilla/core/vec.hpp"
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
  double load_n = 0;         ///< k·δ; 0 without contact.
  double slip_m_per_s = 0;   ///< 0 while it holds.
  Vec3 velocity_m_per_s;     ///< That damping acts on.
};

/// The path of a stroke with the surface that it touched, on which the model of fit_material() is evaluated.
class StrokeModel {
 public:
  /// @param surface `recorded` or `plane`.
  StrokeModel(std::span<const StrokeSample> stroke, StrokeSurface surface, double contact_force_n);

  /// The forces of all samples, in order. Deterministic; cost: 50 ns a sample.
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
  Vec3 middle_, normal_{0, 0, 1}, along_u_, along_v_;
  std::vector<Vec3> normals_;  ///< Of a recorded surface.
  std::vector<Vec3> velocity_;
};

/// First parameters and, for a plane, normal. The friction is constant.
StrokeParameters first_parameters(StrokeModel& model, double contact_force_n);

}  // namespace papilla
