// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "docs.hpp"
#include "job.hpp"
#include "record.hpp"

/// Functions of the headers as functions of Python.
///
///     define<RepairOptions>(module, "repair(mesh: TriangleMesh) -> RepairResult", docs::repair,
///                           [](const TriangleMesh& mesh, const RepairOptions& options) { ... });
///
/// The text before the function names its parameters with types, and with defaults where these are not the options';
/// the fields of the options are keywords with their defaults, "options" a whole struct of them, which the other
/// keywords change. A function whose last parameter is a ProgressCallback takes "progress". All run without the GIL, so
/// they must not touch objects of Python.
namespace papilla::python {

/// A parameter as the text has it.
struct Parameter {
  std::string name, annotation, default_text;
  py::object value = {};  ///< The default; null: there is none.
};

/// What the text of a function says, and what comes with its options.
struct Signature {
  std::string name, result;
  std::vector<Parameter> parameters;
  const RecordEntry* options = nullptr;
  bool has_progress = false;
};

Signature parse_signature(const std::string& text);
/// "repair(mesh, *, options=None, weld_mm=None, progress=None)" as inspect reads it.
std::string shown_signature(const Signature& signature, py::handle default_options);
/// For the stubs: papilla._papilla._functions.
void list_function(py::module_& module, const Signature& signature, const char* doc);

/// The arguments of a call, sorted.
struct Arguments {
  std::vector<py::object> positional;  ///< One a parameter.
  py::object options = py::none(), progress = py::none();
  py::dict fields;  ///< Of the options.
};
/// @throws UsageError for arguments that are missing, too many or twice there.
Arguments sort_arguments(const Signature& signature, const py::args& args, const py::kwargs& keywords);

/// What an argument is turned into before the GIL is released.
template <class T>
class Argument {
 public:
  Argument(py::handle given, const std::string& place) { from_python(value_, given, place); }
  T& get() { return value_; }

