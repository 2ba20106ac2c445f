// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "papilla/core/progress.hpp"

namespace papilla {

/// What a library does with a file that may be hostile, in three steps.
struct IsolatedWork {
  std::filesystem::path path;                        ///< The file, as messages name it.
  std::string library;                               ///< As messages name it: "the CAD library".
  std::function<void(const ProgressCallback&)> run;  ///< In the child.
  std::function<void(int pipe)> send;                ///< In the child, after run(): what it made (pipe_stream.hpp).
  std::function<void(int pipe)> receive;             ///< In the caller.
};

/// Runs `work` in a child process and hands over what it sends, reports or throws. When the child crashes,
/// hangs or runs out of memory, throws InvalidInput that names the file and the progress made.
///
/// The child is forked and has none of the caller's other threads: `run` and `send` must take no lock that one of those
/// may hold at that moment. The system's malloc, and the operator new of the program papilla, are free for them.
///
/// The child may use four fifths of the machine's memory, and the processor time that it allows itself. Its standard
/// streams lead nowhere.
void run_isolated(const IsolatedWork& work, const ProgressCallback& progress);

/// Sets the limit of processor time, of all threads, from now on, in a child of run_isolated(); does nothing elsewhere.
void allow_processor_time(double seconds);

/// Lowers the limit of memory, with what the child takes already, in a child of run_isolated(); does nothing elsewhere.
void allow_memory(double bytes);

}  // namespace papilla
