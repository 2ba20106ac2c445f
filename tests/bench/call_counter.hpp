// SPDX-License-Identifier: MIT
#pragma once

namespace papilla::bench {

/// How often this program has asked for memory and taken a mutex so far, counted by functions that stand in front of
/// the system's.
long allocations() noexcept;
long locks() noexcept;

}  // namespace papilla::bench
