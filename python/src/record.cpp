// SPDX-License-Identifier: MIT
#include "record.hpp"

#include "papilla/core/near_name.hpp"

namespace papilla::python {
namespace {

std::string type_name(py::handle value) { return py::type::of(value).attr("__name__").cast<std::string>(); }

/// A value in one line: large ones by their kind.
std::string short_text(py::handle value) {
  if (py::isinstance<py::array>(value)) {
    const auto array = py::reinterpret_borrow<py::array>(value);
    if (array.size() <= 16 && array.dtype().kind() != 'V') {
      return py::str(array.attr("tolist")()).cast<std::string>();
    }
    return "<array " + py::str(array.attr("shape")).cast<std::string>() + ">";
  }
  if (py::isinstance<py::tuple>(value) || PyMapping_Check(value.ptr())) {
    const std::size_t count = py::len(value);
    if (count > 4) return "<" + type_name(value) + " of " + std::to_string(count) + ">";
  }
  std::string text = py::repr(value).cast<std::string>();
  if (text.size() > 200) text = "<" + type_name(value) + ">";
  return text;
}

}  // namespace

py::object record_dtype(RecordEntry& entry) {
  if (entry.dtype) return entry.dtype;
  py::list names, formats, offsets;
  for (const FieldEntry& field : entry.fields) {
    names.append(field.name);
    formats.append(field.dtype());
    offsets.append(field.offset);
  }
  entry.dtype = py::dtype(names, formats, offsets, static_cast<py::ssize_t>(entry.bytes));
  return entry.dtype;
}

void add_properties(py::object type, RecordEntry& entry, py::module_& module) {
  const py::object property = py::module_::import("builtins").attr("property");
  for (const FieldEntry& field : entry.fields) {
    if (field.is_inherited) continue;
    const py::cpp_function get([&entry, get = field.get](py::handle self) { return get(entry.self(self), self); },
                               py::is_method(type));
    const py::cpp_function set(
        [&entry, set = field.set, name = field.name](py::handle self, py::handle value) {
          set(entry.self(self), value, entry.name + "." + name);
        },
        py::is_method(type));
    type.attr(field.name) = property(get, set, py::none(), field.doc);
  }
  py::list fields;
  for (const FieldEntry& field : entry.fields)
    fields.append(py::make_tuple(field.name, field.annotation, field.doc, field.is_inherited));
  py::object records = module.attr("_records");
  records[py::str(entry.name)] = fields;
  py::list own;
  for (const FieldEntry& field : entry.fields) own.append(field.name);
  type.attr("__match_args__") = py::tuple(own);
}

void retire_fields(const RecordEntry& entry, void* self) {
  for (const FieldEntry& field : entry.fields) field.retire(self);
}

void set_fields(const RecordEntry& entry, void* self, const py::dict& values) {
  for (const auto& [key, value] : values) {
    const std::string name = py::str(key).cast<std::string>();
    const FieldEntry* found = nullptr;
    std::vector<std::string_view> known;
    for (const FieldEntry& field : entry.fields) {
      known.push_back(field.name);
      if (name == field.name) found = &field;
    }
    if (!found) throw UsageError(entry.name + " has no '" + name + "'" + did_you_mean(name, known));
    found->set(self, value, entry.name + "." + name);
  }
}

std::string record_text(const RecordEntry& entry, py::handle self) {
  std::string text = entry.name + "(";
  for (const FieldEntry& field : entry.fields)
    text +=
        std::string(&field == entry.fields.data() ? "" : ", ") + field.name + "=" + short_text(self.attr(field.name));
  return text + ")";
}

py::array structured_array(py::handle given, const py::dtype& dtype, const std::string& place) {
  if (!py::isinstance<py::array>(given) ||
      !py::reinterpret_borrow<py::array>(given).dtype().equal(static_cast<py::object>(dtype)))
    throw_wrong_type(given, place,
                     "a structured array of " + py::str(static_cast<py::object>(dtype)).cast<std::string>());
  return py::module_::import("numpy").attr("ascontiguousarray")(given).cast<py::array>();
}

void add_choice_names(py::module_& module, const char* type, const char* doc, const py::tuple& names) {
  module.attr("choices")[py::str(type)] = names;
  module.attr("_choice_docs")[py::str(type)] = py::str(doc);
}

void throw_unknown_choice(const char* type, const std::string& name, const std::vector<std::string_view>& known) {
  std::string all;
  for (const std::string_view one : known) all += (all.empty() ? "" : ", ") + std::string(one);
  throw UsageError("there is no " + std::string(type) + " '" + name + "'; there are: " + all);
}

py::object read_only(const py::object& copy) {
  if (py::isinstance<py::list>(copy)) return py::tuple(copy);
  if (py::isinstance<py::set>(copy)) return py::frozenset(copy);
  if (py::isinstance<py::dict>(copy)) return py::module_::import("types").attr("MappingProxyType")(copy);
  return copy;
}

void throw_wrong_type(py::handle given, const std::string& place, const std::string& wanted) {
  throw UsageError(place + ": needs " + wanted + ", got " + type_name(given));
}

void throw_out_of_range(py::handle given, const std::string& place, const std::string& low, const std::string& high) {
  throw UsageError(place + ": needs an integer from " + low + " to " + high + ", got " +
                   py::str(given).cast<std::string>());
}

}  // namespace papilla::python
