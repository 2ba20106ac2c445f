// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace papilla::texture_detail {

/// R(t) = Σ_x I(x) I(x + t) over the overlap, for |dx| ≤ reach_x and 0 ≤ dy ≤ reach_y: row dy holds dx = −reach_x …
/// reach_x. Two zero-padded Fourier transforms; rows that are zero before or not asked for after are left out, and the
/// columns are transformed there and back while they are in the cache.
/// @param values width × height values, best with a mean near 0.
std::vector<double> autocorrelation(const std::vector<double>& values, int width, int height, int reach_x, int reach_y);

}  // namespace papilla::texture_detail
