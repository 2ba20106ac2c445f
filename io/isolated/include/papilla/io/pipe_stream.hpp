// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/core/value_stream.hpp"

/// Values (value_stream.hpp) over a pipe between two processes of the same program.
namespace papilla {

/// Raw bytes; both @throw IoError when the other end is gone.
void send_bytes(int pipe, const void* data, std::size_t size);
void receive_bytes(int pipe, void* data, std::size_t size);

/// Collects small values; flush() sends what is left.
class PipeSink {
 public:
  explicit PipeSink(int pipe) : pipe_(pipe) {}
  /// @throws IoError when the other end is closed.
  void write(const void* data, std::size_t size);
  void flush();

 private:
  int pipe_;
  std::vector<char> buffer_;
};

/// The other end.
class PipeSource {
 public:
  explicit PipeSource(int pipe) : pipe_(pipe) {}
  /// @throws IoError when the pipe ends early.
  void read(void* data, std::size_t size) { receive_bytes(pipe_, data, size); }
  std::uint64_t most_bytes() const noexcept { return std::uint64_t{1} << 37; }

 private:
  int pipe_;
};

/// Sends the values at once.
template <class... Values>
void send_values(int pipe, const Values&... values) {
  PipeSink sink(pipe);
  ValueWriter{sink}(values...);
  sink.flush();
}

/// What send_values() sent at the other end.
template <class... Values>
void receive_values(int pipe, Values&... values) {
  PipeSource source(pipe);
  ValueReader{source}(values...);
}

}  // namespace papilla
