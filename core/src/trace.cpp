// SPDX-License-Identifier: MIT
#include "papilla/core/trace.hpp"

namespace papilla {

std::string_view to_string(StopReason reason) noexcept {
  switch (reason) {
    case StopReason::converged: return "converged";
    case StopReason::direct: return "direct";
    case StopReason::iteration_limit: return "iteration_limit";
    case StopReason::time_limit: return "time_limit";
    case StopReason::line_search_stalled: return "line_search_stalled";
  }
  return "unknown";
}

}  // namespace papilla
