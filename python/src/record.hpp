// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "numpy.hpp"
#include "papilla/core/deadline.hpp"
#include "record_names.hpp"
#include "storage.hpp"

/// Plain structs of the headers as classes of Python: fields are attributes and keywords of the constructor.
///
/// Arrays and structs within are looked at, not copied: changes through them change the struct. What is std::optional,
/// set or pair of plain values comes as a copy.
namespace papilla::python {

/// A field without its type.
struct FieldEntry {
  const char* name = "";
  const char* annotation = "";  ///< Its type as stubs have it.
  const char* doc = "";
  py::object (*get)(void* self, py::handle owner) = nullptr;
  void (*set)(void* self, py::handle value, const std::string& place) = nullptr;
  void (*retire)(void* self) = nullptr;  ///< Before the whole struct is assigned.
  py::object (*dtype)() = nullptr;       ///< Of numbers; else null.
  std::size_t offset = 0;                ///< In a struct of numbers.
  bool is_inherited = false;
};

/// A struct without its type.
struct RecordEntry {
  std::string name;
  std::vector<FieldEntry> fields;
  std::size_t bytes = 0;
  void* (*self)(py::handle) = nullptr;
  py::object dtype = {};  ///< numpy's, of a struct of numbers; made when it is first asked for.
};

/// The entry of a struct, filled when the module is loaded.
template <class T>
RecordEntry& entry_of() {
  static auto* entry = new RecordEntry;  // Holds Python objects: never destroyed.
  return *entry;
}

py::object record_dtype(RecordEntry& entry);
void add_properties(py::object type, RecordEntry& entry, py::module_& module);
void retire_fields(const RecordEntry& entry, void* self);
/// Sets fields by name. @throws UsageError for a name that is none, with the nearest one that is.
void set_fields(const RecordEntry& entry, void* self, const py::dict& values);
std::string record_text(const RecordEntry& entry, py::handle self);
void add_choice_names(py::module_& module, const char* type, const char* doc, const py::tuple& names);
[[noreturn]] void throw_unknown_choice(const char* type, const std::string& name,
                                       const std::vector<std::string_view>& known);

template <class T>
inline constexpr bool k_is_record = RecordTraits<T>::k_is_record;
template <class T>
struct RecordTraits<CornerAttribute<T>> : IsRecord<false> {};

/// Classes that are bound by hand and looked at like records; with a buffer they are never assigned.
template <class T>
struct IsBoundClass : std::false_type {};
template <bool buffer>
struct BoundByHand : std::true_type {
  static constexpr bool k_has_buffer = buffer;
};

template <class T>
concept RecordType = k_is_record<T>;
template <class T>
concept BoundClass = IsBoundClass<T>::value;

template <class T>
struct ContainerTraits {
  static constexpr bool k_is_vector = false, k_is_map = false, k_is_optional = false;
};
template <class T, class A>
struct ContainerTraits<std::vector<T, A>> {
  static constexpr bool k_is_vector = true, k_is_map = false, k_is_optional = false;
};
template <class K, class T>
struct ContainerTraits<std::map<K, T>> {
  static constexpr bool k_is_vector = false, k_is_map = true, k_is_optional = false;
};
template <class T>
struct ContainerTraits<std::optional<T>> {
  static constexpr bool k_is_vector = false, k_is_map = false, k_is_optional = true;
};

template <class T>
concept Vector = ContainerTraits<T>::k_is_vector;
template <class T>
concept Optional = ContainerTraits<T>::k_is_optional;
template <class T>
concept NumberVector = Vector<T> &&
    (Number<typename T::value_type> || Row<typename T::value_type>)&&!std::is_same_v<typename T::value_type, bool>;
template <class T>
concept StructuredVector = Vector<T> && RecordTraits<typename T::value_type>::k_is_structured;
template <class T>
concept RecordVector = Vector<T> && k_is_record<typename T::value_type> && !StructuredVector<T>;
template <class T>
concept RecordMap = ContainerTraits<T>::k_is_map && k_is_record<typename T::mapped_type>;
template <class T>
concept RecordOptional = Optional<T> && k_is_record<typename T::value_type>;

/// The enumerator's name.
template <NamedEnum E>
const char* name_of(E value) {
  for (const EnumName& known : EnumNames<E>::k_values)
    if (known.value == static_cast<int>(value)) return known.name;
  return "";
}

/// The enumerator of that name; - counts as _. @throws UsageError naming those that there are.
template <NamedEnum E>
E enumerator(std::string name) {
  for (char& letter : name)
    if (letter == '-') letter = '_';
  std::vector<std::string_view> known;
  for (const EnumName& one : EnumNames<E>::k_values) {
    if (name == one.name) return static_cast<E>(one.value);
    known.push_back(one.name);
  }
  throw_unknown_choice(EnumNames<E>::k_type, name, known);
}

template <class T>
py::object to_python(T& value, py::handle owner);
template <class T>
void from_python(T& value, py::handle given, const std::string& place);

/// A structured array of this type. @throws UsageError for anything else.
py::array structured_array(py::handle given, const py::dtype& dtype, const std::string& place);

[[noreturn]] void throw_wrong_type(py::handle given, const std::string& place, const std::string& wanted);
/// Of an integer.
[[noreturn]] void throw_out_of_range(py::handle given, const std::string& place, const std::string& low,
                                     const std::string& high);

/// A copy of a container so that nobody changes it in vain: lists as tuples, sets frozen, dictionaries as proxies.
py::object read_only(const py::object& copy);

/// A copy of an object of a class that is bound by hand.
template <BoundClass T>
T copy_of_class(py::handle given, const std::string& place) {
  if (!py::isinstance<T>(given))
    throw_wrong_type(given, place, py::type::of<T>().attr("__name__").template cast<std::string>());
  return given.cast<const T&>();
}

/// A record from one of its class, or from a dictionary of its fields.
template <RecordType T>
void record_from(T& value, py::handle given, const std::string& place) {
  if (py::isinstance<T>(given)) {
    if constexpr (std::is_copy_assignable_v<T>) {
      T copy = given.cast<const T&>();
      retire_fields(entry_of<T>(), &value);
      value = std::move(copy);  // A copy would be written into arrays that the value borrows.
    } else {
      throw UsageError(place + ": can't be copied");
    }
  } else if (py::isinstance<py::dict>(given)) {
    set_fields(entry_of<T>(), &value, py::reinterpret_borrow<py::dict>(given));
  } else {
    throw_wrong_type(given, place, entry_of<T>().name);
  }
}

template <class T>
py::object to_python(T& value, py::handle owner) {
  if constexpr (std::is_same_v<T, Deadline>) {
    return value.never() ? py::none() : py::object(py::float_(value.left()));
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    return value.empty() ? py::none() : py::cast(value);
  } else if constexpr (Row<T>) {
    return view_of_one(value, owner);
  } else if constexpr (RecordType<T> || BoundClass<T>) {
    return py::cast(&value, py::return_value_policy::reference_internal, owner);
  } else if constexpr (NumberVector<T>) {
    return view_of(value.data(), value.size(), storage_at(&value, typeid(T), owner));
  } else if constexpr (StructuredVector<T>) {
    return py::array(py::reinterpret_borrow<py::dtype>(record_dtype(entry_of<typename T::value_type>())),
                     {static_cast<py::ssize_t>(value.size())}, {}, value.data(), storage_at(&value, typeid(T), owner));
  } else if constexpr (RecordVector<T>) {
    const py::object storage = storage_at(&value, typeid(T), owner);
    py::tuple elements(value.size());
    for (std::size_t i = 0; i < value.size(); ++i)
      elements[i] = py::cast(&value[i], py::return_value_policy::reference_internal, storage);
    return elements;
  } else if constexpr (RecordMap<T>) {
    const py::object storage = storage_at(&value, typeid(T), owner);
    py::dict elements;
    for (auto& [key, element] : value) {
      auto copy = key;
      elements[to_python(copy, owner)] = py::cast(&element, py::return_value_policy::reference_internal, storage);
    }
    return read_only(elements);
  } else if constexpr (RecordOptional<T>) {
    if (!value) return py::none();
    return py::cast(&*value, py::return_value_policy::reference_internal, storage_at(&value, typeid(T), owner));
  } else if constexpr (std::is_array_v<T>) {
    py::list elements;
    for (auto& element : value) elements.append(to_python(element, owner));
    return py::tuple(elements);
  } else {
    return read_only(py::cast(value));
  }
}

template <class T>
void from_python(T& value, py::handle given, const std::string& place) {
  if constexpr (std::is_same_v<T, Deadline>) {
    value = given.is_none() ? Deadline() : Deadline(given.cast<double>());
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    try {
      value = given.is_none() ? T() : given.cast<T>();
    } catch (const py::cast_error&) {
      throw_wrong_type(given, place, "a path");
    }
  } else if constexpr (std::is_same_v<T, std::string_view>) {
    throw UsageError(place + ": can only be read");
  } else if constexpr (BoundClass<T>) {
    if constexpr (IsBoundClass<T>::k_has_buffer)
      throw UsageError(place + ": can only be read; its array may be changed in place");
    else
      value = copy_of_class<T>(given, place);
  } else if constexpr (Row<T>) {
    copy_row(given, value, place);
  } else if constexpr (RecordType<T>) {
    record_from(value, given, place);
  } else if constexpr (NumberVector<T>) {
    T values;
    read_rows(given, values, place);
    retire(value);
    value = std::move(values);
  } else if constexpr (StructuredVector<T>) {
    using Element = typename T::value_type;
    const py::dtype dtype = py::reinterpret_borrow<py::dtype>(record_dtype(entry_of<Element>()));
    const py::array array = structured_array(given, dtype, place);
    T values(static_cast<std::size_t>(array.size()));
    if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), array.data(), values.size() * sizeof(Element));
    retire(value);
    value = std::move(values);
  } else if constexpr (RecordVector<T>) {
    T values;
    for (const py::handle element : py::reinterpret_borrow<py::object>(given))
      record_from(values.emplace_back(), element, place + "[" + std::to_string(values.size() - 1) + "]");
    retire(value);
    value = std::move(values);
  } else if constexpr (RecordMap<T>) {
    if (!PyMapping_Check(given.ptr())) throw_wrong_type(given, place, "dict");
    T values;
    for (const auto& [key, element] : py::dict(py::reinterpret_borrow<py::object>(given))) {
      typename T::key_type k{};
      from_python(k, key, place);
      record_from(values[k], element, place + "[" + py::str(key).cast<std::string>() + "]");
    }
    retire(value);
    value = std::move(values);
  } else if constexpr (RecordOptional<T>) {
    if (!given.is_none()) {
      if (!value) value.emplace();
      record_from(*value, given, place);
    } else {
      if (is_in_use(&value, typeid(T))) throw UsageError(place + ": a variable still refers to it; delete that first");
      value.reset();
    }
  } else if constexpr (Optional<T>) {
    if (given.is_none()) {
      value.reset();
    } else if constexpr (BoundClass<typename T::value_type>) {
      value = copy_of_class<typename T::value_type>(given, place);
    } else {
      typename T::value_type made{};
      from_python(made, given, place);
      value = std::move(made);
    }
  } else if constexpr (std::is_array_v<T>) {
    const py::tuple elements(py::reinterpret_borrow<py::object>(given));
    if (elements.size() != std::size(value))
      throw UsageError(place + ": needs " + std::to_string(std::size(value)) + " values, got " +
                       std::to_string(elements.size()));
    for (std::size_t i = 0; i < elements.size(); ++i) from_python(value[i], elements[i], place);
  } else {
    try {
      value = given.cast<T>();
    } catch (const py::cast_error&) {
      if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
        if (PyLong_Check(given.ptr()))
          throw_out_of_range(given, place, std::to_string(std::numeric_limits<T>::min()),
                             std::to_string(std::numeric_limits<T>::max()));
      throw_wrong_type(given, place, py::detail::make_caster<T>::name.text);
    }
  }
}

