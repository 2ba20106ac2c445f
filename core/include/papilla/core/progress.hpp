// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

namespace papilla {

/// Told by long work how far it is: the stage's name and the fraction done in [0, 1].
/// May be empty. Called from the thread that runs the work, at most a few hundred times.
using Progress = std::function<void(std::string_view stage, double fraction)>;

}  // namespace papilla
