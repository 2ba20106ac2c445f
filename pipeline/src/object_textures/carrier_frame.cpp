// SPDX-License-Identifier: MIT
#include "object_textures/carrier_frame.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// Area, its centre, the sum of its normals, and the second moments about the centre.
struct Moments {
  double area = 0;
  Vec3 centre, facing;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Eigen::Vector3d column(Vec3 v) { return {v.x, v.y, v.z}; }

Moments moments_of(const TriangleMesh& mesh, const std::vector<Index>& triangles) {
  Moments m;
  const auto doubled = [&](Index t) {
    return cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
  };
  for (const Index t : triangles) {
    const double area = 0.5 * norm(doubled(t));
    m.area += area;
    m.facing = m.facing + 0.5 * doubled(t);
    m.centre = m.centre + (area / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2));
  }
  if (!(m.area > 0)) throw InvalidInput("what is to be replaced has no area");
  m.centre = (1 / m.area) * m.centre;
  for (const Index t : triangles) {
    const double area = 0.5 * norm(doubled(t));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d v = column(mesh.corner(t, k) - m.centre);
      sum += v;
      squares += v * v.transpose();
    }
    m.second += (area / 12) * (squares + sum * sum.transpose());
  }
  return m;
}

/// The direction that is tried when `up` is along the look.
Vec3 another_up(Vec3 forward) { return std::abs(forward.x) < std::abs(forward.z) ? Vec3{1, 0, 0} : Vec3{0, 0, -1}; }

ProjectorAxes axes_along(Vec3 forward, Vec3 up) {
  constexpr double k_least_sine = 1e-3;
  const bool is_across = norm(cross(normalized(forward), normalized(up))) > k_least_sine;
  return projector_axes(forward, is_across ? up : another_up(normalized(forward)));
}

}  // namespace

CarrierFrame fit_carrier(const TriangleMesh& mesh, const std::vector<Index>& triangles, const CarrierWish& wish) {
  constexpr double k_least_facing = 1e-3;
  const Moments m = moments_of(mesh, triangles);
  CarrierFrame frame;
  Vec3 forward;
  if (wish.direction) {
    forward = *wish.direction;
  } else {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m.second);  // Eigenvalues ascend.
    const Eigen::Vector3d n = solver.eigenvectors().col(0);
    const Vec3 normal{n.x(), n.y(), n.z()};
    const bool has_front = std::abs(dot(m.facing, normal)) > k_least_facing * m.area;
    const double front = has_front ? dot(m.facing, normal) : dot(wish.seen_from - m.centre, normal);
    forward = front < 0 ? normal : -normal;
  }
  frame.axes = axes_along(forward, wish.up);
  Bounds2 bounds;
  for (const Index t : triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = mesh.corner(t, k) - m.centre;
      bounds.add(Vec2{dot(d, frame.axes.right), dot(d, frame.axes.up)});
    }
  frame.width_mm = bounds.size().x, frame.height_mm = bounds.size().y;
  if (!(frame.width_mm > 0 && frame.height_mm > 0))
    throw InvalidInput("what is to be replaced is a line as seen along the direction");
  frame.middle = m.centre + bounds.middle().x * frame.axes.right + bounds.middle().y * frame.axes.up;
  return frame;
}

TriangleMesh carrier_mesh(const CarrierFrame& frame) {
  TriangleMesh mesh;
  for (const Vec2 uv : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) {
    mesh.positions.push_back(frame.corner(uv.x - 0.5, uv.y - 0.5));
    mesh.uv.values.push_back(uv);
  }
  mesh.triangles = mesh.uv.indices = {{0, 1, 2}, {0, 2, 3}};
  mesh.normals.values = {-frame.axes.forward};
  mesh.normals.indices = {{0, 0, 0}, {0, 0, 0}};
  mesh.material = {0, 0};
  return mesh;
}

}  // namespace papilla
