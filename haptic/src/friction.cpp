// SPDX-License-Identifier: MIT
#include "papilla/haptic/friction.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {
namespace {

constexpr double k_memory_s = 1e-2;  // Assumed.

Vec3 tangential(Vec3 v, Vec3 normal) noexcept { return v - dot(v, normal) * normal; }

}  // namespace

std::string_view name_of(FrictionModel model) noexcept {
  return model == FrictionModel::bristle ? "bristle" : "coulomb";
}

std::optional<FrictionModel> friction_model(std::string_view name) noexcept {
  for (const FrictionModel model : {FrictionModel::coulomb, FrictionModel::bristle})
    if (name_of(model) == name) return model;
  return std::nullopt;
}

double friction_coefficient(const ContactConstants& material, double speed) noexcept {
  if (!(speed > 0) || material.static_friction == material.dynamic_friction) return material.static_friction;
  const double ratio = material.stribeck_velocity > 0 ? speed / material.stribeck_velocity : 1e3;
  return material.dynamic_friction + (material.static_friction - material.dynamic_friction) * std::exp(-ratio * ratio);
}

double friction_memory_share(double period_s) noexcept { return -std::expm1(-period_s / k_memory_s); }

Vec3 BristleFriction::force(const ContactMaterial& material, Vec3 normal, double load_n, Vec3 moved,
                            double period_s) noexcept {
  const bool rigid = material.friction == FrictionModel::coulomb;
  const double stiffness = material.bristle_stiffness > 0 && !rigid
                               ? std::min(material.bristle_stiffness, material.stiffness)
                               : material.stiffness;
  const Vec3 way = tangential(moved, normal);
  const double length = norm(way);
  const auto follow = [&](double slipped) {
    if (period_s > 0) speed_ += friction_memory_share(period_s) * (slipped / period_s - speed_);
  };
  if (!rigid) follow(length);
  const double most = material.static_friction * load_n;
  if (!(stiffness > 0) || !(most > 0)) {
    deflection_ = {};
    return {};
  }
  deflection_ = tangential(deflection_, normal);
  if (rigid) {
    deflection_ = deflection_ + way;
    const double held = friction_coefficient(material, speed_) * load_n / stiffness, deflected = norm(deflection_);
    if (deflected > held) deflection_ = (held / deflected) * deflection_;
    follow(std::max(0.0, deflected - held));
    return -stiffness * deflection_;
  }
  if (length > 0) {
    const double steady = friction_coefficient(material, speed_) * load_n / stiffness;
    const double left = steady > 0 ? std::exp(-length / steady) : 0;
    const Vec3 end = (steady / length) * way;
    deflection_ = end + left * (deflection_ - end);
  }
  if (const double deflected = norm(deflection_); stiffness * deflected > most)
    deflection_ = (most / (stiffness * deflected)) * deflection_;
  return -stiffness * deflection_;
}

}  // namespace papilla
