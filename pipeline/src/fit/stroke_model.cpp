// SPDX-License-Identifier: MIT
#include "fit/stroke_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "papilla/haptic/friction.hpp"

namespace papilla {
namespace {

constexpr double k_smoothing_s = 1e-3;    // Of the velocity: HapticTick's.
constexpr double k_least_slide_m = 2e-6;  // Of a proxy in a sample; below, its direction is rounding. Over τ = 1.25 µm.
constexpr double k_skin_m = 2e-5;         // Of a contact surface: there the player knows of the contact.
constexpr double k_first_friction = 0.3, k_first_speed = 0.01;  // Of the descent.
constexpr double k_shallow_m = 1e-6;                            // Least depth that a first stiffness rests on.

Vec3 across(Vec3 v, Vec3 direction) { return v - dot(v, direction) * direction; }

/// Step of time to the sample, that of its successor for the first one.
double period_at(std::span<const StrokeSample> stroke, std::size_t i) {
  const std::size_t to = std::max<std::size_t>(i, 1);
  return stroke[to].t_s - stroke[to - 1].t_s;
}

std::vector<Vec3> velocities_of(std::span<const StrokeSample> stroke) {
  std::vector<Vec3> velocities;
  Vec3 v;
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const double period = period_at(stroke, i), share = period / (period + k_smoothing_s);
    if (stroke[i].velocity_m_per_s)
      v = *stroke[i].velocity_m_per_s;
    else if (i > 0)
      v = v + share * ((1 / period) * (stroke[i].probe_m - stroke[i - 1].probe_m) - v);
    velocities.push_back(v);
  }
  return velocities;
}

Vec3 behind(const StrokeSample& sample) { return *sample.proxy_m - sample.probe_m; }

/// Normals of the surface under recorded proxies. While a proxy slides, its way is tangential and so is its lag, which
/// friction makes: the rest of proxy − probe is along the normal. A proxy that rests has the normal of the nearest
/// sample of the same contact at which it slides; without one, that of proxy − probe.
std::vector<Vec3> recorded_normals(std::span<const StrokeSample> stroke) {
  std::vector<std::optional<Vec3>> sliding(stroke.size());
  const auto touches = [&](std::size_t i) { return norm(behind(stroke[i])) > k_least_slide_m; };
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    if (!touches(i) || !touches(i - 1)) continue;
    const Vec3 way = *stroke[i].proxy_m - *stroke[i - 1].proxy_m;
    if (norm(way) > k_least_slide_m) sliding[i] = normalized(across(behind(stroke[i]), normalized(way)));
  }
  constexpr std::size_t k_none = std::numeric_limits<std::size_t>::max();
  std::vector<Vec3> normals(stroke.size());
  std::vector<std::size_t> distance(stroke.size(), k_none);
  const auto spread = [&](std::size_t i, std::size_t last) {
    if (!touches(i)) last = k_none;
    if (sliding[i]) last = i;
    if (last == k_none) return last;
    const std::size_t away = i > last ? i - last : last - i;
    if (away < distance[i]) distance[i] = away, normals[i] = *sliding[last];
    return last;
  };
  std::size_t last = k_none;
  for (std::size_t i = 0; i < stroke.size(); ++i) last = spread(i, last);
  last = k_none;
  for (std::size_t i = stroke.size(); i-- > 0;) last = spread(i, last);
  for (std::size_t i = 0; i < stroke.size(); ++i)
    if (distance[i] == k_none && touches(i)) normals[i] = normalized(behind(stroke[i]));
  return normals;
}

/// Coulomb's friction of a proxy on a plane, and how fast it slips.
class SlidingFriction {
 public:
  /// @param slip_m_per_s smoothed; unchanged while it holds.
  Vec3 force(const ContactMaterial& material, Vec3 n, double load_n, Vec3 moved, double period_s,
             double& slip_m_per_s) noexcept {
    const Vec3 friction = bristles_.force(material, n, load_n, moved, period_s);
    const Vec3 now = (-1 / material.stiffness) * friction;
    const double slipped = norm(held_ + across(moved, n) - now);
    if (slipped > 1e-3 * norm(moved)) slip_m_per_s = speed_;
    speed_ += friction_memory_share(period_s) * (slipped / period_s - speed_);
    held_ = now;
    return friction;
  }
  void release() noexcept {
    bristles_.release();
    held_ = {}, speed_ = 0;
  }

