// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/evaluate/evaluation.hpp"

namespace papilla {

/// A wall with this damping on every simulated device, at 1 kHz:
/// - `stability-limit`: bisection for the softest wall that shakes, by pressing against it, step by step; the error is
///   how far the stiffness reached is above that of the closed form, stiffness_limit(), as a share of it.
/// - `passivity`: the energy in joules that the hand was given in time by a wall of eight times that stiffness, as
/// asked,
///   with the controller, and clamped to the limit.
/// @param damping of the wall as asked for, N·s/m; devices that can't hold any wall with it are named.
std::vector<EvaluationRun> wall_runs(const EvaluationInput& input, double damping);

}  // namespace papilla
