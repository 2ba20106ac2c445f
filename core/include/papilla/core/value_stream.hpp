// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/fields.hpp"
#include "papilla/core/vec.hpp"

/// Values as bytes and back, for one program on one kind of machine: numbers as memory has them, of structs the fields
/// (fields.hpp), of texts, lists and maps the number of their entries first. Equal bytes of one type are equal values.
///
/// A type that is none of these lists what it holds in a function of its namespace, once for both directions:
///
///     template <class Stream, class Value>
///     requires std::is_same_v<std::remove_const_t<Value>, T>
///     void visit_value(Stream& stream, Value& value) { stream(value.a), stream(value.b); }
namespace papilla {

/// Whether a list of them is one run of bytes: nothing lies between their fields.
template <class T>
inline constexpr bool k_is_dense = (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) || std::is_enum_v<T>;
template <>
inline constexpr bool k_is_dense<Vec2> = true;
template <>
inline constexpr bool k_is_dense<Vec3> = true;
template <class T, std::size_t N>
inline constexpr bool k_is_dense<std::array<T, N>> = k_is_dense<T>;
template <class T, std::size_t N>
inline constexpr bool k_is_dense<T[N]> = k_is_dense<T>;

/// What is no part of a value for streams that leave it out: callbacks, deadlines, and pointers, which tell a
/// computation how to run and do not change a result that is complete.
template <class T>
inline constexpr bool k_is_transient = std::is_pointer_v<T> || std::is_same_v<T, Deadline>;
template <class T>
inline constexpr bool k_is_transient<std::function<T>> = true;

/// Gives the bytes of values to `Sink::write(const void* data, std::size_t size)`. Without transient ones where there
/// is a `Sink::leaves_out_transient`.
template <class Sink>
class ValueWriter {
 public:
  explicit ValueWriter(Sink& sink) : sink_(sink) {}

  template <class... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }

 private:
  void size(std::size_t count) { write(static_cast<std::uint64_t>(count)); }

  template <class T>
  void write(const T& value) {
    if constexpr (k_is_transient<T> && requires { Sink::leaves_out_transient; }) {
    } else if constexpr (std::is_same_v<T, bool>) {
      write(static_cast<std::uint8_t>(value));
    } else if constexpr (k_is_dense<T>) {
      sink_.write(&value, sizeof value);
    } else if constexpr (requires { visit_value(*this, value); }) {
      visit_value(*this, value);
    } else {
      static_assert(PlainStruct<T>);
      visit_fields(value, *this);
    }
  }
  template <class T, std::size_t N>
  void write(const T (&values)[N]) {
    for (const T& value : values) write(value);
  }
  template <class T, std::size_t N>
  void write(const std::array<T, N>& values) {
    for (const T& value : values) write(value);
  }
  void write(const std::string& text) {
    size(text.size());
    sink_.write(text.data(), text.size());
  }
  void write(const std::filesystem::path& path) { write(path.native()); }
  template <class A, class B>
  void write(const std::pair<A, B>& pair) {
    write(pair.first), write(pair.second);
  }
  template <class T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <class... Types>
  void write(const std::variant<Types...>& value) {
    size(value.index());
    std::visit([this](const auto& held) { write(held); }, value);
  }
  template <class T, class Allocator>
  void write(const std::vector<T, Allocator>& list) {
    size(list.size());
    if constexpr (k_is_dense<T>)
      sink_.write(list.data(), list.size() * sizeof(T));
    else
      for (const T& value : list) write(value);
  }
  template <class T, class... Rest>
  void write(const std::set<T, Rest...>& values) {
    size(values.size());
    for (const T& value : values) write(value);
  }
  template <class K, class V, class... Rest>
  void write(const std::map<K, V, Rest...>& values) {
    size(values.size());
    for (const auto& [key, value] : values) write(key), write(value);
  }

  Sink& sink_;
};

/// Takes values from `Source::read(void* data, std::size_t size)` in the order in which they were written.
/// @throws IoError when a list is announced that is longer than `Source::most_bytes()`, or an optional value that is
/// neither there nor not; whatever the source throws.
template <class Source>
class ValueReader {
 public:
  explicit ValueReader(Source& source) : source_(source) {}

  template <class... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }

 private:
  std::size_t size(std::size_t item) {
    std::uint64_t count = 0;
    read(count);
    if (count > source_.most_bytes() / item) throw IoError("a list is longer than what holds it");
    return static_cast<std::size_t>(count);
  }
  template <class T>
  T value() {
    T result{};
    read(result);
    return result;
  }

  template <class T>
  void read(T& value) {
    if constexpr (k_is_transient<T> && requires { Source::leaves_out_transient; }) {
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      read(byte);
      if (byte > 1) throw IoError("a truth value is neither 0 nor 1");
      value = byte != 0;
    } else if constexpr (k_is_dense<T>) {
      source_.read(&value, sizeof value);
    } else if constexpr (requires { visit_value(*this, value); }) {
      visit_value(*this, value);
    } else {
      static_assert(PlainStruct<T>);
      visit_fields(value, *this);
    }
  }
  template <class T, std::size_t N>
  void read(T (&values)[N]) {
    for (T& value : values) read(value);
  }
  template <class T, std::size_t N>
  void read(std::array<T, N>& values) {
    for (T& value : values) read(value);
  }
  void read(std::string& text) {
    text.resize(size(1));
    source_.read(text.data(), text.size());
  }
  void read(std::filesystem::path& path) { path = value<std::string>(); }
  template <class A, class B>
  void read(std::pair<A, B>& pair) {
    read(pair.first), read(pair.second);
  }
  template <class T>
  void read(std::optional<T>& value) {
    if (this->value<bool>())
      read(value.emplace());
    else
      value.reset();
  }
  template <class... Types>
  void read(std::variant<Types...>& value) {
    const auto index = this->value<std::uint64_t>();
    std::uint64_t number = 0;
    const bool known = ((number++ == index && (read(value.template emplace<Types>()), true)) || ...);
    if (!known) throw IoError("a value is of no type that it can have");
  }
  template <class T, class Allocator>
  void read(std::vector<T, Allocator>& list) {
    constexpr std::size_t k_item = k_is_dense<T> ? sizeof(T) : 1;
    list.resize(size(k_item));
    if constexpr (k_is_dense<T>)
      source_.read(list.data(), list.size() * sizeof(T));
    else
      for (T& value : list) read(value);
  }
  template <class T, class... Rest>
  void read(std::set<T, Rest...>& values) {
    values.clear();
    for (std::size_t left = size(1); left > 0; --left) values.insert(value<T>());
  }
  template <class K, class V, class... Rest>
  void read(std::map<K, V, Rest...>& values) {
    values.clear();
    for (std::size_t left = size(1); left > 0; --left) {
      K key = value<K>();
      read(values[std::move(key)]);
    }
  }

  Source& source_;
};

}  // namespace papilla
