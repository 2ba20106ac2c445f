// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/io/scene.hpp"

namespace papilla::fuzz {

/// Ends the program unless the scene keeps what every reader promises: finite numbers, indices in range, attributes of
/// the triangles' number, a forest of nodes.
void require_promises(const Scene& scene);

}  // namespace papilla::fuzz