/// Before a struct is assigned as a whole: what Python looks at stays.
template <class T>
void retire_value(T& value) {
  if constexpr (NumberVector<T> || StructuredVector<T> || RecordVector<T> || RecordMap<T>) {
    retire(value);
  } else if constexpr (RecordType<T>) {
    retire_fields(entry_of<T>(), &value);
  } else if constexpr (RecordOptional<T>) {
    if (is_in_use(&value, typeid(T)))
      throw UsageError(entry_of<typename T::value_type>().name + ": a variable still refers to it; delete that first");
  } else if constexpr (BoundClass<T>) {
    if constexpr (IsBoundClass<T>::k_has_buffer)
      throw UsageError("a struct with a picture can't be assigned as a whole");
  }
}

/// A class of Python for a struct. `Base` is its base when that has a class, too.
template <class T, class... Base>
class Record {
 public:
  Record(py::module_& module, const char* name, const char* doc)
      : module_(module), entry_(entry_of<T>()), class_(module, name, doc) {
    entry_.name = name;
    entry_.bytes = sizeof(T);
    entry_.self = [](py::handle self) -> void* { return &self.cast<T&>(); };
    class_.def(py::init([](const py::kwargs& values) {
      auto made = std::make_unique<T>();
      set_fields(entry_of<T>(), made.get(), values);
      return made;
    }));
    class_.def("__repr__", [](py::handle self) { return record_text(entry_of<T>(), self); });
    if constexpr (std::is_copy_constructible_v<T>) {
      class_.def("__copy__", [](const T& self) { return std::make_unique<T>(self); });
      class_.def(
          "__deepcopy__", [](const T& self, const py::dict&) { return std::make_unique<T>(self); }, py::arg("memo"));
    }
  }
  /// When all fields are there.
  void done() { add_properties(class_, entry_, module_); }

