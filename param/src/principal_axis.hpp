// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/core/vec.hpp"

namespace papilla::param_detail {

/// The direction d of length 1 with the greatest d·M d, for a symmetric positive semidefinite M given by its rows.
/// z when no direction is better than it. Power iteration: directions that are as good as each other are not told
/// apart.
Vec3 principal_axis(const std::array<Vec3, 3>& rows);

}  // namespace papilla::param_detail