 private:
  BristleFriction bristles_;
  Vec3 held_;         // Deflection.
  double speed_ = 0;  // As that of the bristles.
};

/// Two unit vectors across a unit vector.
std::array<Vec3, 2> tangents(Vec3 n) {
  const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(n, axis));
  return {u, cross(n, u)};
}

/// Direction of the mean force, and main direction of the way while there is force.
struct ContactShape {
  Vec3 mean_force, way;
};

ContactShape contact_shape(std::span<const StrokeSample> stroke, double contact_force_n) {
  ContactShape shape;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> places;
  for (const StrokeSample& sample : stroke) {
    if (norm(sample.force_n) < contact_force_n) continue;
    shape.mean_force = shape.mean_force + sample.force_n;
    places.emplace_back(sample.probe_m.x, sample.probe_m.y, sample.probe_m.z);
    mean += places.back();
  }
  mean /= static_cast<double>(places.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& place : places) spread += (place - mean) * (place - mean).transpose();
  const Eigen::Vector3d way = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  shape.way = {way.x(), way.y(), way.z()};
  shape.mean_force = normalized(shape.mean_force);
  return shape;
}

/// Stiffness and offset of a spring.
struct Spring {
  double stiffness = 0, offset = 0;
};

/// By regression of the force along `normal` on the depth, where there is force, and through the place where contact
/// seems to begin: on a recorded surface the surface, else the shallowest one that was felt.
std::vector<Spring> first_springs(const StrokeModel& model, double contact_force_n, Vec3 normal) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, shallowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < model.stroke().size(); ++i) {
    const Vec3 felt = model.stroke()[i].force_n;
    if (norm(felt) < contact_force_n) continue;
    const double depth = model.depth(i, normal), force = std::max(0.0, dot(felt, model.normal_at(i, normal)));
    n += 1, x += depth, y += force, xx += depth * depth, xy += depth * force;
    shallowest = std::min(shallowest, depth);
  }
  const double mean_depth = x / n, mean_force = y / n, spread = xx - x * x / n, slope = (xy - x * y / n) / spread;
  const double begin = model.surface() == StrokeSurface::recorded ? 0 : shallowest;
  std::vector<Spring> springs;
  const auto add = [&](double stiffness) {
    const double k = std::clamp(stiffness, 1.0, 1e6);
    const double offset = mean_depth - mean_force / k;
    springs.push_back(
        {k, model.surface() == StrokeSurface::recorded ? std::clamp(offset, 0.0, k_widest_gap_m) : offset});
  };
  add(mean_force / std::max(mean_depth - begin, k_shallow_m));
  if (spread > 0 && slope > 0) add(slope);
  return springs;
}

}  // namespace

std::vector<StrokeModel::Recorded> StrokeModel::recorded_of(std::span<const StrokeSample> stroke) {
  const std::vector<Vec3> normals = recorded_normals(stroke);
  std::vector<Recorded> recorded(stroke.size());
  double speed = 0;
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const Vec3 n = normals[i];
    recorded[i] = {n, across(behind(stroke[i]), n), false, speed};
    if (i == 0) continue;
    const bool touches = norm(behind(stroke[i])) > k_least_slide_m && norm(behind(stroke[i - 1])) > k_least_slide_m;
    const double slipped = touches ? norm(across(*stroke[i].proxy_m - *stroke[i - 1].proxy_m, n)) : 0;
    recorded[i].slips = slipped > k_least_slide_m;
    const double period = period_at(stroke, i);
    speed += friction_memory_share(period) * (slipped / period - speed);
  }
  return recorded;
}

Vec3 StrokeModel::recorded_friction(std::size_t i, const ContactMaterial& material, double depth_m,
                                    double& slip_m_per_s) const {
  const Recorded& sample = recorded_[i];
  if (!sample.slips) return material.stiffness * sample.lag;
  slip_m_per_s = sample.slip_m_per_s;
  return friction_coefficient(material, sample.slip_m_per_s) * material.stiffness * depth_m * normalized(sample.lag);
}

StrokeModel::StrokeModel(std::span<const StrokeSample> stroke, StrokeSurface surface, double contact_force_n,
                         const std::optional<SafetyLimits>& guard)
    : stroke_(stroke), surface_(surface), guard_(guard), velocity_(velocities_of(stroke)) {
  if (surface_ == StrokeSurface::recorded) recorded_ = recorded_of(stroke);
  double count = 0;
  for (const StrokeSample& sample : stroke)
    if (norm(sample.force_n) >= contact_force_n) middle_ = middle_ + sample.probe_m, ++count;
  if (count > 0) middle_ = (1 / count) * middle_;
  set_normal({0, 0, 1});
}

