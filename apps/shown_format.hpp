// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "papilla/core/one_line.hpp"

namespace papilla::app {

/// A value that is printed: a text as shown() makes it, anything else as it is.
template <class T>
decltype(auto) shown_value(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>)
    return shown(value);
  else
    return (value);
}

template <class T>
using ShownValue = std::remove_cvref_t<decltype(shown_value(std::declval<const T&>()))>;

/// fmt::format() for lines that people read: no value, whatever file it comes from, breaks the line or steers the
/// terminal. Line breaks belong into the format.
template <class... T>
std::string shown_format(fmt::format_string<ShownValue<T>...> format, const T&... values) {
  return fmt::vformat(format, fmt::make_format_args(static_cast<const ShownValue<T>&>(shown_value(values))...));
}

}  // namespace papilla::app
