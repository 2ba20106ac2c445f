// SPDX-License-Identifier: MIT
#include "papilla/core/append_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"

namespace papilla {
namespace {

/// A new file's name is on the disk when its folder is.
void sync_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  const int opened = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return;
  ::fsync(opened);
  ::close(opened);
}

/// All bytes, or the reason.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

AppendFile::AppendFile(const std::filesystem::path& path) : path_(path) {
  note_output(path);
  file_ = ::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NOCTTY | O_NONBLOCK, 0666);
  if (file_ < 0) fail(errno);
  try {
    struct stat status {};
    if (::fstat(file_, &status) != 0) fail(errno);
    if (!S_ISREG(status.st_mode)) throw IoError(path.string() + ": is no regular file");
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw IoError(path.string() + ": another process appends to it");
    std::array<char, 65536> piece{};
    for (;;) {
      const ssize_t got = ::read(file_, piece.data(), piece.size());
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(errno);
      if (got == 0) break;
      content_.append(piece.data(), static_cast<std::size_t>(got));
    }
    const std::size_t whole = content_.rfind('\n') + 1;  // npos + 1 is 0.
    removed_bytes_ = content_.size() - whole;
    content_.resize(whole);
    if (removed_bytes_ > 0 && ::ftruncate(file_, static_cast<off_t>(whole)) != 0) fail(errno);
    sync_folder(path);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

AppendFile::~AppendFile() { ::close(file_); }

void AppendFile::append(std::string_view line) {
  const off_t before = ::lseek(file_, 0, SEEK_END);
  const std::string bytes = std::string(line) + '\n';
  int reason = write_all(file_, bytes);
  if (reason == 0 && ::fsync(file_) != 0 && errno != EINVAL) reason = errno;
  if (reason == 0) return;
  if (::ftruncate(file_, before) != 0) reason = errno;
  fail(reason);
}

void AppendFile::fail(int reason) const { throw IoError(path_.string() + ": " + std::strerror(reason)); }

}  // namespace papilla
