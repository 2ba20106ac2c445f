// SPDX-License-Identifier: MIT
#include "papilla/core/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

extern char** environ;

namespace papilla {
namespace {

constexpr off_t k_longest_messages = 1 << 16;

std::array<std::atomic<pid_t>, 1024> g_children;  ///< 0: free.

int register_child(pid_t child) {
  for (std::size_t i = 0; i < g_children.size(); ++i)
    if (pid_t free = 0; g_children[i].compare_exchange_strong(free, child)) return static_cast<int>(i);
  return -1;
}

std::string reason(int error) { return std::generic_category().message(error); }

/// Starts a program. @returns its number, or 0 with `error` set.
pid_t spawn(std::vector<std::string>& words, const std::filesystem::path& folder, int messages, int& error) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
  ::posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);  // Such as sockets of libraries.
  if (!folder.empty()) ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  error = ::posix_spawnp(&child, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : 0;
}

std::string tail_of(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0) return {};
  std::string text(static_cast<std::size_t>(std::min(status.st_size, k_longest_messages)), '\0');
  const ssize_t got = ::pread(file, text.data(), text.size(), status.st_size - static_cast<off_t>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  text.erase(text.find_last_not_of('\n') + 1);
  return text;
}

double seconds(const timeval& time) {
  constexpr double k_micro = 1e-6;
  return static_cast<double>(time.tv_sec) + k_micro * static_cast<double>(time.tv_usec);
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> words, const std::filesystem::path& folder) {
  messages_ = ::memfd_create("messages", MFD_CLOEXEC);
  if (messages_ < 0) throw IoError(words.front() + ": cannot be started: " + reason(errno));
  int error = 0;
  child_ = spawn(words, folder, messages_, error);
  if (child_ == 0) {
    ::close(messages_);
    if (error == ENOENT) throw ProgramMissing(words.front() + ": cannot be started: " + reason(error));
    throw IoError(words.front() + ": cannot be started: " + reason(error));
  }
  slot_ = register_child(child_);
}

ChildProcess::~ChildProcess() {
  if (child_ != 0) {
    send(SIGTERM);
    wait();
  }
  ::close(messages_);
}

void ChildProcess::send(int signal) const noexcept {
  if (child_ != 0) ::kill(child_, signal);
}

bool ChildProcess::is_running() const noexcept {
  siginfo_t info{};
  return child_ != 0 && ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOWAIT | WNOHANG) == 0 &&
         info.si_pid == 0;
}

std::string ChildProcess::messages() const { return tail_of(messages_); }

ChildEnd ChildProcess::wait() {
  // Its number is free for another process only when it is off the list.
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
  if (slot_ >= 0) g_children[static_cast<std::size_t>(slot_)] = 0;
  int status = 0;
  rusage used{};
  while (::wait4(child_, &status, 0, &used) < 0 && errno == EINTR) {
  }
  child_ = 0;
  ChildEnd end;
  constexpr int k_shell_signal = 128;
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.exit_code = end.signal != 0 ? k_shell_signal + end.signal : WEXITSTATUS(status);
  end.cpu_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  end.peak_mib = static_cast<double>(used.ru_maxrss) / 1024;
  end.messages = tail_of(messages_);
  return end;
}

void signal_children(int signal) noexcept {
  for (const std::atomic<pid_t>& child : g_children)
    if (const pid_t number = child; number != 0) ::kill(number, signal);
}

}  // namespace papilla
