// SPDX-License-Identifier: MIT
#include "gltf_transform.hpp"

#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla::gltf {

Transform transform_from_trs(Vec3 t, const std::array<double, 4>& q, Vec3 s, const std::string& where) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0)) throw InvalidInput(where + ": rotation is the zero quaternion");
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  return {s.x * (1 - 2 * (y * y + z * z)),
          s.y * 2 * (x * y - z * w),
          s.z * 2 * (x * z + y * w),
          t.x,
          s.x * 2 * (x * y + z * w),
          s.y * (1 - 2 * (x * x + z * z)),
          s.z * 2 * (y * z - x * w),
          t.y,
          s.x * 2 * (x * z - y * w),
          s.y * 2 * (y * z + x * w),
          s.z * (1 - 2 * (x * x + y * y)),
          t.z,
          0,
          0,
          0,
          1};
}

}  // namespace papilla::gltf
