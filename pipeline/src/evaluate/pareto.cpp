// SPDX-License-Identifier: MIT
#include "evaluate/pareto.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {

Trace pareto_front(const std::vector<Trace>& traces) {
  Trace all, front;
  for (const Trace& trace : traces)
    std::copy_if(trace.begin(), trace.end(), std::back_inserter(all),
                 [](const TraceSample& s) { return std::isfinite(s.error); });
  std::stable_sort(all.begin(), all.end(), [](const TraceSample& a, const TraceSample& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.error < b.error;
  });
  for (const TraceSample& s : all)
    if (front.empty() || s.error < front.back().error) front.push_back(s);
  return front;
}

bool reaches_front(const Trace& trace, const Trace& front) {
  return std::any_of(trace.begin(), trace.end(), [&](const TraceSample& s) {
    return std::any_of(front.begin(), front.end(),
                       [&](const TraceSample& f) { return f.seconds == s.seconds && f.error == s.error; });
  });
}

}  // namespace papilla
