// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include "papilla/core/error.hpp"

namespace papilla::python {

/// A call that names what there is not, or gives what can't be taken.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The exception classes, and what the library throws as these.
void add_errors(pybind11::module_& module);

}  // namespace papilla::python
