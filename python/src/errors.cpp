// SPDX-License-Identifier: MIT
#include "errors.hpp"

#include <exception>

#include "papilla/core/file_guard.hpp"
#include "papilla/core/progress.hpp"

namespace papilla::python {
namespace {

namespace py = pybind11;

/// The classes live as long as the process, as their module does.
struct Classes {
  PyObject *error, *usage, *input, *io, *solver, *device, *cancelled;
};
Classes g_classes{};

PyObject* new_class(py::module_& module, const char* name, const char* doc, const py::tuple& bases, int exit_code) {
  py::dict members;
  members["__module__"] = "papilla";
  members["__doc__"] = doc;
  members["exit_code"] = exit_code;
  const py::object type = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(&PyType_Type));
  py::object made = type(name, bases, members);
  module.attr(name) = made;
  return made.release().ptr();
}

py::handle builtin(PyObject* type) { return type; }

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const UsageError& error) {
    PyErr_SetString(g_classes.usage, error.what());
  } catch (const OverwriteRefused& error) {
    PyErr_SetString(g_classes.usage, error.what());
  } catch (const InvalidInput& error) {
    PyErr_SetString(g_classes.input, error.what());
  } catch (const IoError& error) {
    PyErr_SetString(g_classes.io, error.what());
  } catch (const SolverFailure& error) {
    PyErr_SetString(g_classes.solver, error.what());
  } catch (const DeviceError& error) {
    PyErr_SetString(g_classes.device, error.what());
  } catch (const Cancelled& error) {
    PyErr_SetString(g_classes.cancelled, error.what());
  } catch (const Error& error) {
    PyErr_SetString(g_classes.error, error.what());
  }
}

}  // namespace

void add_errors(py::module_& module) {
  g_classes.error =
      new_class(module, "Error",
                "Base of every exception of papilla. The message is one line and names the file or function, the "
                "place in it, and the reason; exit_code is what the programs end with.",
                py::make_tuple(builtin(PyExc_Exception)), 3);
  const py::handle base = g_classes.error;
  g_classes.usage =
      new_class(module, "UsageError", "A call that names what there is not, or gives what can't be taken.",
                py::make_tuple(base, builtin(PyExc_TypeError), builtin(PyExc_ValueError)), 2);
  g_classes.input = new_class(module, "InvalidInput", "An argument or a file's content breaks a precondition.",
                              py::make_tuple(base, builtin(PyExc_ValueError)), 3);
  g_classes.io = new_class(module, "IoError", "A file can't be opened, read or written.",
                           py::make_tuple(base, builtin(PyExc_OSError)), 3);
  g_classes.solver = new_class(module, "SolverFailure", "A solver found no usable answer for valid input.",
                               py::make_tuple(base, builtin(PyExc_ArithmeticError)), 4);
  g_classes.device = new_class(module, "DeviceError", "A force device is missing, lost, or answers wrongly.",
                               py::make_tuple(base, builtin(PyExc_OSError)), 5);
  g_classes.cancelled = new_class(module, "Cancelled", "A progress callback returned False. Nothing was written.",
                                  py::make_tuple(base), 3);
  py::register_exception_translator(&translate);
}

}  // namespace papilla::python
