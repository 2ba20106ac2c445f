// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

/// What the generated bindings say of the types of the headers.
namespace papilla::python {

struct EnumName {
  int value;
  const char* name;
};

/// k_type, the enumeration's name, and k_values, its enumerators: generated for each.
template <class E>
struct EnumNames;

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires {
  EnumNames<E>::k_values;
};

/// A struct whose fields are attributes in Python. Structured: of numbers alone, and a vector of them is a
/// structured array.
template <bool structured>
struct IsRecord {
  static constexpr bool k_is_record = true, k_is_structured = structured;
};
struct IsNoRecord {
  static constexpr bool k_is_record = false, k_is_structured = false;
};
template <class T>
struct RecordTraits : IsNoRecord {};

}  // namespace papilla::python
