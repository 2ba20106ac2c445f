// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/io/scene.hpp"

/// Values over a pipe between two processes of the same program, as memory has them. A type that is neither trivially
/// copyable nor a string nor a list is sent by a function visit_value(pipe, value), which lists its fields for both
/// directions: `pipe` is a ValueSender and `value` const, or a ValueReceiver.
namespace papilla {

/// Raw bytes; both @throw IoError when the other end is gone.
void send_bytes(int pipe, const void* data, std::size_t size);
void receive_bytes(int pipe, void* data, std::size_t size);

template <class T>
concept PlainValue = std::is_trivially_copyable_v<T>;

/// Sends values in the order in which ValueReceiver takes them. @throws IoError when the other end is closed.
class ValueSender {
 public:
  explicit ValueSender(int pipe) : pipe_(pipe) {}

  template <class T>
  void operator()(const T& value) {
    if constexpr (PlainValue<T>)
      append(&value, sizeof value);
    else
      visit_value(*this, value);
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  template <class T>
  void operator()(const std::vector<T>& list) {
    (*this)(static_cast<std::uint64_t>(list.size()));
    if constexpr (PlainValue<T>)
      append(list.data(), list.size() * sizeof(T));
    else
      for (const T& value : list) (*this)(value);
  }
  void flush();

 private:
  void append(const void* data, std::size_t size);

  int pipe_;
  std::vector<char> buffer_;
};

/// The other end. @throws IoError when the pipe ends early or announces a list longer than 2^37 bytes.
class ValueReceiver {
 public:
  explicit ValueReceiver(int pipe) : pipe_(pipe) {}

  template <class T>
  void operator()(T& value) {
    if constexpr (PlainValue<T>)
      receive_bytes(pipe_, &value, sizeof value);
    else
      visit_value(*this, value);
  }
  void operator()(std::string& text) {
    text.resize(size_of(1));
    receive_bytes(pipe_, text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    list.resize(size_of(sizeof(T)));
    if constexpr (PlainValue<T>)
      receive_bytes(pipe_, list.data(), list.size() * sizeof(T));
    else
      for (T& value : list) (*this)(value);
  }

 private:
  std::size_t size_of(std::size_t item);

  int pipe_;
};

/// A reader's scene: all of it but haptic tags, levels of detail, and where it came from.
void visit_value(ValueSender& pipe, const Scene& scene);
void visit_value(ValueReceiver& pipe, Scene& scene);

}  // namespace papilla
