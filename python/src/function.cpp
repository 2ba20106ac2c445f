// SPDX-License-Identifier: MIT
#include "function.hpp"

#include <pybind11/eval.h>

#include <algorithm>

#include "papilla/core/near_name.hpp"

namespace papilla::python {
namespace {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// Pieces between commas outside of brackets.
std::vector<std::string> pieces_of(const std::string& text) {
  std::vector<std::string> pieces;
  std::string piece;
  int depth = 0;
  for (const char letter : text) {
    if (letter == '[' || letter == '(') ++depth;
    if (letter == ']' || letter == ')') --depth;
    if (letter == ',' && depth == 0)
      pieces.push_back(std::exchange(piece, {}));
    else
      piece += letter;
  }
  if (!trimmed(piece).empty()) pieces.push_back(piece);
  return pieces;
}

Parameter parse_parameter(const std::string& text) {
  Parameter parameter;
  std::string rest = text;
  if (const auto equals = rest.find(" = "); equals != std::string::npos) {
    parameter.default_text = trimmed(rest.substr(equals + 3));
    parameter.value = py::eval(parameter.default_text);
    rest.resize(equals);
  }
  const auto colon = rest.find(':');
  parameter.name = trimmed(rest.substr(0, colon));
  parameter.annotation = trimmed(rest.substr(colon + 1));
  return parameter;
}

/// A default as text that can be evaluated; "..." for what has none.
std::string default_text(py::handle value) {
  if (value.is_none() || py::isinstance<py::bool_>(value) || py::isinstance<py::int_>(value) ||
      py::isinstance<py::str>(value))
    return py::repr(value).cast<std::string>();
  if (py::isinstance<py::float_>(value)) {
    const std::string text = py::repr(value).cast<std::string>();
    return text == "inf" ? "1e999" : text;
  }
  if (py::isinstance<py::array>(value)) {
    const auto array = py::reinterpret_borrow<py::array>(value);
    if (array.size() > 16 || array.dtype().kind() == 'V') return "...";
    return array.size() == 0 ? "()" : py::repr(py::tuple(array.attr("tolist")())).cast<std::string>();
  }
  if ((py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value) || py::isinstance<py::dict>(value)) &&
      py::len(value) == 0)
    return py::repr(value).cast<std::string>();
  return "...";
}

bool has_parameter(const Signature& signature, std::string_view name) {
  return std::any_of(signature.parameters.begin(), signature.parameters.end(),
                     [&](const Parameter& parameter) { return parameter.name == name; });
}

}  // namespace

Signature parse_signature(const std::string& text) {
  Signature signature;
  const auto open = text.find('('), close = text.rfind(')');
  signature.name = text.substr(0, open);
  for (const std::string& piece : pieces_of(text.substr(open + 1, close - open - 1)))
    signature.parameters.push_back(parse_parameter(piece));
  const auto arrow = text.rfind("-> ");
  signature.result = arrow == std::string::npos ? "None" : trimmed(text.substr(arrow + 3));
  return signature;
}

std::string shown_signature(const Signature& signature, py::handle default_options) {
  std::string text;
  const auto add = [&](const std::string& piece) { text += (text.empty() ? "" : ", ") + piece; };
  for (const Parameter& parameter : signature.parameters)
    add(parameter.name + (parameter.value ? "=" + parameter.default_text : ""));
  if (signature.options || signature.has_progress) add("*");
  if (signature.options) {
    add("options=None");
    for (const FieldEntry& field : signature.options->fields)
      if (!has_parameter(signature, field.name))
        add(std::string(field.name) + "=" + default_text(default_options.attr(field.name)));
  }
  if (signature.has_progress) add("progress=None");
  return signature.name + "(" + text + ")";
}

void list_function(py::module_& module, const Signature& signature, const char* doc) {
  py::list parameters;
  for (const Parameter& parameter : signature.parameters)
    parameters.append(py::make_tuple(parameter.name, parameter.annotation, parameter.default_text));
  module.attr("_functions")[py::str(signature.name)] =
      py::make_tuple(parameters, signature.options ? py::object(py::str(signature.options->name)) : py::none(),
                     signature.has_progress, signature.result, doc);
}

Arguments sort_arguments(const Signature& signature, const py::args& args, const py::kwargs& keywords) {
  Arguments given;
  given.positional.resize(signature.parameters.size());
  if (args.size() > signature.parameters.size())
    throw UsageError(signature.name + "() takes at most " + std::to_string(signature.parameters.size()) +
                     " positional arguments, got " + std::to_string(args.size()));
  for (std::size_t i = 0; i < args.size(); ++i) given.positional[i] = args[i];
  std::vector<std::string_view> known{"options", "progress"};
  for (const Parameter& parameter : signature.parameters) known.push_back(parameter.name);
  for (const auto& [key, value] : keywords) {
    const std::string name = py::str(key).cast<std::string>();
    const auto object = py::reinterpret_borrow<py::object>(value);
    std::size_t at = 0;
    while (at < signature.parameters.size() && signature.parameters[at].name != name) ++at;
    if (at < signature.parameters.size()) {
      if (given.positional[at]) throw UsageError(signature.name + "() got '" + name + "' twice");
      given.positional[at] = object;
    } else if (name == "progress" && signature.has_progress) {
      given.progress = object;
    } else if (name == "options" && signature.options) {
      given.options = object;
    } else if (signature.options) {
      given.fields[key] = value;
    } else {
      throw UsageError(signature.name + "() has no argument '" + name + "'" + did_you_mean(name, known));
    }
  }
  for (std::size_t i = 0; i < given.positional.size(); ++i) {
    if (given.positional[i]) continue;
    const Parameter& parameter = signature.parameters[i];
    if (!parameter.value) throw UsageError(signature.name + "() needs '" + parameter.name + "'");
    given.positional[i] = parameter.value;
  }
  if (!given.progress.is_none() && !PyCallable_Check(given.progress.ptr()))
    throw_wrong_type(given.progress, signature.name + ": progress", "a function");
  return given;
}

void add_function(py::module_& module, const std::string& name, const std::string& doc, Caller caller) {
  py::options plain;
  plain.disable_function_signatures();
  module.def(name.c_str(), std::move(caller), doc.c_str());
}

}  // namespace papilla::python
