// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

#include "papilla/core/progress.hpp"
#include "papilla/io/cad_reader.hpp"

namespace papilla::cad {

/// Runs `work` in a child process and hands over what it returns, reports or throws. When the child crashes,
/// hangs or runs out of memory, throws InvalidInput that names the file and the progress made.
///
/// The child may use four fifths of the machine's memory, and the processor time that it allows itself.
Scene run_isolated(const std::filesystem::path& path, CadReport& report, const ProgressCallback& progress,
                   const std::function<Scene(CadReport&, const ProgressCallback&)>& work);

/// Sets the limit of processor time, of all threads, from now on, in a child of run_isolated(); does nothing elsewhere.
void allow_processor_time(double seconds);

}  // namespace papilla::cad
