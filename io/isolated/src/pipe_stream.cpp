// SPDX-License-Identifier: MIT
#include "papilla/io/pipe_stream.hpp"

#include <unistd.h>

#include <cerrno>

#include "papilla/core/error.hpp"

namespace papilla {

void PipeSink::write(const void* data, std::size_t size) {
  constexpr std::size_t k_large = 1 << 16;
  if (size >= k_large) {
    flush();
    send_bytes(pipe_, data, size);
    return;
  }
  const char* bytes = static_cast<const char*>(data);
  buffer_.insert(buffer_.end(), bytes, bytes + size);
  if (buffer_.size() >= k_large) flush();
}

void PipeSink::flush() {
  send_bytes(pipe_, buffer_.data(), buffer_.size());
  buffer_.clear();
}

void send_bytes(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::write(pipe, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw IoError("the pipe to the caller is closed");
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void receive_bytes(int pipe, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(pipe, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw IoError("the reading process ended early");
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

}  // namespace papilla
