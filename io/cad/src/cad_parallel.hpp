// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace papilla::cad {

/// As many threads as TBB may use. To be asked for before the process is forked: another thread may be asking, too.
int wanted_threads();

/// Lets so many of OpenCASCADE's own threads do the work. They, unlike TBB's, are not started before the process is
/// forked.
void set_up_threads(int wanted);

/// To be called in a forked child: threads of the parent are gone.
void after_fork();

/// Whether there may be more than one thread.
bool is_parallel();

/// Calls body(0) ... body(count - 1), each once, in any order. The failure of the lowest index is thrown when all are
/// done.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace papilla::cad
