// SPDX-License-Identifier: MIT
#include "papilla/io/isolated.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/io/pipe_stream.hpp"

namespace papilla {
namespace {

bool g_is_child = false;

enum class Message : std::uint8_t { progress, result, invalid_input, io_error, other_error };

class Pipe {
 public:
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw IoError("no pipe can be made (" + std::string(std::strerror(errno)) + ")");
    read_ = ends[0];
    write_ = ends[1];
  }
  ~Pipe() {
    close_read();
    close_write();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return read_; }
  int write_end() const { return write_; }
  void close_read() { close(read_); }
  void close_write() { close(write_); }

 private:
  static void close(int& end) {
    if (end >= 0) ::close(std::exchange(end, -1));
  }
  int read_ = -1, write_ = -1;
};

void send_text(int pipe, Message kind, const std::string& text, double number = 0) {
  const auto size = static_cast<std::uint64_t>(text.size());
  send_bytes(pipe, &kind, sizeof kind);
  send_bytes(pipe, &number, sizeof number);
  send_bytes(pipe, &size, sizeof size);
  send_bytes(pipe, text.data(), text.size());
}

std::string receive_text(int pipe, double& number) {
  std::uint64_t size = 0;
  receive_bytes(pipe, &number, sizeof number);
  receive_bytes(pipe, &size, sizeof size);
  constexpr std::uint64_t k_longest = 1 << 20;
  if (size > k_longest) throw IoError("the reading process sent nonsense");
  std::string text(static_cast<std::size_t>(size), '\0');
  receive_bytes(pipe, text.data(), text.size());
  return text;
}

void limit(decltype(RLIMIT_AS) what, rlim_t soft) {
  rlimit limits{};
  if (::getrlimit(what, &limits) != 0) return;
  limits.rlim_cur = std::min(soft, limits.rlim_max);
  ::setrlimit(what, &limits);
}

void limit_child() {
  limit(RLIMIT_CORE, 0);
#if !defined(__SANITIZE_ADDRESS__)
  const double physical = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  constexpr double k_part = 0.8;
  limit(RLIMIT_AS, static_cast<rlim_t>(k_part * physical));
#endif
}

/// The library prints to the standard streams, which are the caller's.
void be_silent() {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere < 0) return;
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

[[noreturn]] void be_child(int pipe, const IsolatedWork& work) {
  g_is_child = true;
  ::signal(SIGPIPE, SIG_DFL);
  limit_child();
  be_silent();
  int code = 0;
  try {
    work.run([pipe](const Progress& done) {
      send_text(pipe, Message::progress, std::string(done.stage), done.fraction);
      return true;
    });
    const Message kind = Message::result;
    send_bytes(pipe, &kind, sizeof kind);
    work.send(pipe);
  } catch (const InvalidInput& error) {
    send_text(pipe, Message::invalid_input, error.what());
  } catch (const IoError& error) {
    send_text(pipe, Message::io_error, error.what());
  } catch (const std::bad_alloc&) {
    send_text(pipe, Message::other_error, "needs more memory than there is");
  } catch (const std::exception& error) {
    send_text(pipe, Message::other_error, error.what());
  } catch (...) {
    code = 1;
  }
  // Not exit(): it would run the destructors of the caller's static objects in the child.
  ::_exit(code);
}

/// Ends the child when the caller leaves before it.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_;
};

std::string cause_of_death(int status, const std::string& library) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return "takes more time than any sound file of its size";
    if (signal == SIGKILL) return "needs more memory than there is";
    return "makes " + library + " crash (" + ::strsignal(signal) + ")";
  }
  return "makes " + library + " give up";
}

}  // namespace

void run_isolated(const IsolatedWork& work, const ProgressCallback& progress) {
  Pipe pipe;
  const pid_t id = ::fork();
  if (id < 0)
    throw IoError(work.path.string() + ": no process can be started to read it (" + std::strerror(errno) + ")");
  if (id == 0) {
    pipe.close_read();
    be_child(pipe.write_end(), work);
  }
  Child child(id);
  pipe.close_write();
  std::string stage = "start";
  double fraction = 0;
  for (;;) {
    Message kind{};
    try {
      receive_bytes(pipe.read_end(), &kind, sizeof kind);
      if (kind == Message::result) {
        work.receive(pipe.read_end());
        child.wait();
        return;
      }
      double number = 0;
      const std::string text = receive_text(pipe.read_end(), number);
      if (kind == Message::invalid_input) throw InvalidInput(text);
      if (kind == Message::other_error) throw InvalidInput(work.path.string() + ": " + text);
      if (kind == Message::progress) {
        stage = text;
        fraction = number;
      } else if (kind == Message::io_error) {
        stage.clear();
        throw IoError(text);
      }
    } catch (const IoError&) {
      if (stage.empty()) throw;
      const std::string why = cause_of_death(child.wait(), work.library);
      throw InvalidInput(work.path.string() + ": " + why + " (stage '" + stage + "', " +
                         std::to_string(static_cast<int>(100 * fraction)) + " % done)");
    }
    if (kind == Message::progress) report_progress(progress, stage, fraction);
  }
}

void allow_processor_time(double seconds) {
  if (!g_is_child) return;
  rusage used{};
  if (::getrusage(RUSAGE_SELF, &used) != 0) return;
  const double now = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
  limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(now + 1 + seconds)));
}

void allow_memory([[maybe_unused]] double bytes) {
#if !defined(__SANITIZE_ADDRESS__)
  rlimit now{};
  if (!g_is_child || ::getrlimit(RLIMIT_AS, &now) != 0) return;
  long pages = 0;
  {
    const int statm = ::open("/proc/self/statm", O_RDONLY);
    char text[32] = {};
    if (statm < 0) return;
    if (::read(statm, text, sizeof text - 1) > 0) pages = std::strtol(text, nullptr, 10);
    ::close(statm);
  }
  const double taken = static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  limit(RLIMIT_AS, std::min(now.rlim_cur, static_cast<rlim_t>(taken + bytes)));
#endif
}

}  // namespace papilla
