// SPDX-License-Identifier: MIT
#include "principal_axis.hpp"

namespace papilla::param_detail {

Vec3 principal_axis(const std::array<Vec3, 3>& rows) {
  constexpr int k_power_steps = 200;
  const auto times = [&](Vec3 d) { return Vec3{dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)}; };
  Vec3 best{0, 0, 1};
  // From every axis, so that none is orthogonal to the answer.
  for (const Vec3 start : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    Vec3 d = start;
    for (int i = 0; i < k_power_steps; ++i)
      if (const Vec3 next = normalized(times(d)); norm(next) > 0) d = next;
    if (dot(d, times(d)) > (1 + 1e-9) * dot(best, times(best))) best = d;
  }
  return best;
}

}  // namespace papilla::param_detail
