// SPDX-License-Identifier: MIT
#include "sentinel.hpp"

#include <fcntl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace papilla::player {
namespace {

/// Whether the other process wrote the release byte before it closed the pipe.
bool read_release(int pipe_end) {
  char byte = 0;
  ssize_t got = -1;
  do got = ::read(pipe_end, &byte, 1);
  while (got < 0 && errno == EINTR);
  return got == 1;
}

}  // namespace

Sentinel::Sentinel(const std::function<void()>& switch_off) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  child_ = ::fork();
  if (child_ == 0) {
    // Signals of the terminal reach the whole process group.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
    ::close(ends[1]);
    try {
      if (!read_release(ends[0])) switch_off();
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  ::close(ends[0]);
  if (child_ < 0)
    ::close(ends[1]);
  else
    pipe_ = ends[1];
}

Sentinel::~Sentinel() {
  if (child_ <= 0) return;
  const char byte = 1;
  while (::write(pipe_, &byte, 1) < 0 && errno == EINTR) {
  }
  ::close(pipe_);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace papilla::player
