// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/trace.hpp"

namespace papilla {

/// Samples that no other one beats in both time and error, from the fastest to the slowest. Errors that are not finite
/// are no candidates.
Trace pareto_front(const std::vector<Trace>& traces);

/// Whether a sample of the trace is on the front.
bool reaches_front(const Trace& trace, const Trace& front);

}  // namespace papilla
