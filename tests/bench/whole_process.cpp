// SPDX-License-Identifier: MIT
#include "whole_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"

extern char** environ;

namespace papilla::bench {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// The child's peak so far; 0 when it has ended. What wait4() says includes the memory of the process that forked it.
std::size_t peak_bytes_of(pid_t child) {
  std::ifstream status("/proc/" + std::to_string(child) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stoul(line.substr(6));
  return 0;
}

/// Waits for the child's end, looking at its memory every two milliseconds.
std::size_t watch(pid_t child, int& status, rusage& used) {
  std::size_t peak = 0;
  while (true) {
    const pid_t ended = wait4(child, &status, WNOHANG, &used);
    if (ended != 0) break;
    peak = std::max(peak, peak_bytes_of(child));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return peak;
}

}  // namespace

ProcessCost run_process(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const Stopwatch clock;
  pid_t child = 0;
  const int started = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (started != 0) throw IoError(command[0] + ": cannot be started");

  int status = 0;
  rusage used{};
  const std::size_t peak = watch(child, status, used);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw IoError(command[0] + ": failed with status " + std::to_string(status));
  return {clock.seconds(), seconds_of(used.ru_utime) + seconds_of(used.ru_stime), peak};
}

bool has_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace papilla::bench