  template <auto Member>
  Record& field(const char* name, const char* annotation, const char* doc) {
    return add<Member>(name, annotation, doc, false);
  }
  /// One of the base.
  template <auto Member>
  Record& inherited(const char* name, const char* annotation, const char* doc) {
    return add<Member>(name, annotation, doc, sizeof...(Base) != 0);
  }

 private:
  template <auto Member>
  static auto& value_in(void* self) {
    return static_cast<T*>(self)->*Member;
  }

  template <auto Member>
  Record& add(const char* name, const char* annotation, const char* doc, bool is_inherited) {
    using Value = std::remove_reference_t<decltype(std::declval<T&>().*Member)>;
    FieldEntry entry{name, annotation, doc};
    entry.get = [](void* self, py::handle owner) { return to_python(value_in<Member>(self), owner); };
    entry.set = [](void* self, py::handle value, const std::string& place) {
      from_python(value_in<Member>(self), value, place);
    };
    entry.retire = [](void* self) { retire_value(value_in<Member>(self)); };
    if constexpr (Number<Value>) entry.dtype = []() -> py::object { return dtype_of<Value>(); };
    if constexpr (Row<Value>)
      entry.dtype = []() -> py::object {
        return py::make_tuple(dtype_of<Value>(), py::tuple(py::cast(shape_of<Value>())));
      };
    if constexpr (RecordTraits<T>::k_is_structured) {
      static const T k_example{};
      entry.offset = static_cast<std::size_t>(reinterpret_cast<const char*>(&(k_example.*Member)) -
                                              reinterpret_cast<const char*>(&k_example));
    }
    entry.is_inherited = is_inherited;
    entry_.fields.push_back(entry);
    return *this;
  }

  py::module_& module_;
  RecordEntry& entry_;
  py::class_<T, Base...> class_;
};

/// The names of an enumeration, in papilla.choices.
template <NamedEnum E>
void add_choices(py::module_& module, const char* doc) {
  py::list names;
  for (const EnumName& value : EnumNames<E>::k_values) names.append(value.name);
  add_choice_names(module, EnumNames<E>::k_type, doc, py::tuple(names));
}

}  // namespace papilla::python

namespace pybind11::detail {

/// Enumerations are their names.
template <papilla::python::NamedEnum E>
struct type_caster<E> {
  PYBIND11_TYPE_CASTER(E, const_name("str"));
  bool load(handle source, bool) {
    if (!isinstance<str>(source)) return false;
    value = papilla::python::enumerator<E>(source.cast<std::string>());
    return true;
  }
  static handle cast(E value, return_value_policy, handle) { return str(papilla::python::name_of(value)).release(); }
};

}  // namespace pybind11::detail
