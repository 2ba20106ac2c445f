// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "bench/bench_json.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::bench {

/// A run over a surface that is watched for lost contacts, allocations, locks and, where one is known, for the distance
/// from a reference.
struct LongRun {
  long ticks = 0, contact = 0, lost = 0, allocations = 0, locks = 0;
  double worst_gap_m = 0;  ///< Largest distance of the proxy from the reference, beyond one tick of travel.
  long gaps = 0;           ///< Ticks on which that was more than 0.1 mm.
  long compared = 0;       ///< Ticks with a reference.
  long asides = 0;         ///< Of these, ticks where it is the answer to a probe one tolerance aside.
};

/// A stroke over a CAD part, beside a descent and, where the surface is less curved than the probe is deep, beside the
/// global closest point.
struct CadRun {
  LongRun descent;
  long flat_compared = 0, flat_gaps = 0;
  double worst_flat_gap_m = 0;
};

/// 400 000 slivers of 0.02 × 10 mm under a point that presses 1 to 3 mm deep; the reference is the global closest
/// point.
LongRun sliver_run(long ticks, int seeds);

/// A relief over `size` metres of about `triangles`; the reference, in every hundredth tick, is a converged descent in
/// double precision from the proxy of the tick before (testing::ReferenceDescent).
LongRun relief_run(double size, long triangles, long ticks, int seeds);

/// A random slide over a part in millimetres, 1 mm deep; references in every tenth tick.
CadRun cad_run(const Part& part, long ticks, int seeds);

/// A sphere of 0.1 m; the reference is the global closest point.
LongRun sphere_run(long triangles, long ticks, int seeds);

/// p99.9 of the wake-up of our loop and of cyclictest at 1 kHz, in turn; nothing without cyclictest.
struct WakeUp {
  struct Quantiles {
    double median_us = 0, all_us = 0;
  };
  Quantiles ours, cyclictest;
};
std::optional<WakeUp> wake_up();

/// Length of a program without its symbols; nothing without strip.
std::optional<long> stripped_bytes(const std::string& program);

/// Adds the rows that need no timing of their own.
void add_contact_targets(BenchReport& report);

}  // namespace papilla::bench
