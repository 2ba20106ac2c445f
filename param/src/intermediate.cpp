// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "check_mesh.hpp"
#include "corner_charts.hpp"
#include "mesh_frame.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/param/projections.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr double k_pi = std::numbers::pi;

/// Objects without extent in a direction count as having this fraction of their diagonal there.
constexpr double k_least_extent = 1e-3;

/// Rays that meet the shape farther away than this, in half diagonals of the object, miss it.
constexpr double k_reach = 16;

struct Ray {
  Vec3 origin, direction;
};

/// The intermediate surface in a frame of its own: z up, the middle of the object at 0.
struct Surroundings {
  Vec3 half;  ///< Half extents of the object.
  double radius = 0, sphere_radius = 0;
  double apex = 0;  ///< Height of the cone's apex.

  /// The cone's radius at a height.
  double cone_radius(double z) const { return 2 * radius * (apex - z) / (4 * half.z); }
};

Surroundings surroundings_of(const Bounds3& bounds, UpAxis up) {
  const UprightFrame frame = upright_frame(up);
  const Vec3 extent = bounds.size();
  const double least = k_least_extent * std::max(bounds.diagonal(), 1e-300);
  const auto half = [&](Vec3 axis) { return 0.5 * std::max(std::abs(dot(axis, extent)), least); };
  Surroundings s;
  s.half = {half(frame.right), half(frame.back), half(frame.up)};
  s.radius = std::max(s.half.x, s.half.y);
  s.sphere_radius = std::max(s.radius, s.half.z);
  s.apex = 3 * s.half.z;  // the radius is R at the top, 2 R at the bottom
  return s;
}

/// The larger root of a s² + 2 b s + c = 0, or a negative number.
double larger_root(double a, double b, double c) {
  const double root = b * b - a * c;
  if (!(a > 0) || !(root >= 0)) return -1;
  return (std::sqrt(root) - b) / a;
}

/// Longitude and latitude, longitude and height, or longitude and distance from the apex.
struct SurfacePoint {
  double longitude = 0, across = 0;
  bool on_axis = false;  ///< The longitude says nothing.
};

SurfacePoint around_axis(Vec3 q, double across) {
  return {std::atan2(q.x, -q.y), across, !(std::hypot(q.x, q.y) > 1e-12 * norm(q))};
}

class Mapper {
 public:
  Mapper(const TriangleMesh& mesh, const IntermediateOptions& options)
      : mesh_(mesh), options_(options), frame_(upright_frame(options.up)), normals_(vertex_normals(mesh)) {
    const Bounds3 bounds = bounds_of(mesh);
    middle_ = bounds.middle();
    around_ = surroundings_of(bounds, options.up);
    eye_ = options.eye ? to_own(*options.eye) : Vec3{0, -3 * std::max(bounds.diagonal(), 1e-300), 0};
  }

  CornerUv map(std::size_t t) const {
    if (options_.shape == IntermediateShape::box) return map_box(t);
    std::array<SurfacePoint, 3> points;
    for (std::size_t k = 0; k < 3; ++k) points[k] = find(mesh_.triangles[t][k]);
    keep_together(points);
    CornerUv uv;
    for (std::size_t k = 0; k < 3; ++k) uv[k] = unroll(points[k]);
    return uv;
  }

 private:
  Vec3 to_own(Vec3 p) const {
    const Vec3 d = p - middle_;
    return {dot(frame_.right, d), dot(frame_.back, d), dot(frame_.up, d)};
  }
  Vec3 turn(Vec3 n) const { return {dot(frame_.right, n), dot(frame_.back, n), dot(frame_.up, n)}; }

  Ray ray(Vec3 p, Vec3 n) const {
    switch (options_.rule) {
      case IntermediateRule::reflected_ray: {
        const Vec3 view = normalized(p - eye_);
        return {p, view - 2 * dot(view, n) * n};
      }
      case IntermediateRule::object_normal: return {p, n};
      default: return {{}, p};
    }
  }

  SurfacePoint find(Index vertex) const {
    const Vec3 p = to_own(mesh_.positions[vertex]);
    if (options_.rule != IntermediateRule::intermediate_normal) {
      const Ray r = ray(p, turn(normals_[vertex]));
      const double s = hit(r);
      if (s > 0 && s * norm(r.direction) <= k_reach * norm(around_.half)) return describe(r.origin + s * r.direction);
    }
    return foot(p);
  }

  double hit(const Ray& r) const {
    const Vec3 o = r.origin, d = r.direction;
    switch (options_.shape) {
      case IntermediateShape::sphere:
        return larger_root(dot(d, d), dot(o, d), dot(o, o) - around_.sphere_radius * around_.sphere_radius);
      case IntermediateShape::cylinder:
        return larger_root(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y,
                           o.x * o.x + o.y * o.y - around_.radius * around_.radius);
      default: {
        const double slope = around_.cone_radius(0) / around_.apex, height = around_.apex - o.z;
        return larger_root(d.x * d.x + d.y * d.y - slope * slope * d.z * d.z,
                           o.x * d.x + o.y * d.y + slope * slope * height * d.z,
                           o.x * o.x + o.y * o.y - slope * slope * height * height);
      }
    }
  }

  /// The nearest point of the surface: its normal runs through p.
  SurfacePoint foot(Vec3 p) const {
    if (options_.shape != IntermediateShape::cone) return describe(p);
    // Along the generator: unit vector (outward, down) from the apex.
    const double angle = std::atan2(around_.cone_radius(0), around_.apex);
    return around_axis(p, std::hypot(p.x, p.y) * std::sin(angle) + (around_.apex - p.z) * std::cos(angle));
  }