void StrokeModel::set_normal(Vec3 normal) {
  normal_ = normal;
  const auto [u, v] = tangents(normal);
  along_u_ = u, along_v_ = v;
}

Vec3 StrokeModel::normal(const StrokeParameters& p) const {
  if (surface_ == StrokeSurface::plane)
    return normalized(normal_ + p.x[StrokeParameters::tilt_u] * along_u_ + p.x[StrokeParameters::tilt_v] * along_v_);
  Vec3 mean;
  for (const Recorded& sample : recorded_) mean = mean + sample.normal;
  return normalized(mean);
}

Vec3 StrokeModel::normal_at(std::size_t i, Vec3 plane) const {
  return surface_ == StrokeSurface::plane ? plane : recorded_[i].normal;
}

double StrokeModel::depth(std::size_t i, Vec3 plane) const {
  if (surface_ == StrokeSurface::plane) return dot(plane, middle_ - stroke_[i].probe_m);
  return dot(recorded_[i].normal, behind(stroke_[i]));
}

void StrokeModel::evaluate(const StrokeParameters& p, std::vector<ModelForce>& forces) const {
  ContactMaterial material;
  material.stiffness = std::exp(p.x[StrokeParameters::stiffness]);
  material.damping = p.x[StrokeParameters::damping];
  material.dynamic_friction = p.x[StrokeParameters::dynamic_friction];
  material.static_friction = material.dynamic_friction + p.x[StrokeParameters::friction_drop];
  material.stribeck_velocity = std::exp(p.x[StrokeParameters::stribeck]);
  const double offset = p.x[StrokeParameters::offset];
  const Vec3 plane = normal(p);
  SlidingFriction sliding;
  std::optional<ForceGuard> guard;
  if (guard_) guard.emplace(*guard_);
  forces.resize(stroke_.size());
  for (std::size_t i = 0; i < stroke_.size(); ++i) {
    ModelForce& force = forces[i];
    const Vec3 n = normal_at(i, plane);
    const double depth = this->depth(i, plane) - offset, period = period_at(stroke_, i);
    const Vec3 moved = i > 0 ? stroke_[i].probe_m - stroke_[i - 1].probe_m : Vec3{};
    force = {{}, n, 0, 0, velocity_[i]};
    if (depth > 0) {
      force.load_n = material.stiffness * depth;
      const Vec3 friction = surface_ == StrokeSurface::plane
                                ? sliding.force(material, n, force.load_n, moved, period, force.slip_m_per_s)
                                : recorded_friction(i, material, depth, force.slip_m_per_s);
      const double push = force.load_n - material.damping * dot(velocity_[i], n);
      force.force_n = std::max(0.0, push) * n + friction;
    } else {
      sliding.release();
    }
    if (!guard) continue;
    ContactStep step;
    if (depth > -k_skin_m) step = {true, material.stiffness * std::abs(dot(n, moved)), material.stiffness, moved};
    force.force_n = guard->apply(force.force_n, period, 0, step);
  }
}

std::vector<FirstGuess> first_guesses(StrokeModel& model, double contact_force_n) {
  const ContactShape shape = contact_shape(model.stroke(), contact_force_n);
  std::vector<Vec3> normals = {shape.mean_force};
  // Friction tilts the mean force along the way; where most of the way is along the surface, without that part.
  if (const Vec3 n = normalized(across(shape.mean_force, shape.way)); norm(n) > 0) normals.push_back(n);
  if (model.surface() == StrokeSurface::recorded) normals.resize(1);
  std::vector<FirstGuess> guesses;
  for (const Vec3 normal : normals)
    for (const Spring& spring : first_springs(model, contact_force_n, normal)) {
      StrokeParameters p;
      p.x[StrokeParameters::stiffness] = std::log(spring.stiffness);
      p.x[StrokeParameters::offset] = spring.offset;
      p.x[StrokeParameters::dynamic_friction] = k_first_friction;
      p.x[StrokeParameters::stribeck] = std::log(k_first_speed);
      guesses.push_back({p, normal});
    }
  return guesses;
}

}  // namespace papilla
