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

StopReason worse(StopReason a, StopReason b) noexcept {
  const auto severity = [](StopReason stop) {
    switch (stop) {
      case StopReason::direct: return 0;
      case StopReason::converged: return 1;
      case StopReason::line_search_stalled: return 2;
      case StopReason::iteration_limit: return 3;
      case StopReason::time_limit: return 4;
    }
    return 0;
  };
  return severity(b) > severity(a) ? b : a;
}

}  // namespace papilla
