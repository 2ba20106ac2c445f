// SPDX-License-Identifier: MIT
#include "numpy.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace papilla::python {
namespace {

std::string text_of(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (const py::ssize_t side : shape) text += (side < 0 ? std::string("n") : std::to_string(side)) + ", ";
  if (text.size() > 1) text.resize(text.size() - (shape.size() > 1 ? 2 : 1));
  return text + ")";
}

bool fits(const py::array& array, const std::vector<py::ssize_t>& shape) {
  if (static_cast<std::size_t>(array.ndim()) != shape.size()) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] >= 0 && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
  return true;
}

/// Whether an integer type holds all values; -1 stands for none.
void check_range(const py::array& array, const py::dtype& wanted, const std::string& place) {
  if (array.size() == 0 || wanted.itemsize() >= array.dtype().itemsize()) return;
  const bool is_signed = wanted.kind() == 'i';
  const int bits = 8 * static_cast<int>(wanted.itemsize());
  // Indices are unsigned inside: what int32 shows as negative may come back.
  const double most =
      is_signed && bits == 32 ? std::ldexp(1.0, 32) - 1 : std::ldexp(1.0, is_signed ? bits - 1 : bits) - 1;
  const double least = is_signed ? -std::ldexp(1.0, bits - 1) : 0;
  const double low = array.attr("min")().cast<double>(), high = array.attr("max")().cast<double>();
  if (low < least || high > most)
    throw UsageError(place + ": " + std::to_string(static_cast<long long>(low < least ? low : high)) +
                     " is out of the range of " + py::str(static_cast<py::object>(wanted)).cast<std::string>());
}

}  // namespace

py::array array_of(py::handle value, const py::dtype& dtype, const std::vector<py::ssize_t>& shape,
                   const std::string& place) {
  const py::module_ numpy = py::module_::import("numpy");
  py::array array;
  try {
    array = numpy.attr("asarray")(value).cast<py::array>();
  } catch (const py::error_already_set&) {
    throw UsageError(place + ": is no array of numbers");
  }
  if (array.size() == 0 && shape.size() > 1 && array.ndim() == 1) {
    auto empty = shape;
    for (py::ssize_t& side : empty) side = side < 0 ? 0 : side;
    array = array.attr("reshape")(empty).cast<py::array>();
  }
  if (!fits(array, shape)) {
    std::vector<py::ssize_t> got(array.shape(), array.shape() + array.ndim());
    throw UsageError(place + ": needs an array of shape " + text_of(shape) + ", got " + text_of(got));
  }
  const char from = array.dtype().kind(), to = dtype.kind();
  const std::string kinds = to == 'f' ? "fiub" : to == 'b' ? "b" : "iub";
  if (array.size() != 0 && kinds.find(from) == std::string::npos)
    throw UsageError(place + ": needs " + py::str(static_cast<py::object>(dtype)).cast<std::string>() + ", got " +
                     py::str(static_cast<py::object>(array.dtype())).cast<std::string>());
  if (to == 'i' || to == 'u') check_range(array, dtype, place);
  // The same bits: indices are unsigned inside.
  const bool is_same_but_signed = (to == 'i' || to == 'u') && (from == 'i' || from == 'u') &&
                                  array.dtype().itemsize() == dtype.itemsize() &&
                                  array.dtype().attr("isnative").cast<bool>();
  const py::object typed =
      is_same_but_signed ? array.attr("view")(dtype) : array.attr("astype")(dtype, py::arg("copy") = false);
  const auto contiguous = numpy.attr("ascontiguousarray")(typed).cast<py::array>();
  const bool is_aligned = (contiguous.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
  const py::object aligned = is_aligned ? py::object(contiguous) : py::object(contiguous.attr("copy")());
  return aligned.attr("reshape")(py::cast(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim())))
      .cast<py::array>();
}

bool is_lendable(const py::array& array) {
  if (!array.writeable()) return false;
  py::object owner = array;
  while (owner && !owner.is_none()) {
    if (py::detail::get_type_info(Py_TYPE(owner.ptr())) != nullptr) return false;
    if (py::isinstance<py::array>(owner))
      owner = py::reinterpret_borrow<py::array>(owner).base();
    else if (PyMemoryView_Check(owner.ptr()))
      owner = py::reinterpret_borrow<py::object>(PyMemoryView_GET_BUFFER(owner.ptr())->obj);
    else
      break;
  }
  return true;
}

std::shared_ptr<void> keeper_of(py::array array) {
  return {array.release().ptr(), [](void* object) {
            if (Py_IsInitialized() == 0) return;
            const py::gil_scoped_acquire with_gil;
            py::handle(static_cast<PyObject*>(object)).dec_ref();
          }};
}

}  // namespace papilla::python
