// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace papilla::texture_detail {

/// Periodic leather-like relief of size_px² samples over size_mm, in arbitrary units.
std::vector<double> leather_relief(int size_px, double size_mm, std::uint64_t seed);

}  // namespace papilla::texture_detail
