// SPDX-License-Identifier: MIT
#pragma once

#include "bench/bench_json.hpp"

namespace papilla::bench {

/// Processor time and memory a pixel of the verbs on pictures of rising size, each as a whole process, and how far
/// shape from shading in pieces is from that of the whole picture.
void report_sizes(BenchReport& report);

}  // namespace papilla::bench
