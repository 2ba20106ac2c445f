// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace papilla::cad {

/// Calls body(0) ... body(count - 1) on OpenCASCADE's threads, each once, in any order. The first failure of the lowest
/// index is thrown when all are done.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace papilla::cad
