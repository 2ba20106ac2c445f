// SPDX-License-Identifier: MIT
#include "papilla/core/read_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "descriptor.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"

namespace papilla {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int reason) {
  throw IoError(path.string() +
                (reason == ENOENT ? ": does not exist" : ": " + std::generic_category().message(reason)));
}

void require_regular(const struct stat& status, const std::filesystem::path& path) {
  if (S_ISDIR(status.st_mode)) throw IoError(path.string() + ": is a directory");
  if (!S_ISREG(status.st_mode)) throw IoError(path.string() + ": is not a regular file");
}

}  // namespace

void require_file(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) fail(path, errno);
  require_regular(status, path);
  note_input(path);
}

std::string read_file(const std::filesystem::path& path) {
  require_file(path);
  const int opened = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (opened < 0) fail(path, errno);
  const Descriptor file(opened);
  struct stat status {};
  if (::fstat(file, &status) != 0) fail(path, errno);
  require_regular(status, path);  // Another file may have taken the name.
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::read(file, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, errno);
    if (got == 0) throw IoError(path.string() + ": became shorter while it was read");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace papilla
