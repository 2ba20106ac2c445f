// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace papilla {

/// Base of every exception of the library. The message is one line and names the
/// file or function, the place in it, and the reason.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument or a file's content breaks a precondition (exit code 3).
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file can't be opened, read or written (exit code 3).
class IoError : public Error {
 public:
  using Error::Error;
};

/// A solver found no usable answer for valid input (exit code 4).
class SolverFailure : public Error {
 public:
  using Error::Error;
};

/// A force device is missing, lost, or answers wrongly (exit code 5).
class DeviceError : public Error {
 public:
  using Error::Error;
};

/// "x.y.z", the version of the library.
const char* version() noexcept;

}  // namespace papilla