 private:
  T value_{};
};

/// Objects of Python's are looked at where they are; a record may also be a dictionary.
template <class T>
requires(RecordType<T> || BoundClass<T>) class Argument<T> {
 public:
  Argument(py::handle given, const std::string& place) {
    if (py::isinstance<T>(given)) {
      value_ = &given.cast<T&>();
      return;
    }
    if constexpr (RecordType<T>) {
      made_ = std::make_unique<T>();
      record_from(*made_, given, place);
      value_ = made_.get();
    } else {
      throw_wrong_type(given, place, py::type::of<T>().attr("__name__").template cast<std::string>());
    }
  }
  T& get() { return *value_; }

 private:
  T* value_ = nullptr;
  std::unique_ptr<T> made_;
};

/// Arrays of numbers that a function only reads are looked at where they are.
template <class T>
class Argument<std::span<const T>> : public ReadRows<T> {
 public:
  using ReadRows<T>::ReadRows;
};

/// What a function returns. Vectors of numbers become arrays without a copy; what has an into_python(), what that
/// makes.
template <class T>
py::object result_of(T&& result) {
  using Value = std::decay_t<T>;
  if constexpr (requires(Value value) { into_python(std::move(value)); }) {
    return into_python(std::move(result));
  } else if constexpr (NumberVector<Value>) {
    return take(std::move(result));
  } else if constexpr (RecordVector<Value>) {
    py::list elements;
    for (auto& element : result) elements.append(py::cast(std::move(element)));
    return elements;
  } else if constexpr (StructuredVector<Value>) {
    auto kept = std::make_unique<Value>(std::move(result));
    const py::capsule owner(kept.get(), [](void* pointer) { delete static_cast<Value*>(pointer); });
    Value& values = *kept.release();
    return py::array(py::reinterpret_borrow<py::dtype>(record_dtype(entry_of<typename Value::value_type>())),
                     {static_cast<py::ssize_t>(values.size())}, {}, values.data(), owner);
  } else if constexpr (Optional<Value>) {
    return result ? result_of(std::move(*result)) : py::none();
  } else {
    return py::cast(std::move(result));
  }
}

template <class T>
struct CallTraits;
template <class F, class R, class... A>
struct CallTraits<R (F::*)(A...) const> {
  using Result = R;
  using Parameters = std::tuple<std::remove_cv_t<std::remove_reference_t<A>>...>;
};

struct NoOptions {};

/// Calls `function` with the arguments, then the options and the progress where it takes these.
template <class Options, class F, std::size_t... I>
py::object call(const F& function, const Signature& signature, Arguments& given, std::index_sequence<I...>) {
  using Traits = CallTraits<decltype(&F::operator())>;
  using Parameters = typename Traits::Parameters;
  std::tuple<Argument<std::tuple_element_t<I, Parameters>>...> arguments{Argument<std::tuple_element_t<I, Parameters>>(
      given.positional[I], signature.name + ": " + signature.parameters[I].name)...};
  std::unique_ptr<Options> options;
  if constexpr (!std::is_same_v<Options, NoOptions>) {
    options = std::make_unique<Options>();
    if (!given.options.is_none()) record_from(*options, given.options, signature.name + ": options");
    set_fields(entry_of<Options>(), options.get(), given.fields);
  }
  const auto invoke = [&](const ProgressCallback& progress) -> decltype(auto) {
    constexpr std::size_t k_rest = std::tuple_size_v<Parameters> - sizeof...(I);
    if constexpr (std::is_same_v<Options, NoOptions>) {
      if constexpr (k_rest == 1)
        return function(std::get<I>(arguments).get()..., progress);
      else
        return function(std::get<I>(arguments).get()...);
    } else {
      if constexpr (k_rest == 2)
        return function(std::get<I>(arguments).get()..., *options, progress);
      else
        return function(std::get<I>(arguments).get()..., *options);
    }
  };
  using Result = typename Traits::Result;
  if constexpr (std::is_void_v<Result>) {
    if (signature.has_progress) {
      run_job([&](const ProgressCallback& progress) { invoke(progress); }, given.progress);
    } else {
      const py::gil_scoped_release without_gil;
      invoke({});
    }
    return py::none();
  } else {
    std::optional<Result> result;
    if (signature.has_progress) {
      run_job([&](const ProgressCallback& progress) { result.emplace(invoke(progress)); }, given.progress);
    } else {
      const py::gil_scoped_release without_gil;
      result.emplace(invoke({}));
    }
    return result_of(std::move(*result));
  }
}

/// The one function that pybind11 sees.
using Caller = std::function<py::object(const py::args&, const py::kwargs&)>;
void add_function(py::module_& module, const std::string& name, const std::string& doc, Caller caller);

template <class Options = NoOptions, class F>
void define(py::module_& module, const char* text, const char* doc, F function) {
  using Parameters = typename CallTraits<decltype(&F::operator())>::Parameters;
  constexpr std::size_t k_all = std::tuple_size_v<Parameters>;
  auto signature = std::make_shared<Signature>(parse_signature(text));
  py::object defaults = py::none();
  if constexpr (!std::is_same_v<Options, NoOptions>) {
    signature->options = &entry_of<Options>();
    defaults = py::cast(Options{});
  }
  if constexpr (k_all > 0)
    signature->has_progress = std::is_same_v<std::tuple_element_t<k_all - 1, Parameters>, ProgressCallback>;
  constexpr std::size_t k_options = std::is_same_v<Options, NoOptions> ? 0 : 1;
  constexpr bool k_progress = [] {
    if constexpr (k_all > 0)
      return std::is_same_v<std::tuple_element_t<k_all - 1, Parameters>, ProgressCallback>;
    else
      return false;
  }();
  constexpr std::size_t k_positional = k_all - k_options - (k_progress ? 1 : 0);
  if (signature->parameters.size() != k_positional)
    throw py::type_error(signature->name + ": the text has another number of parameters than the function");
  list_function(module, *signature, doc);
  const std::string shown = shown_signature(*signature, defaults) + "\n--\n\n" + doc;
  add_function(module, signature->name, shown, [signature, function](const py::args& args, const py::kwargs& keywords) {
    Arguments given = sort_arguments(*signature, args, keywords);
    return call<Options>(function, *signature, given, std::make_index_sequence<k_positional>{});
  });
}

}  // namespace papilla::python