  SurfacePoint describe(Vec3 q) const {
    switch (options_.shape) {
      case IntermediateShape::sphere: return around_axis(q, std::atan2(q.z, std::hypot(q.x, q.y)));
      case IntermediateShape::cylinder: return around_axis(q, q.z);
      default: return around_axis(q, std::hypot(std::hypot(q.x, q.y), around_.apex - q.z));
    }
  }

  /// Longitudes of one triangle differ by less than half a turn; undefined ones take the mean of the others.
  static void keep_together(std::array<SurfacePoint, 3>& points) {
    const auto known = std::find_if(points.begin(), points.end(), [](const SurfacePoint& p) { return !p.on_axis; });
    if (known == points.end()) return;
    double sum = 0, count = 0;
    for (SurfacePoint& p : points) {
      if (p.on_axis) continue;
      if (p.longitude - known->longitude > k_pi) p.longitude -= 2 * k_pi;
      if (p.longitude - known->longitude < -k_pi) p.longitude += 2 * k_pi;
      sum += p.longitude, ++count;
    }
    for (SurfacePoint& p : points)
      if (p.on_axis) p.longitude = sum / count;
  }

  Vec2 unroll(const SurfacePoint& p) const {
    switch (options_.shape) {
      case IntermediateShape::sphere: return {around_.sphere_radius * p.longitude, around_.sphere_radius * p.across};
      case IntermediateShape::cylinder: return {around_.radius * p.longitude, p.across};
      default: {
        // Distance from the apex is kept, angles shrink by the sine of the opening.
        const double angle = std::sin(std::atan2(around_.cone_radius(0), around_.apex)) * p.longitude;
        return {p.across * std::sin(angle), -p.across * std::cos(angle)};
      }
    }
  }

  /// One face of the box for the whole triangle.
  CornerUv map_box(std::size_t t) const {
    Vec3 middle, normal;
    for (const Index v : mesh_.triangles[t]) {
      middle = middle + (1.0 / 3) * to_own(mesh_.positions[v]);
      normal = normal + turn(normals_[v]);
    }
    if (options_.rule == IntermediateRule::intermediate_normal) {
      const Vec3 face =
          turn(normalized(cross(mesh_.corner(t, 1) - mesh_.corner(t, 0), mesh_.corner(t, 2) - mesh_.corner(t, 0))));
      return lay_on_face(t, norm(face) > 0 ? face : middle);
    }
    const Ray r = ray(middle, normalized(normal));
    const Vec3 q = r.origin + hit_box(r) * r.direction;
    return lay_on_face(t, {q.x / around_.half.x, q.y / around_.half.y, q.z / around_.half.z});
  }

  double hit_box(const Ray& r) const {
    double least = std::numeric_limits<double>::infinity();
    const auto face = [&](double o, double d, double half) {
      if (d != 0) least = std::min(least, (std::copysign(half, d) - o) / d);
    };
    face(r.origin.x, r.direction.x, around_.half.x);
    face(r.origin.y, r.direction.y, around_.half.y);
    face(r.origin.z, r.direction.z, around_.half.z);
    return std::isfinite(least) ? std::max(least, 0.0) : 0;
  }

  /// On the face of the box that `towards` looks at most.
  CornerUv lay_on_face(std::size_t t, Vec3 towards) const {
    const std::array<double, 3> c{towards.x, towards.y, towards.z};
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (std::abs(c[a]) > (1 + 1e-9) * std::abs(c[axis])) axis = a;
    const double sign = c[axis] < 0 ? -1 : 1;
    const ProjectionAxes axes = projection_axes(static_cast<int>(axis), sign < 0, UpAxis::z);
    CornerUv uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = meet_face(mesh_.triangles[t][k], axis, sign);
      const std::array<double, 3> q{p.x, p.y, p.z};
      uv[k] = {axes.u_sign * q[static_cast<std::size_t>(axes.u_axis)],
               axes.v_sign * q[static_cast<std::size_t>(axes.v_axis)]};
    }
    return uv;
  }

  /// Where the vertex's ray meets the plane of a face; the foot of its perpendicular where it does not.
  Vec3 meet_face(Index vertex, std::size_t axis, double sign) const {
    const Vec3 p = to_own(mesh_.positions[vertex]);
    if (options_.rule == IntermediateRule::intermediate_normal) return p;
    const Ray r = ray(p, turn(normals_[vertex]));
    const auto across = [axis](Vec3 q) { return std::array<double, 3>{q.x, q.y, q.z}[axis]; };
    const double distance = sign * across(around_.half) - across(r.origin), approach = across(r.direction);
    const double s = approach * sign > 0 ? distance / approach : -1;
    // What lies on the face is there, up to rounding.
    const double least = -1e-9 * norm(around_.half), reach = s * norm(r.direction);
    return reach >= least && reach <= k_reach * norm(around_.half) ? r.origin + s * r.direction : p;
  }

  const TriangleMesh& mesh_;
  const IntermediateOptions& options_;
  UprightFrame frame_;
  std::vector<Vec3> normals_;
  Vec3 middle_, eye_;
  Surroundings around_;
};

}  // namespace

ProjectionResult flatten_intermediate(const TriangleMesh& mesh, const IntermediateOptions& options) {
  constexpr const char* k_function = "flatten_intermediate";
  check_mesh(mesh, k_function);
  if (options.eye && !is_finite(*options.eye)) throw InvalidInput(std::string(k_function) + ": eye is not finite");
  const Mapper mapper(mesh, options);
  std::vector<CornerUv> uv(mesh.triangles.size());
  for (std::size_t t = 0; t < uv.size(); ++t) uv[t] = mapper.map(t);
  CornerCharts charts = charts_of_corners(mesh, uv, std::vector<std::uint32_t>(uv.size(), 0));
  return {std::move(charts.flattening), charts.turned_over, {}};
}

}  // namespace papilla
