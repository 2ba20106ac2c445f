// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla {

/// There is no program of that name.
class ProgramMissing : public IoError {
 public:
  using IoError::IoError;
};

/// How a process ended and what it took.
struct ChildEnd {
  int exit_code = 0;  ///< As shells have it: 128 and the signal's number when a signal ended it.
  int signal = 0;     ///< That ended it; 0: none did.
  double cpu_seconds = 0;
  double peak_mib = 0;   ///< Largest resident memory.
  std::string messages;  ///< What it wrote to standard error: the last 64 KiB, without the end of the line.
};

/// Another program that runs beside this one, without standard input and output; what it says on standard error is
/// kept. Not for several threads at once.
class ChildProcess {
 public:
  /// Starts it with the environment of this process.
  /// @param words  program and arguments; a program without a slash is looked for in PATH.
  /// @param folder in which it starts; empty: that of this process.
  /// @throws ProgramMissing, IoError naming the program and the system's reason.
  explicit ChildProcess(std::vector<std::string> words, const std::filesystem::path& folder = {});
  /// One that still runs gets SIGTERM and is waited for.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void send(int signal) const noexcept;
  bool is_running() const noexcept;
  /// What it wrote to standard error so far, as ChildEnd::messages.
  std::string messages() const;
  /// Waits for its end. Once.
  ChildEnd wait();

 private:
  int child_ = 0;      ///< 0 when it was waited for.
  int messages_ = -1;  ///< A file in memory.
  int slot_ = -1;      ///< Of the list that signal_children() goes through.
};

/// Sends a signal to every child process that was not waited for, to 1,024 at most; may be called from a signal
/// handler.
void signal_children(int signal) noexcept;

}  // namespace papilla
