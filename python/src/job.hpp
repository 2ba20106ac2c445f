// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "papilla/core/progress.hpp"

namespace papilla::python {

namespace py = pybind11;

/// Runs `work` without the GIL. `callback`, when it is not None, is called as callback(stage, fraction) with the GIL;
/// returning False cancels, and what it raises is raised here once the work has ended.
///
/// Signals reach Python's main thread only, and progress comes from any thread: so the work of a call from the main
/// thread is done by another one, while the main one waits and lets signal handlers run. What these raise
/// (KeyboardInterrupt) ends the work at its next report of progress.
/// @throws what the work throws; py::error_already_set.
void run_job(const std::function<void(const ProgressCallback&)>& work, const py::object& callback);

}  // namespace papilla::python
